// Bounds of an elementary function over all numbers within e of x̂. Notation: docs/notation.md; x̂
// and e are an argument's value and error, v is the computed result, f the function. Roundings
// reduce a computed bound by a factor of at least (1 − u)^13. enlarged() multiplies it by 1 + 16u,
// which is enough: (1 + 16u)(1 − u)^13 > 1. Underflow is counted separately.
#pragma once

#include <cmath>
#include <errbound/error_free.hpp>
#include <errbound/functions.hpp>
#include <errbound/functions/angle_reduction.hpp>
#include <errbound/functions/function_error.hpp>
#include <errbound/small_floats.hpp>
#include <type_traits>
#include <utility>

namespace errbound {

namespace detail {

/// The type that evaluates functions of T: T, or float for 8- and 16-bit types.
template <class T>
struct type_of_functions {
    using type = T;
};
template <int P, int E, bool HasInfinity>
struct type_of_functions<small_float<P, E, HasInfinity>> {
    using type = float;
};
template <class T>
using function_type = typename type_of_functions<T>::type;

template <class T>
inline constexpr bool has_system_functions =
    std::same_as<T, float> || std::same_as<T, double> || std::same_as<T, long double>;

template <elementary_function F, class... T>
auto system_function(const T&... x) {
    using enum elementary_function;
    static_assert((has_system_functions<T> && ...),
                  "errbound: elementary functions exist for float, double, long double and 8- "
                  "and 16-bit types");
    if constexpr (F == exp) return std::exp(x...);
    if constexpr (F == exp2) return std::exp2(x...);
    if constexpr (F == expm1) return std::expm1(x...);
    if constexpr (F == log) return std::log(x...);
    if constexpr (F == log2) return std::log2(x...);
    if constexpr (F == log10) return std::log10(x...);
    if constexpr (F == log1p) return std::log1p(x...);
    if constexpr (F == sin) return std::sin(x...);
    if constexpr (F == cos) return std::cos(x...);
    if constexpr (F == tan) return std::tan(x...);
    if constexpr (F == asin) return std::asin(x...);
    if constexpr (F == acos) return std::acos(x...);
    if constexpr (F == atan) return std::atan(x...);
    if constexpr (F == sinh) return std::sinh(x...);
    if constexpr (F == cosh) return std::cosh(x...);
    if constexpr (F == tanh) return std::tanh(x...);
    if constexpr (F == asinh) return std::asinh(x...);
    if constexpr (F == acosh) return std::acosh(x...);
    if constexpr (F == atanh) return std::atanh(x...);
    if constexpr (F == cbrt) return std::cbrt(x...);
    if constexpr (F == pow) return std::pow(x...);
    if constexpr (F == atan2) return std::atan2(x...);
}

/// At least |v − f|, before enlarged(), for an error of k units in the last place of f. Such a unit
/// is at most ε|f| + η, and |f| <= (|v| + kη)/(1 − kε), so |v − f| <= kε|v|/(1 − kε) + kη + k²εη/(1
/// − kε). Here 1/(1 − kε) < 1 + 2kε and k²ε <= 1/8. Another 2kε >= u covers rounding k to T,
/// another η the product's underflow.
template <elementary_function F, class T>
T error_of_function(const T& v) {
    using traits = number_traits<T>;
    constexpr double k = function_error<F, T>;
    static_assert(k != 0,
                  "errbound: the errors of this C library's elementary functions are unknown; "
                  "specialise errbound::function_error");
    static_assert(k == 0 || (k >= 0.5 && k <= 1024),
                  "errbound: function_error must be from 0.5 to 1024 units in the last place");
    constexpr T relative = T(k) * traits::epsilon();
    return rounded_product(traits::abs(v), T(relative * (1 + 4 * relative))) +
           T(static_cast<int>(k) + 2) * traits::underflow_unit();
}

/// A value, and at least its distance from the exact one; infinite or NaN if there is no bound.
template <class T>
struct bounded {
    T value, error;
};

/// A function's value at a T, before enlarged().
template <elementary_function F, class T>
bounded<T> evaluated(const T& x) {
    const T v = system_function<F>(x);
    return {v, error_of_function<F>(v)};
}

/// The sign of a + b − limit.
template <class T>
sign_type order_of_sum(const T& a, const T& b, const T& limit) {
    const with_error<T> sum = two_sum(a, b);
    // Rounding is monotone: the exact sum is on the same side of a T as the rounded one.
    const T side = sum.value == limit ? sum.error : T(sum.value - limit);
    return side > 0 ? sign_type::positive : side < 0 ? sign_type::negative : sign_type::zero;
}

/// True if every number within e of x̂ is in the domain of F and none is a pole.
template <elementary_function F, class T>
bool is_in_domain(const T& x, const T& e) {
    using enum elementary_function;
    if constexpr (F == log || F == log2 || F == log10) return x > e;
    if constexpr (F == log1p) return order_of_sum(x, T(1), e) == sign_type::positive;
    if constexpr (F == acosh) return certainly_nonnegative(order_of_sum(x, T(-e), T(1)));
    const T size = number_traits<T>::abs(x);
    if constexpr (F == asin || F == acos) return certainly_nonpositive(order_of_sum(size, e, T(1)));
    if constexpr (F == atanh) return order_of_sum(size, e, T(1)) == sign_type::negative;
    return true;
}

template <class T>
bool is_cube_root(const T& v, const T& x) {
    const with_error<T> square = two_product(v, v), cube = two_product(square.value, v);
    return product_error_is_exact(v, v, square) && square.error == 0 &&
           product_error_is_exact(square.value, v, cube) && cube.error == 0 && cube.value == x;
}

/// True if v is the exact result for an exact x. Other rational results exist only for logarithms
/// of powers of ten (theorems of Lindemann, and of Gelfond and Schneider).
template <elementary_function F, class T>
bool is_exact_result(const T& x, const T& v) {
    using enum elementary_function;
    using traits = number_traits<T>;
    if constexpr (F == exp || F == cos || F == cosh) return x == 0 && v == 1;
    if constexpr (F == log || F == log10 || F == acos || F == acosh) return x == 1 && v == 0;
    if constexpr (F == cbrt) return is_cube_root(v, x);
    constexpr int reach = traits::max_exponent - traits::min_exponent + traits::digits;
    if constexpr (F == exp2) {
        if (!(x > -reach && x < reach && v > 0)) return false;
        const int n = static_cast<int>(x);
        return T(n) == x && v == traits::scale(T(1), n);
    }
    if constexpr (F == log2) {
        const int n = traits::exponent(x) - 1;
        return x == traits::scale(T(1), n) && v == T(n);
    }
    return x == 0 && v == 0;
}

/// The direction in which |f'| does not decrease: to greater or lesser arguments, away from zero or
/// towards it.
enum class steeper_side { above, below, outward, inward };

template <elementary_function F>
constexpr steeper_side steeper() {
    using enum elementary_function;
    switch (F) {
        case exp:
        case exp2:
        case expm1:
            return steeper_side::above;
        case log:
        case log2:
        case log10:
        case log1p:
        case acosh:
            return steeper_side::below;
        case asin:
        case acos:
        case sinh:
        case cosh:
        case atanh:
            return steeper_side::outward;
        default:  // atan, tanh, asinh, cbrt
            return steeper_side::inward;
    }
}

/// The distance of arguments over which f' changes much.
template <elementary_function F, class T>
T natural_distance(const T& x) {
    using enum elementary_function;
    const T size = number_traits<T>::abs(x);
    if constexpr (F == exp || F == exp2 || F == expm1 || F == sinh || F == cosh) return T(1);
    if constexpr (F == log || F == log2 || F == log10 || F == cbrt) return size;
    if constexpr (F == log1p) return 1 + x;
    if constexpr (F == asin || F == acos || F == atanh) return 1 - size;
    if constexpr (F == acosh) return x - 1;
    return size > 1 ? size : T(1);
}

/// x̂ ± distance, rounded away from x̂; never beyond the end of a closed domain.
template <elementary_function F, class T>
T moved(const T& x, const T& distance, bool up) {
    using enum elementary_function;
    const with_error<T> sum = two_sum(x, up ? distance : T(-distance));
    T p = sum.value;
    // A NaN error (overflow) also steps.
    if (!(up ? sum.error <= 0 : sum.error >= 0))
        p = std::nextafter(p, up ? number_traits<T>::infinity() : T(-number_traits<T>::infinity()));
    if constexpr (F == asin || F == acos) return p > 1 ? T(1) : p < -1 ? T(-1) : p;
    if constexpr (F == acosh) return p < 1 ? T(1) : p;
    return p;
}

/// At least |v − f(x)| for x within e > 0 of x̂, all in the domain. |f(x) − f(x̂)| is at most the
/// integral of |f'| over the interval of length e next to x̂ on the steeper side. For a point p on
/// that side, at a distance d >= e, the mean of |f'| from x̂ to p is no less. So the change is at
/// most (e/d)·|f(p) − f(x̂)|. If d is √ε natural distances, this gives the derivative to about √ε.
/// If |f'| grows towards zero, p passes zero only if x can be zero. Then d = e, and no interval of
/// length e next to x̂ has a larger integral.
template <elementary_function F, class T>
T error_by_slope(const T& x, const T& e, const T& v) {
    using traits = number_traits<T>;
    constexpr steeper_side side = steeper<F>();
    const T size = traits::abs(x);
    const bool up =
        side == steeper_side::above ||
        (side == steeper_side::outward ? x >= 0 : side == steeper_side::inward && x < 0);
    T distance = (traits::max)(
        e, rounded_product(natural_distance<F>(x), traits::scale(T(1), -(traits::digits / 2))));
    bool to_the_end = false;
    if constexpr (side == steeper_side::inward) {
        to_the_end = size <= e;
        if (distance > size) distance = to_the_end ? e : size;
    }
    const T p = moved<F>(x, distance, up);
    const bounded<T> end = evaluated<F>(p);
    const T own = error_of_function<F>(v), way = traits::abs(T(p - x));
    const T difference = traits::abs(T(end.value - v)) + (own + end.error);
    // If the way is rounded to e or less, or infinite, the share is 1.
    const bool shares = !to_the_end && way > e && traits::is_finite(way);
    const T share = shares ? T(e / way + traits::underflow_unit()) : T(1);
    return own + (rounded_product(share, difference) + traits::underflow_unit());
}

/// At least |f(x) − f(x̂)| for f = sin or cos; `slope` is the other function at x̂. With d = x −
/// x̂, |2 sin(d/2) cos(x̂ + d/2)| <= e·min(1, |cos x̂| + e/2), and the same for cos.
template <class T>
T change_of_wave(const bounded<T>& slope, const T& e) {
    using traits = number_traits<T>;
    const T steepest = traits::abs(slope.value) + (slope.error + e / 2);
    return rounded_product(e, steepest < 1 ? enlarged<T>(steepest) : T(1)) +
           traits::underflow_unit();
}

/// At least |tan x − tan x̂| for x within e of x̂; infinite if a pole may be among them. With t =
/// |tan x̂| and q = tan e, e < π/2: tan(x̂ + d) − tan x̂ = tan d (1 + tan² x̂)/(1 − tan x̂ tan d)
/// is at most q(1 + t²)/(1 − tq), without a pole if tq < 1.
template <class T>
T change_of_tangent(const bounded<T>& tangent, const T& e) {
    using traits = number_traits<T>;
    if (!(e <= 1.5)) return traits::infinity();
    const bounded<T> of_e = evaluated<elementary_function::tan>(e);
    const T q = enlarged<T>(of_e.value + of_e.error);
    const T t = enlarged<T>(traits::abs(tangent.value) + tangent.error);
    const T product = enlarged<T>(rounded_product(t, q) + traits::underflow_unit());
    if (!(product < 1)) return traits::infinity();
    const T numerator = rounded_product(q, T(1 + rounded_product(t, t)));
    return enlarged<T>(numerator / (1 - product)) + traits::underflow_unit();
}

/// f(h + l + d) for |d| <= r.error, h = r.high, l = r.low, from f(h) and f'(h), with |f'| <= 3 and
/// |f''| <= 6: f(h) + l·f'(h) has an error of at most 3l² + 3|d|. The error is already enlarged(),
/// as in the functions that use this.
template <class T>
bounded<T> moved_by_low_part(const reduced_angle<T>& r, const bounded<T>& at_high,
                             const bounded<T>& slope) {
    using traits = number_traits<T>;
    const T product = rounded_product(r.low, slope.value), low = traits::abs(r.low);
    const with_error<T> sum = two_sum(at_high.value, product);
    const T lost =
        rounded_product(low, T(slope.error + rounded_product(T(3), low))) + half_ulp(product);
    const T error = lost + (rounded_product(T(3), r.error) + traits::underflow_unit());
    return {sum.value, enlarged<T>(at_high.error + (traits::abs(sum.error) + error))};
}

/// −1/y for y within e of ŷ: |1/(ŷ + d) − 1/ŷ| <= e/(|ŷ|(|ŷ| − e)) for |d| <= e. The error is
/// infinite if y may be 0, otherwise already enlarged().
template <class T>
bounded<T> negative_reciprocal(const bounded<T>& y) {
    using traits = number_traits<T>;
    const T v = -1 / y.value, size = traits::abs(y.value);
    const T divisor = rounded_product(size, T(size - y.error));
    if (!(divisor >= traits::smallest_normal())) return {v, traits::infinity()};
    return {v, enlarged<T>(y.error / divisor + (half_ulp(v) + traits::underflow_unit()))};
}

template <class T>
bounded<T> tangent_of(const reduced_angle<T>& r) {
    const bounded<T> at_high = evaluated<elementary_function::tan>(r.high);
    const T t = at_high.value;
    // |t| < 1.01, so two roundings add an error of less than 2ε.
    const bounded<T> slope{T(1 + rounded_product(t, t)),
                           T(3 * (at_high.error + number_traits<T>::epsilon()))};
    const bounded<T> result = moved_by_low_part(r, at_high, slope);
    return r.quadrant % 2 == 0 ? result : negative_reciprocal(result);
}

template <class T>
bounded<T> negated(const bounded<T>& x) {
    return {T(-x.value), x.error};
}

/// The sine of r + quadrants·π/2 and its derivative.
template <class T>
void sine_of(const reduced_angle<T>& r, int quadrants, bounded<T>& sine, bounded<T>& derivative) {
    using enum elementary_function;
    const bounded<T> at_high = evaluated<sin>(r.high), slope = evaluated<cos>(r.high);
    sine = moved_by_low_part(r, at_high, slope);
    derivative = moved_by_low_part(r, slope, negated(at_high));
    if (quadrants % 2 != 0) sine = std::exchange(derivative, negated(sine));
    if (quadrants % 4 >= 2) sine = negated(sine), derivative = negated(derivative);
}

/// At least |v − f(x)|, x within e > 0 of x̂, f = sin, cos or tan; `at` is the computed f(x̂).
template <elementary_function F, class T>
T error_of_angle_function(const bounded<T>& at, const bounded<T>& derivative, const T& e) {
    if constexpr (F == elementary_function::tan) {
        return enlarged<T>(at.error + change_of_tangent<T>(at, e));
    } else {
        const T error = at.error + change_of_wave<T>(derivative, e);
        // f(x) is in [−1, 1], so |v − f(x)| is at most this.
        const T range = 1 + number_traits<T>::abs(at.value);
        return enlarged<T>(error < range ? error : range);
    }
}

/// F over numbers within e of x̂, |x̂| >= least_reduced_angle, by the C library's functions of
/// angles up to π/4.
template <elementary_function F, class T>
[[gnu::noinline]] bounded<T> function_of_large_angles(T x, T e) {
    using enum elementary_function;
    const reduced_angle<T> r = angle_reduction<T>::of(number_traits<T>::abs(x));
    bounded<T> at{}, derivative{};
    if constexpr (F == tan)
        at = tangent_of(r);
    else
        sine_of(r, r.quadrant + (F == cos ? 1 : 0), at, derivative);
    if (F != cos && x < 0) at = negated(at);
    if (e == 0) return at;
    if (!number_traits<T>::is_finite(e)) return {at.value, number_traits<T>::infinity()};
    return {at.value, error_of_angle_function<F>(at, derivative, e)};
}

template <elementary_function F, class T>
bounded<T> function_of_range(const T& x, const T& e) {
    using enum elementary_function;
    using traits = number_traits<T>;
    if constexpr (is_function_of_angle(F))
        if (traits::abs(x) >= T(least_reduced_angle) && traits::is_finite(x)) [[unlikely]]
            return function_of_large_angles<F>(T(x), T(e));
    const T v = system_function<F>(x);
    if (!traits::is_finite(x) || !traits::is_finite(e) || !is_in_domain<F>(x, e))
        return {v, traits::infinity()};
    const T own = error_of_function<F>(v);
    if (e == 0) return {v, is_exact_result<F>(x, v) ? T(0) : enlarged<T>(own)};
    if constexpr (is_function_of_angle(F)) {
        bounded<T> derivative{};
        if constexpr (F != tan) derivative = evaluated<(F == sin ? cos : sin)>(x);
        return {v, error_of_angle_function<F>({v, own}, derivative, e)};
    } else {
        return {v, enlarged<T>(error_by_slope<F>(x, e, v))};
    }
}

/// At least |v − x^y| for |x̂| > e_x, where v is the computed power of x̂ and ŷ. |log(x^y) −
/// log(x̂^ŷ)| <= |ŷ|·λ + e_y·(|log |x̂|| + λ) =: s, λ = log(|x̂|/(|x̂| − e_x)) = log1p(e_x/(|x̂| −
/// e_x)), and x^y differs from x̂^ŷ by a factor of at most e^s.
template <class T>
T error_of_power(const T& size, const T& of_x, const T& y, const T& of_y, const T& v) {
    using enum elementary_function;
    using traits = number_traits<T>;
    const T own = error_of_function<pow>(v);
    if (of_x == 0 && of_y == 0) return own;
    T of_log(0), exponent(0);
    if (of_x != 0) {
        const bounded<T> ratio =
            evaluated<log1p>(enlarged<T>(of_x / (size - of_x) + traits::underflow_unit()));
        of_log = enlarged<T>(ratio.value + ratio.error);
        exponent = rounded_product(traits::abs(y), of_log);
    }
    if (of_y != 0) {
        const bounded<T> log_x = evaluated<log>(size);
        exponent += rounded_product(of_y, T(traits::abs(log_x.value) + (log_x.error + of_log)));
    }
    const bounded<T> growth =
        evaluated<expm1>(enlarged<T>(exponent + 2 * traits::underflow_unit()));
    const T most = enlarged<T>(traits::abs(v) + own);
    return own + (rounded_product(most, enlarged<T>(growth.value + growth.error)) +
                  traits::underflow_unit());
}

/// At least the error of x^n for n > 0, x possibly zero: |x^n − x̂^n| <= (|x̂| + e)^n − |x̂|^n.
template <class T>
T error_of_power_at_zero(const T& size, const T& e, const T& n, const T& v) {
    using enum elementary_function;
    const T own = error_of_function<pow>(v);
    const T end = system_function<pow>(moved<pow>(size, e, true), n);
    return own + ((end - number_traits<T>::abs(v)) + (error_of_function<pow>(end) + own));
}

/// At least |atan2(y, x) − atan2(ŷ, x̂)| if no (x, y) is across the cut from (x̂, ŷ). The angle
/// between both vectors is at most its tangent, (x̂·dy − ŷ·dx)/(x̂² + ŷ² + x̂·dx + ŷ·dy), with dx =
/// x − x̂ and dy = y − ŷ. Infinite if the denominator may not be positive. A power of two scales
/// all numbers, so that the larger of |x̂| and |ŷ| is from 1/2 to 1. At most four scalings and
/// products in each sum lose less than η each.
template <class T>
T change_of_angle(const T& y, const T& of_y, const T& x, const T& of_x) {
    using traits = number_traits<T>;
    const T larger = (traits::max)(traits::abs(x), traits::abs(y));
    const int unit = traits::exponent(larger);
    const auto scaled = [&](const T& z) { return traits::scale(traits::abs(z), -unit); };
    const T a = scaled(x), b = scaled(y), da = scaled(of_x), db = scaled(of_y);
    const T lost = 8 * traits::underflow_unit();
    const T across = rounded_product(a, T(db + lost)) + (rounded_product(b, T(da + lost)) + lost);
    const T along = rounded_product(a, T(da + lost)) + (rounded_product(b, T(db + lost)) + lost);
    const T square = rounded_product(a, a) + rounded_product(b, b);
    const T least = rounded_product(square, T(1 - 4 * traits::epsilon())) - enlarged<T>(along);
    if (!(least > 0)) return traits::infinity();
    return enlarged<T>(across) / least + lost;
}

template <class T>
bounded<T> power_of_ranges(const T& x, const T& of_x, const T& y, const T& of_y) {
    using traits = number_traits<T>;
    const T v = system_function<elementary_function::pow>(x, y);
    const bounded<T> unknown{v, traits::infinity()};
    if (!traits::is_finite(of_x) || !traits::is_finite(of_y)) return unknown;
    if (of_y == 0 && y == 0) return {T(1), T(0)};
    const bool is_whole = of_y == 0 && std::trunc(y) == y;
    const T size = traits::abs(x);
    if (size > of_x) {
        if (x < 0 && !is_whole) return unknown;
        if (x == 1 && of_x == 0) return {T(1), T(0)};
        return {v, enlarged<T>(error_of_power(size, of_x, y, of_y, v))};
    }
    if (of_x == 0 && y > of_y) return {T(0), T(0)};
    if (!is_whole || y < 0) return unknown;
    return {v, enlarged<T>(error_of_power_at_zero(size, of_x, y, v))};
}

template <class T>
bounded<T> angle_of_ranges(const T& y, const T& of_y, const T& x, const T& of_x) {
    using traits = number_traits<T>;
    const T v = system_function<elementary_function::atan2>(y, x);
    const bool may_be_origin = !(traits::abs(x) > of_x) && !(traits::abs(y) > of_y);
    if (!traits::is_finite(of_x) || !traits::is_finite(of_y) || may_be_origin)
        return {v, traits::infinity()};
    if (y == 0 && of_y == 0 && x > of_x && v == 0) return {v, T(0)};
    const T own = error_of_function<elementary_function::atan2>(v);
    // True if all y are above, or below, the cut along the negative x axis. (atan2 takes −0 as
    // below it.)
    const bool above = y >= of_y && !std::signbit(y), below = y < -of_y;
    const T range = traits::abs(v) + T(3.14159265358979323846264338327950288L);
    if (!(x > of_x) && !above && !below) return {v, enlarged<T>(range)};
    if (of_x == 0 && of_y == 0) return {v, enlarged<T>(own)};
    const T error = own + change_of_angle(y, of_y, x, of_x);
    return {v, enlarged<T>(error < range ? error : range)};
}

}  // namespace detail

}  // namespace errbound
