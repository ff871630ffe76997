// Elementary functions of tracked numbers: exp, exp2, expm1, log, log2, log10, log1p, sin, cos,
// tan, asin, acos, atan, sinh, cosh, tanh, asinh, acosh, atanh, cbrt, pow with any exponent, atan2.
//
//   errbound::tracked<double> x = ...;
//   exp(-x * x);            // found by its argument: no errbound:: is needed
//
// Values are those of the system's functions. How far these are off is an assumption, which
// function_error names; what an argument's error does to the result is derived in
// functions/function_of_range.hpp. Arguments are taken for what any rule says of them,
// |value() − x| <= error(), and what is known of the result is handed to the rule
// (tracked::within). Where an argument may be outside of the function's domain, or at a pole,
// nothing is known of the result.
//
// On the host, in rounding to nearest, under any rule. Not in constant expressions, and not in
// device code: a device's functions have other errors, and no function_error names them.
#pragma once

#include <complex>
#include <concepts>
#include <errbound/conversion.hpp>
#include <errbound/functions/function_error.hpp>
#include <errbound/functions/function_of_range.hpp>
#include <errbound/tracked.hpp>
#include <type_traits>

namespace errbound {

namespace detail {

/// A plain number that a tracked one is made of, within the error of its conversion.
template <class Number, class T, class Rule>
concept plain_number_for =
    !is_tracked<Number> && std::constructible_from<tracked<T, Rule>, const Number&>;

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

/// The cube root, of negative numbers too; exact where x is and the system gives its root.
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
/// Of a plain exponent; of a plain base. Exact where T holds it, else within the rounding error of
/// its conversion.
template <class T, class Rule, detail::plain_number_for<T, Rule> Number>
requires(!std::same_as<Number, int>) tracked<T, Rule> pow(const tracked<T, Rule>& x,
                                                          const Number& y) {
    return pow(x, tracked<T, Rule>(y));
}
template <class T, class Rule, detail::plain_number_for<T, Rule> Number>
tracked<T, Rule> pow(const Number& x, const tracked<T, Rule>& y) {
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
/// Where one of them is plain: as pow's.
template <class T, class Rule, detail::plain_number_for<T, Rule> Number>
tracked<T, Rule> atan2(const tracked<T, Rule>& y, const Number& x) {
    return atan2(y, tracked<T, Rule>(x));
}
template <class T, class Rule, detail::plain_number_for<T, Rule> Number>
tracked<T, Rule> atan2(const Number& y, const tracked<T, Rule>& x) {
    return atan2(tracked<T, Rule>(y), x);
}

// Complex numbers of tracked parts: write `abs(z)`, or `using std::abs;` before it in generic code;
// std::abs(z) does not compile. + − × ÷, `norm` and `conj` are those of std::complex.

/// |z|: hypot of the parts, without overflow or underflow on the way.
template <class T, class Rule>
tracked<T, Rule> abs(const std::complex<tracked<T, Rule>>& z) {
    return hypot(z.real(), z.imag());
}

/// The angle of z in [−π, π]; unknown where z may be 0. See atan2 for numbers near the cut.
template <class T, class Rule>
tracked<T, Rule> arg(const std::complex<tracked<T, Rule>>& z) {
    return atan2(z.imag(), z.real());
}

/// The number of size r and angle θ: r·cos θ and r·sin θ.
template <class T, class Rule>
std::complex<tracked<T, Rule>> polar(const tracked<T, Rule>& r, const tracked<T, Rule>& angle) {
    return {r * cos(angle), r * sin(angle)};
}

}  // namespace errbound
