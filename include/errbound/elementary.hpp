// Elementary functions of tracked numbers: exp, exp2, expm1, log, log2, log10, log1p, sin, cos,
// tan, asin, acos, atan, sinh, cosh, tanh, asinh, acosh, atanh, cbrt, pow with any exponent, atan2.
//
//   errbound::tracked<double> x = ...;
//   exp(-x * x);            // found by its argument: no errbound:: is needed
//
// Values are those of the system's functions. How far these are off is an assumption, which
// function_error names; what an argument's error does to the result is derived here. Arguments are
// taken for what any rule says of them, |value() − x| <= error(), and what is known of the result
// is handed to the rule (tracked::within). Where an argument may be outside of the function's
// domain, or at a pole, nothing is known of the result.
//
// On the host, in rounding to nearest, under any rule. Not in constant expressions, and not in
// device code: a device's functions have other errors, and no function_error names them.
//
// Notation: x̂ and e an argument's value and error, v the computed result, f the function, η the
// smallest positive number, u = ε/2 the unit roundoff. A computed bound keeps at least (1 − u)^13
// of itself on its way, for which enlarged() pays, (1 + 16u)(1 − u)^13 > 1; what underflows is
// counted.
#pragma once

#include <cmath>
#include <concepts>
#include <errbound/conversion.hpp>
#include <errbound/error_free.hpp>
#include <errbound/functions.hpp>
#include <errbound/small_floats.hpp>
#include <errbound/tracked.hpp>
#include <type_traits>

namespace errbound {

/// As the C library names them.
enum class elementary_function {
    exp,
    exp2,
    expm1,
    log,
    log2,
    log10,
    log1p,
    sin,
    cos,
    tan,
    asin,
    acos,
    atan,
    sinh,
    cosh,
    tanh,
    asinh,
    acosh,
    atanh,
    cbrt,
    pow,
    atan2
};

namespace detail {

/// In the order of elementary_function: at least what function_error's comment names.
constexpr double documented_error(elementary_function f, bool is_wide) {
    constexpr double narrow[] = {1, 1, 2, 1, 2, 3, 2, 1, 1, 2, 1, 1, 1, 3, 3, 3, 3, 3, 3, 5, 1, 2};
    constexpr double wide[] = {2, 2, 4, 2, 4, 3, 4, 3, 3, 3, 2, 2, 2, 4, 4, 4, 5, 5, 5, 2, 4, 3};
    return (is_wide ? wide : narrow)[static_cast<int>(f)];
}

}  // namespace detail

/// The assumption: wherever the system's function F has a finite result v for arguments of type T
/// in its domain, |v − f| is at most so many units in the last place of the exact result f, which
/// are of η where f is subnormal; in rounding to nearest. From 0.5 to 1024.
///
/// The defaults are at least the errors that the GNU C library documents (its manual, "Known
/// Maximum Errors in Math Functions", x86-64; for long double the larger one of those of 80 and 128
/// bits) and those found by Gladman, Innocente, Mather and Zimmermann (Accuracy of Mathematical
/// Functions in Single, Double, Double Extended, and Quadruple Precision), rounded up. `errbound
/// validate --functions all` tells whether they hold on a system. For another library, or closer
/// bounds, specialise it before the first use:
///
///   template <>
///   inline constexpr double errbound::function_error<errbound::elementary_function::exp, double> =
///       0.52;
template <elementary_function F, class T>
inline constexpr double function_error = detail::documented_error(F, number_traits<T>::digits > 53);

namespace detail {

/// The type whose functions serve T: T itself, or float for types of 8 and 16 bits.
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
                  "errbound: elementary functions are those of float, double, long double and the "
                  "types of 8 and 16 bits");
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

/// At least |v − f|, but for enlarged(). With k units: the last place of f is at most ε|f| + η, and
/// |f| <= (|v| + kη)/(1 − kε), so that |v − f| <= kε|v|/(1 − kε) + kη + k²εη/(1 − kε); and
/// 1/(1 − kε) < 1 + 2kε, k²ε < 1/8. Another 2kε >= u pays for k that T rounds, and another η for
/// the product's underflow.
template <elementary_function F, class T>
T error_of_function(const T& v) {
    using traits = number_traits<T>;
    constexpr double k = function_error<F, T>;
    static_assert(k >= 0.5 && k <= 1024,
                  "errbound: function_error is from 0.5 to 1024 units in the last place");
    constexpr T relative = T(k) * traits::epsilon();
    return rounded_product(traits::abs(v), T(relative * (1 + 4 * relative))) +
           T(static_cast<int>(k) + 2) * traits::underflow_unit();
}

/// A value, and at least its distance from the exact one, but for enlarged() where that is said;
/// infinite or NaN where nothing is known.
template <class T>
struct bounded {
    T value, error;
};

/// A function's value at a T, but for enlarged().
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

/// Whether every number within e of x̂ is in the domain of F, and no pole.
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

/// Whether v³ = x.
template <class T>
bool is_cube_root(const T& v, const T& x) {
    const with_error<T> square = two_product(v, v), cube = two_product(square.value, v);
    return product_error_is_exact(v, v, square) && square.error == 0 &&
           product_error_is_exact(square.value, v, cube) && cube.error == 0 && cube.value == x;
}

/// Whether v is the exact result for an exact x. There are no other rational results of rational
/// arguments, but for the logarithms of powers of ten (by the theorems of Lindemann, and of
/// Gelfond and Schneider).
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

/// Where |f'| does not decrease: for greater arguments, for lesser ones, away from zero, towards
/// it. On both sides of zero alike, for the last two.
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

/// By how much an argument can change before f' changes by much.
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

/// x̂ ± distance or, where that is not a T, the next one beyond; of the domains that have their
/// ends, no number beyond these.
template <elementary_function F, class T>
T moved(const T& x, const T& distance, bool up) {
    using enum elementary_function;
    const with_error<T> sum = two_sum(x, up ? distance : T(-distance));
    T p = sum.value;
    // An error that is NaN (overflow) steps on, too.
    if (!(up ? sum.error <= 0 : sum.error >= 0))
        p = std::nextafter(p, up ? number_traits<T>::infinity() : T(-number_traits<T>::infinity()));
    if constexpr (F == asin || F == acos) return p > 1 ? T(1) : p < -1 ? T(-1) : p;
    if constexpr (F == acosh) return p < 1 ? T(1) : p;
    return p;
}

/// At least |v − f(x)| for x within e > 0 of x̂, all of them in the domain.
///
/// |f(x) − f(x̂)| is at most the integral of |f'| over the e beyond x̂ on the side where it is
/// steeper. On a longer way there, from x̂ to p, at a distance d >= e, the mean of |f'| is no less,
/// so that it is at most (e/d)·|f(p) − f(x̂)|: f is monotone there. A d of about √ε natural
/// distances gives the derivative to about √ε, whatever e. Where |f'| grows towards zero, p goes
/// beyond only if x can be zero, and then at d = e: the integral is still the largest of all
/// intervals of that length with an end at x̂.
template <elementary_function F, class T>
T error_by_slope(const T& x, const T& e, const T& v) {
    using traits = number_traits<T>;
    constexpr steeper_side side = steeper<F>();
    const T size = traits::abs(x);
    const bool up =
        side == steeper_side::above ||
        (side == steeper_side::outward ? x >= 0 : side == steeper_side::inward && x < 0);
    T distance = traits::max(
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
    // Where the way is rounded to e or less, or infinite, the share is 1.
    const bool shares = !to_the_end && way > e && traits::is_finite(way);
    const T share = shares ? T(e / way + traits::underflow_unit()) : T(1);
    return own + (rounded_product(share, difference) + traits::underflow_unit());
}

/// At least |f(x) − f(x̂)| for f = sin or cos, `slope` of its derivative at x̂, the other one's
/// value: with d = x − x̂, |2 sin(d/2) cos(x̂ + d/2)| <= e·min(1, |cos x̂| + e/2), likewise of cos.
template <class T>
T change_of_wave(const bounded<T>& slope, const T& e) {
    using traits = number_traits<T>;
    const T steepest = traits::abs(slope.value) + (slope.error + e / 2);
    return rounded_product(e, steepest < 1 ? enlarged<T>(steepest) : T(1)) +
           traits::underflow_unit();
}

/// At least |tan x − tan x̂| for x within e of x̂; infinite where a pole may be among them. With
/// t = |tan x̂| and q = tan e, e < π/2: tan(x̂ + d) − tan x̂ = tan d (1 + tan² x̂)/(1 − tan x̂ tan d) is
/// at most q(1 + t²)/(1 − tq), and there is no pole as long as tq < 1.
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

/// F of what is within e of x̂.
template <elementary_function F, class T>
bounded<T> function_of_range(const T& x, const T& e) {
    using enum elementary_function;
    using traits = number_traits<T>;
    const T v = system_function<F>(x);
    if (!traits::is_finite(x) || !traits::is_finite(e) || !is_in_domain<F>(x, e))
        return {v, traits::infinity()};
    const T own = error_of_function<F>(v);
    if (e == 0) return {v, is_exact_result<F>(x, v) ? T(0) : enlarged<T>(own)};
    if constexpr (F == sin || F == cos) {
        constexpr elementary_function derivative = F == sin ? cos : sin;
        const T error = own + change_of_wave<T>(evaluated<derivative>(x), e);
        // No more than the distance of v from the other end of the range.
        const T range = 1 + traits::abs(v);
        return {v, enlarged<T>(error < range ? error : range)};
    } else if constexpr (F == tan) {
        return {v, enlarged<T>(own + change_of_tangent<T>({v, own}, e))};
    } else {
        return {v, enlarged<T>(error_by_slope<F>(x, e, v))};
    }
}

/// At least |v − x^y| for |x̂| > e_x, where v is the computed power of x̂ and ŷ.
///
/// |log(x^y) − log(x̂^ŷ)| <= |ŷ|·λ + e_y·(|log |x̂|| + λ) =: s, λ = log(|x̂|/(|x̂| − e_x)), of which
/// log1p(e_x/(|x̂| − e_x)) is another form; and x^y is off from x̂^ŷ by a factor of at most e^s.
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

/// At least the error of x^n for a whole n > 0, where x may be zero: |x^n − x̂^n| <= (|x̂| + e)^n −
/// |x̂|^n.
template <class T>
T error_of_power_at_zero(const T& size, const T& e, const T& n, const T& v) {
    using enum elementary_function;
    const T own = error_of_function<pow>(v);
    const T end = system_function<pow>(moved<pow>(size, e, true), n);
    return own + ((end - number_traits<T>::abs(v)) + (error_of_function<pow>(end) + own));
}

/// At least |atan2(y, x) − atan2(ŷ, x̂)| where the path from one to the other crosses no cut:
/// infinite where this does not tell. The angle's tangent is (x̂·dy − ŷ·dx)/(x̂² + ŷ² + x̂·dx + ŷ·dy),
/// and an angle is at most its tangent. In units of the larger of |x̂| and |ŷ|, which cannot be
/// zero; what underflows there, four scalings and products at most in each sum, is less than η
/// each.
template <class T>
T change_of_angle(const T& y, const T& of_y, const T& x, const T& of_x) {
    using traits = number_traits<T>;
    const T larger = traits::max(traits::abs(x), traits::abs(y));
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

/// x^y of what is within e_x of x̂ and e_y of ŷ.
template <class T>
bounded<T> power_of_ranges(const T& x, const T& of_x, const T& y, const T& of_y) {
    using traits = number_traits<T>;
    const T v = system_function<elementary_function::pow>(x, y);
    const bounded<T> unknown{v, traits::infinity()};
    // A number that is not finite is among the errors, too.
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

/// The angle of (x, y) in [−π, π] of what is within e_y of ŷ and e_x of x̂.
template <class T>
bounded<T> angle_of_ranges(const T& y, const T& of_y, const T& x, const T& of_x) {
    using traits = number_traits<T>;
    const T v = system_function<elementary_function::atan2>(y, x);
    const bool may_be_origin = !(traits::abs(x) > of_x) && !(traits::abs(y) > of_y);
    if (!traits::is_finite(of_x) || !traits::is_finite(of_y) || may_be_origin)
        return {v, traits::infinity()};
    if (y == 0 && of_y == 0 && x > of_x && v == 0) return {v, T(0)};
    const T own = error_of_function<elementary_function::atan2>(v);
    // What is not above or below the cut, where x may be negative. (−0 is below it.)
    const bool above = y >= of_y && !std::signbit(y), below = y < -of_y;
    const T range = traits::abs(v) + T(3.14159265358979323846264338327950288L);
    if (!(x > of_x) && !above && !below) return {v, enlarged<T>(range)};
    if (of_x == 0 && of_y == 0) return {v, enlarged<T>(own)};
    const T error = own + change_of_angle(y, of_y, x, of_x);
    return {v, enlarged<T>(error < range ? error : range)};
}

/// F of a number, in the type whose functions serve it.
template <elementary_function F, class T, class Rule>
tracked<T, Rule> function_of(const tracked<T, Rule>& x) {
    if constexpr (!std::is_same_v<T, function_type<T>>) {
        return convert<T>(function_of<F>(convert<function_type<T>>(x)));
    } else {
        const bounded<T> result = function_of_range<F>(x.value(), x.error());
        return tracked<T, Rule>::within(result.value, result.error);
    }
}

}  // namespace detail

// Where e of x is zero, an error is that of the system's function alone.

/// e^x; exact for an exact 0.
template <class T, class Rule>
tracked<T, Rule> exp(const tracked<T, Rule>& x) {
    return detail::function_of<elementary_function::exp>(x);
}
/// 2^x; exact for exact whole numbers.
template <class T, class Rule>
tracked<T, Rule> exp2(const tracked<T, Rule>& x) {
    return detail::function_of<elementary_function::exp2>(x);
}
/// e^x − 1; exact for an exact 0.
template <class T, class Rule>
tracked<T, Rule> expm1(const tracked<T, Rule>& x) {
    return detail::function_of<elementary_function::expm1>(x);
}

/// The natural logarithm; unknown unless x is certainly positive. Exact for an exact 1.
template <class T, class Rule>
tracked<T, Rule> log(const tracked<T, Rule>& x) {
    return detail::function_of<elementary_function::log>(x);
}
/// To base 2, likewise; exact for exact powers of two.
template <class T, class Rule>
tracked<T, Rule> log2(const tracked<T, Rule>& x) {
    return detail::function_of<elementary_function::log2>(x);
}
/// To base 10, likewise; exact for an exact 1.
template <class T, class Rule>
tracked<T, Rule> log10(const tracked<T, Rule>& x) {
    return detail::function_of<elementary_function::log10>(x);
}
/// log(1 + x); unknown unless x is certainly greater than −1. Exact for an exact 0.
template <class T, class Rule>
tracked<T, Rule> log1p(const tracked<T, Rule>& x) {
    return detail::function_of<elementary_function::log1p>(x);
}

/// Of an angle in radians, of any size; exact for an exact 0. Off by no more than to the other end
/// of [−1, 1].
template <class T, class Rule>
tracked<T, Rule> sin(const tracked<T, Rule>& x) {
    return detail::function_of<elementary_function::sin>(x);
}
/// Likewise.
template <class T, class Rule>
tracked<T, Rule> cos(const tracked<T, Rule>& x) {
    return detail::function_of<elementary_function::cos>(x);
}
/// Unknown where x may be at a pole, or is off by more than 1.5. Exact for an exact 0.
template <class T, class Rule>
tracked<T, Rule> tan(const tracked<T, Rule>& x) {
    return detail::function_of<elementary_function::tan>(x);
}

/// In [−π/2, π/2]; unknown unless x is certainly in [−1, 1]. Exact for an exact 0.
template <class T, class Rule>
tracked<T, Rule> asin(const tracked<T, Rule>& x) {
    return detail::function_of<elementary_function::asin>(x);
}
/// In [0, π]; unknown unless x is certainly in [−1, 1]. Exact for an exact 1.
template <class T, class Rule>
tracked<T, Rule> acos(const tracked<T, Rule>& x) {
    return detail::function_of<elementary_function::acos>(x);
}
/// In [−π/2, π/2]; exact for an exact 0.
template <class T, class Rule>
tracked<T, Rule> atan(const tracked<T, Rule>& x) {
    return detail::function_of<elementary_function::atan>(x);
}

/// Exact for an exact 0, as are the next two.
template <class T, class Rule>
tracked<T, Rule> sinh(const tracked<T, Rule>& x) {
    return detail::function_of<elementary_function::sinh>(x);
}
template <class T, class Rule>
tracked<T, Rule> cosh(const tracked<T, Rule>& x) {
    return detail::function_of<elementary_function::cosh>(x);
}
template <class T, class Rule>
tracked<T, Rule> tanh(const tracked<T, Rule>& x) {
    return detail::function_of<elementary_function::tanh>(x);
}
/// Exact for an exact 0.
template <class T, class Rule>
tracked<T, Rule> asinh(const tracked<T, Rule>& x) {
    return detail::function_of<elementary_function::asinh>(x);
}
/// Not negative; unknown unless x is certainly 1 or more. Exact for an exact 1.
template <class T, class Rule>
tracked<T, Rule> acosh(const tracked<T, Rule>& x) {
    return detail::function_of<elementary_function::acosh>(x);
}
/// Unknown unless x is certainly between −1 and 1. Exact for an exact 0.
template <class T, class Rule>
tracked<T, Rule> atanh(const tracked<T, Rule>& x) {
    return detail::function_of<elementary_function::atanh>(x);
}

/// The cube root, of negative numbers too; exact where x is and its root is a T.
template <class T, class Rule>
tracked<T, Rule> cbrt(const tracked<T, Rule>& x) {
    return detail::function_of<elementary_function::cbrt>(x);
}

/// x^y by the system's function, for a number x that is certainly positive; for an x that may be
/// zero or negative where y is an exact whole number, positive if x may be zero. Elsewhere unknown,
/// but for an x that is exactly 0 and a y that is certainly positive. x^0 and 1^y are exactly 1
/// and x^1 is x. For whole exponents by products, as the rule has them: pow(x, int).
template <class T, class Rule>
tracked<T, Rule> pow(const tracked<T, Rule>& x, const tracked<T, Rule>& y) {
    if constexpr (!std::is_same_v<T, detail::function_type<T>>) {
        using wide = detail::function_type<T>;
        return convert<T>(pow(convert<wide>(x), convert<wide>(y)));
    } else {
        const T e = y.error();
        if (y.value() == 1 && e == 0) return x;
        const auto result = detail::power_of_ranges<T>(x.value(), x.error(), y.value(), e);
        return tracked<T, Rule>::within(result.value, result.error);
    }
}
/// Of an exact exponent; of an exact base.
template <class T, class Rule>
tracked<T, Rule> pow(const tracked<T, Rule>& x, const std::type_identity_t<T>& y) {
    return pow(x, tracked<T, Rule>(y));
}
template <class T, class Rule>
tracked<T, Rule> pow(const std::type_identity_t<T>& x, const tracked<T, Rule>& y) {
    return pow(tracked<T, Rule>(x), y);
}

/// The angle of the point (x, y), in [−π, π]: π for a y that is exactly 0 and x < 0. Unknown where
/// the point may be the origin. Where it may be on either side of the negative x axis, it is known
/// no better than that range. Exact for a y that is exactly 0 and x > 0.
template <class T, class Rule>
tracked<T, Rule> atan2(const tracked<T, Rule>& y, const tracked<T, Rule>& x) {
    if constexpr (!std::is_same_v<T, detail::function_type<T>>) {
        using wide = detail::function_type<T>;
        return convert<T>(atan2(convert<wide>(y), convert<wide>(x)));
    } else {
        const auto result = detail::angle_of_ranges<T>(y.value(), y.error(), x.value(), x.error());
        return tracked<T, Rule>::within(result.value, result.error);
    }
}

}  // namespace errbound
