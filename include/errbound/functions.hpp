// Functions of tracked numbers: square root, fused multiply and add, absolute value, lesser and
// greater.
//
//   errbound::tracked<double> x = ...;
//   sqrt(x * x + y * y);            // found by its argument: no errbound:: is needed
//
// They take a number for what any rule says of it, |value() − x| <= error(), and hand the rule back
// what is known of the result (tracked::within). What is not known not to be in a function's
// domain gives a result of which nothing is known.
//
// Derivations are of numbers rounded in any direction, ε = 2u: a rounded result keeps at least
// 1 − ε of a bound, but for η where it underflows.
#pragma once

#include <errbound/error_free.hpp>
#include <errbound/tracked.hpp>

namespace errbound {

namespace detail {

/// Pays for up to six roundings on the way to a bound, as in the rule `tight`: (1 + 8ε)(1 − ε)^6
/// > 1.
template <class T>
constexpr T enlarged(const T& bound) {
    return rounded_product(bound, T(1 + 8 * number_traits<T>::epsilon()));
}

/// At least the error of a result that is rounded to v.
template <class T>
constexpr T rounding_of(const T& v) {
    using traits = number_traits<T>;
    return rounded_product(traits::abs(v), T(traits::epsilon() * (1 + traits::epsilon()))) +
           traits::underflow_unit();
}

/// NaN and infinity, which say that nothing is known, are passed on.
template <class T, class Rule>
constexpr T larger_error(const tracked<T, Rule>& a, const tracked<T, Rule>& b) {
    const T x = a.error(), y = b.error();
    return x <= y ? y : y <= x ? x : number_traits<T>::infinity();
}

/// a if it is certainly not greater than b; else a's value, known as well as the worse of the two.
template <class T, class Rule>
constexpr tracked<T, Rule> lesser_or_either(const tracked<T, Rule>& a, const tracked<T, Rule>& b) {
    const sign_type order = compare(a, b);
    if (order == sign_type::negative || order == sign_type::zero) return a;
    return tracked<T, Rule>::within(a.value(), larger_error(a, b));
}

}  // namespace detail

/// √x; unknown where x may be negative. Exact where x is and its root is a T.
///
/// With e = x.error() and x̂ = x.value(): |√x − √x̂| = |x − x̂|/(√x + √x̂) <= e/(√x̂ + √(x̂ − e)), and
/// the computed root of x̂ is off by a rounding of its own. The divisor is rounded up to three times
/// on its way ((x̂ − e), its root, the sum; v itself is one), the quotient and the sum once each.
/// Proof: proofs/IeeeFunctions.v, sqrt_known; in any direction, proofs/Functions.v, sqrt_sound.
template <class T, class Rule>
constexpr tracked<T, Rule> sqrt(const tracked<T, Rule>& x) {
    static_assert(has_subnormals<T>, "errbound: sqrt needs a number type with subnormal numbers");
    using traits = number_traits<T>;
    using number = tracked<T, Rule>;
    const T v = traits::sqrt(x.value()), e = x.error();
    // x̂ < e: a difference that is not 0 does not round to 0.
    if (!(x.value() >= e)) return number::within(v, traits::infinity());
    if (e == 0) {
        const with_error<T> square = two_product(v, v);
        if (product_error_is_exact(v, v, square) && square.error == 0 && square.value == x.value())
            return v;
        return number::within(v, detail::enlarged<T>(detail::rounding_of(v)));
    }
    const T divisor = v + traits::sqrt(T(x.value() - e));
    return number::within(
        v, detail::enlarged<T>(e / divisor + T(detail::rounding_of(v) + traits::underflow_unit())));
}

/// |x|, by the sign of its value: off by no more than x, for ||x| − |x̂|| <= |x − x̂|.
/// Proof: proofs/IeeeFunctions.v, abs_known.
template <class T, class Rule>
constexpr tracked<T, Rule> abs(const tracked<T, Rule>& x) {
    const bool below = x.value() < 0;
    if (const sign_type sign = sign_of(x);
        sign == (below ? sign_type::negative : sign_type::positive) || sign == sign_type::zero)
        return below ? -x : x;
    return tracked<T, Rule>::within(number_traits<T>::abs(x.value()), x.error());
}

/// The lesser of a and b, by their values, as plain arithmetic has it. Where it is not certain that
/// this is the lesser one, off by no more than the larger of their errors, for |min(a, b) −
/// min(c, d)| <= max(|a − c|, |b − d|). Proof: proofs/IeeeFunctions.v, min_known.
template <class T, class Rule>
constexpr tracked<T, Rule> min(const tracked<T, Rule>& a, const tracked<T, Rule>& b) {
    return b.value() < a.value() ? detail::lesser_or_either(b, a) : detail::lesser_or_either(a, b);
}
/// The greater of a and b, likewise. Proof: proofs/IeeeFunctions.v, max_known.
template <class T, class Rule>
constexpr tracked<T, Rule> max(const tracked<T, Rule>& a, const tracked<T, Rule>& b) {
    return a.value() < b.value() ? -detail::lesser_or_either(-b, -a)
                                 : -detail::lesser_or_either(-a, -b);
}

/// ab + c, rounded once: by number_traits<T>::fma, which is slow where the processor has none.
///
/// With errors σ: |v − (ab + c)| <= |v|ε/(1 − ε) + η + |â|σb + σa(|b̂| + σb) + σc. Each product may
/// lose η where it underflows, and |b̂| + σb, rounded before, some more of it, which the third η
/// pays where σa(|b̂| + σb) is so small that the factor 1 + 8ε is lost; the longest way to the bound
/// has six roundings. Proof: proofs/IeeeFunctions.v, fma_known; in any direction,
/// proofs/Functions.v, fma_sound.
template <class T, class Rule>
constexpr tracked<T, Rule> fma(const tracked<T, Rule>& a, const tracked<T, Rule>& b,
                               const tracked<T, Rule>& c) {
    static_assert(has_subnormals<T>, "errbound: fma needs a number type with subnormal numbers");
    using traits = number_traits<T>;
    const T v = traits::fma(a.value(), b.value(), c.value());
    const T of_a = a.error(), of_b = b.error(), of_c = c.error();
    const bool product_is_zero = (a.value() == 0 && of_a == 0) || (b.value() == 0 && of_b == 0);
    if (product_is_zero && traits::is_finite(v)) return c;  // whose value v is
    const T products = detail::rounded_product(traits::abs(a.value()), of_b) +
                       detail::rounded_product(of_a, T(traits::abs(b.value()) + of_b));
    return tracked<T, Rule>::within(
        v, detail::enlarged<T>(detail::rounding_of(v) +
                               (products + T(of_c + 3 * traits::underflow_unit()))));
}

}  // namespace errbound
