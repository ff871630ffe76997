// Elementary functions of tracked numbers: exp, exp2, expm1, log, log2, log10, log1p, sin, cos,
// tan, asin, acos, atan, sinh, cosh, tanh, asinh, acosh, atanh, cbrt, pow with any exponent, atan2.
//   errbound::tracked<double> x = ...;
//   exp(-x * x);            // found by its argument: no errbound:: is needed
//
// Values are the C library's; its errors are an assumption (function_error). The error is infinite
// if the argument may be outside of the domain or at a pole, or if its error is infinite. It is 0
// for an exact argument 0 or 1 with a rational result, exp2 of whole numbers, log2 of powers of two
// and exact results of cbrt. (Exact cases of pow and atan2: see there.) Any rule, in rounding to
// nearest, on the host only: no constant expressions, no device code.
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

template <class Number, class T, class Rule>
concept plain_number_for =
    !is_tracked<Number> && std::constructible_from<tracked<T, Rule>, const Number&>;

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

template <class T, class Rule>
tracked<T, Rule> exp(const tracked<T, Rule>& x) {
    return detail::function_of<elementary_function::exp>(x);
}
template <class T, class Rule>
tracked<T, Rule> exp2(const tracked<T, Rule>& x) {
    return detail::function_of<elementary_function::exp2>(x);
}
template <class T, class Rule>
tracked<T, Rule> expm1(const tracked<T, Rule>& x) {
    return detail::function_of<elementary_function::expm1>(x);
}

template <class T, class Rule>
tracked<T, Rule> log(const tracked<T, Rule>& x) {
    return detail::function_of<elementary_function::log>(x);
}
template <class T, class Rule>
tracked<T, Rule> log2(const tracked<T, Rule>& x) {
    return detail::function_of<elementary_function::log2>(x);
}
template <class T, class Rule>
tracked<T, Rule> log10(const tracked<T, Rule>& x) {
    return detail::function_of<elementary_function::log10>(x);
}
template <class T, class Rule>
tracked<T, Rule> log1p(const tracked<T, Rule>& x) {
    return detail::function_of<elementary_function::log1p>(x);
}

/// x in radians, of any size. The error is at most about 1 + |value| if that of x is finite.
template <class T, class Rule>
tracked<T, Rule> sin(const tracked<T, Rule>& x) {
    return detail::function_of<elementary_function::sin>(x);
}
template <class T, class Rule>
tracked<T, Rule> cos(const tracked<T, Rule>& x) {
    return detail::function_of<elementary_function::cos>(x);
}
/// Infinite error also if the error of x is above 1.5.
template <class T, class Rule>
tracked<T, Rule> tan(const tracked<T, Rule>& x) {
    return detail::function_of<elementary_function::tan>(x);
}

template <class T, class Rule>
tracked<T, Rule> asin(const tracked<T, Rule>& x) {
    return detail::function_of<elementary_function::asin>(x);
}
template <class T, class Rule>
tracked<T, Rule> acos(const tracked<T, Rule>& x) {
    return detail::function_of<elementary_function::acos>(x);
}
template <class T, class Rule>
tracked<T, Rule> atan(const tracked<T, Rule>& x) {
    return detail::function_of<elementary_function::atan>(x);
}

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
template <class T, class Rule>
tracked<T, Rule> asinh(const tracked<T, Rule>& x) {
    return detail::function_of<elementary_function::asinh>(x);
}
template <class T, class Rule>
tracked<T, Rule> acosh(const tracked<T, Rule>& x) {
    return detail::function_of<elementary_function::acosh>(x);
}
template <class T, class Rule>
tracked<T, Rule> atanh(const tracked<T, Rule>& x) {
    return detail::function_of<elementary_function::atanh>(x);
}

/// The cube root, also of negative numbers. Exact if x and the C library's result are.
template <class T, class Rule>
tracked<T, Rule> cbrt(const tracked<T, Rule>& x) {
    return detail::function_of<elementary_function::cbrt>(x);
}

/// x^y. The error is infinite unless x is certainly positive, or y is an exact whole number
/// (positive if x may be zero). However, x^1 is x and, if both errors are finite, x^0 and 1^y are
/// exactly 1 and an exact 0 to a certainly positive power is 0. pow(x, int) multiplies by the rule.
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
/// A plain exponent or base: exact if T holds it, otherwise within its conversion's error.
template <class T, class Rule, detail::plain_number_for<T, Rule> Number>
requires(!std::same_as<Number, int>) tracked<T, Rule> pow(const tracked<T, Rule>& x,
                                                          const Number& y) {
    return pow(x, tracked<T, Rule>(y));
}
template <class T, class Rule, detail::plain_number_for<T, Rule> Number>
tracked<T, Rule> pow(const Number& x, const tracked<T, Rule>& y) {
    return pow(tracked<T, Rule>(x), y);
}

/// The angle of the point (x, y) in [−π, π]; π if y is exactly 0 and x < 0. The error is infinite
/// if the point may be the origin. The bound covers [−π, π] if the point may be on both sides of
/// the negative x axis. Exact if y is exactly 0 and x is certainly positive.
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
template <class T, class Rule, detail::plain_number_for<T, Rule> Number>
tracked<T, Rule> atan2(const tracked<T, Rule>& y, const Number& x) {
    return atan2(y, tracked<T, Rule>(x));
}
template <class T, class Rule, detail::plain_number_for<T, Rule> Number>
tracked<T, Rule> atan2(const Number& y, const tracked<T, Rule>& x) {
    return atan2(tracked<T, Rule>(y), x);
}

// Complex numbers: write `abs(z)`; std::abs(z) does not compile. + − × ÷, `norm` and `conj` work.

/// |z|: hypot of the parts, without overflow or underflow on the way.
template <class T, class Rule>
tracked<T, Rule> abs(const std::complex<tracked<T, Rule>>& z) {
    return hypot(z.real(), z.imag());
}

/// The angle of z in [−π, π]. Infinite error if z may be 0. See atan2 for numbers near the cut.
template <class T, class Rule>
tracked<T, Rule> arg(const std::complex<tracked<T, Rule>>& z) {
    return atan2(z.imag(), z.real());
}

template <class T, class Rule>
std::complex<tracked<T, Rule>> polar(const tracked<T, Rule>& r, const tracked<T, Rule>& angle) {
    return {r * cos(angle), r * sin(angle)};
}

}  // namespace errbound
