// Bound rule `sharp`: TightBound with the unit roundoff u in place of ε = 2u, for rounding to
// nearest only. Its bounds are down to half of `tight`'s.
//
// Notation: docs/notation.md; v is the computed result, σ a bound. The rounding error of an
// operation is at most max(u|v|, η/2), that of a sum at most u|v| (Higham 2002, Theorem 2.3). If a
// sum is inexact, ulp(v)/2 is a number, so the rounded u|v| is at least ulp(v)/2. A product and
// three products in its bound may each lose η/2, so 2η is added. Exact zeros and overflow are
// treated as in `tight`; no overflow goes unnoticed.
#pragma once

#include <errbound/detail/absolute_bound.hpp>
#include <errbound/detail/rounded.hpp>
#include <errbound/detail/running_bound.hpp>
#include <errbound/detail/sum_of_bounds.hpp>
#include <errbound/rules/rule.hpp>

namespace errbound {

struct sharp : detail::absolute_bound {
    static constexpr const char* name = "sharp";
    static constexpr int minimal_precision = 3;

    /// |v − (a + b)| <= u|v| + σa + σb. The bound has three roundings, (1 + u)³ <= 1 + 4u = 1 + 2ε
    /// for u <= 1/8; 1 + ε is too small. Proof: proofs/rules/IeeeRules.v, sharp_add_known.
    template <class T>
    static constexpr bound<T> add(const T& v, rule_operand<T, sharp> a, rule_operand<T, sharp> b) {
        using traits = number_traits<T>;
        const T own = rounding(v);
        const T enlarged = detail::rounded_product(T(own + (a.bound.error + b.bound.error)),
                                                   T(1 + 2 * traits::epsilon()));
        return {detail::sum_of_bounds<T>(enlarged, own, a.bound.error, b.bound.error)};
    }
    /// Proof: proofs/rules/IeeeRules.v, sharp_subtract_known.
    template <class T>
    static constexpr bound<T> subtract(const T& v, rule_operand<T, sharp> a,
                                       rule_operand<T, sharp> b) {
        return add(v, a, b);
    }
    /// |v − ab| <= u|v| + η/2 + |â|σb + σa(|b̂| + σb). Proof: proofs/rules/IeeeRules.v,
    /// sharp_multiply_known.
    template <class T>
    static constexpr bound<T> multiply(const T& v, rule_operand<T, sharp> a,
                                       rule_operand<T, sharp> b) {
        using traits = number_traits<T>;
        if (is_zero(a) || is_zero(b)) return {rounding(v)};  // 0, or NaN if the other is not finite
        const T inherited =
            detail::rounded_product(traits::abs(a.value), b.bound.error) +
            detail::rounded_product(a.bound.error, T(traits::abs(b.value) + b.bound.error));
        return {inflated<T>((rounding(v) + 2 * traits::underflow_unit()) + inherited)};
    }
    /// If |b̂| > σb: |v − a/b| <= u|v| + η/2 + (σa + |â/b̂|σb)/(|b̂| − σb), as in `tight`;
    /// otherwise infinite. Proof: proofs/rules/IeeeRules.v, sharp_divide_known.
    template <class T>
    static constexpr bound<T> divide(const T& v, rule_operand<T, sharp> a,
                                     rule_operand<T, sharp> b) {
        using traits = number_traits<T>;
        const T distance = traits::abs(b.value) - b.bound.error;  // of b from zero
        if (!(distance > 0)) return {traits::infinity()};
        if (is_zero(a)) return {rounding(v)};
        // |â/b̂| <= |v|(1 + u) + η/2. If b is not exact, η covers underflow in the numerator before
        // the division enlarges it. The factors cover eight roundings: (1 + u)^8 <= (1 + 8u)².
        const T quotient = inflated<T>(traits::abs(v) + traits::underflow_unit());
        const T lost = b.bound.error > 0 ? traits::underflow_unit() : T(0);
        const T inherited =
            (a.bound.error + (detail::rounded_product(quotient, b.bound.error) + lost)) / distance;
        return {inflated<T>((rounding(v) + 2 * traits::underflow_unit()) + inflated<T>(inherited))};
    }
    /// If it underflows, value and bound are each off by at most η/2. Proof:
    /// proofs/rules/IeeeRules.v, sharp_scale_known.
    template <class T>
    static constexpr bound<T> scale(const T& v, rule_operand<T, sharp> a, int e) {
        using traits = number_traits<T>;
        const T scaled = traits::scale(a.bound.error, e);
        const bool lossless = e >= 0 || (traits::scale(v, -e) == a.value &&
                                         traits::scale(scaled, -e) == a.bound.error);
        return {lossless ? scaled + (v - v) : inflated<T>(scaled + traits::underflow_unit())};
    }

    /// Σ aᵢbᵢ, with a running error bound, as in `tight`. A product p is off by at most u|p| + η/2.
    /// The partial sum s' = fl(s + p) is off by at most min(u|s'|, |p|, |s|): s' is the number
    /// nearest to s + p, and the numbers s and p are |p| and |s| away from s + p. One factor covers
    /// the roundings of the bound, j = m + 6 for m terms as in `tight`: (1 + u)^j <= 1 + ju + (ju)²
    /// <= 1 + (⌈j/2⌉ + 1)ε if j²ε <= 4. Underflow loses at most η/2 for each p and each u|p|, η per
    /// term with inexact arguments, and η/2 at the end. Source: Higham 2002, Section 3.3;
    /// Jeannerod, Rump 2013 (SIAM J. Matrix Anal. Appl. 34). Proof: proofs/rules/IeeeDotProduct.v,
    /// sharp_dot_known.
    template <class T>
    class dot_bound : detail::running_bound<T, dot_bound<T>, number_traits<T>::digits + 1> {
        static constexpr bool serves = dot_bound::pays;

      public:
        constexpr void add_product(const T& product, const T& before, const T& sum,
                                   rule_operand<T, sharp> a,
                                   rule_operand<T, sharp> b) requires serves {
            using traits = number_traits<T>;
            if (is_zero(a) || is_zero(b)) return;  // adds 0, or a NaN that makes the sum NaN
            const T smaller = least(traits::abs(product), traits::abs(before));
            this->add_term(T(rounding(product) + least(rounding(sum), smaller)), a, b);
        }
        constexpr bound<T> finished(const T& sum) { return {this->closed() + (sum - sum)}; }

        static constexpr int factor_units(int terms) { return (terms + 7) / 2 + 1; }
        static constexpr int underflows(int terms, int uncertain) { return terms + uncertain + 1; }

      private:
        static constexpr T least(const T& x, const T& y) { return y < x ? y : x; }
    };

  private:
    template <class T>
    static constexpr T rounding(const T& v) {
        return detail::rounded_product(number_traits<T>::abs(v), number_traits<T>::unit_roundoff());
    }
    // Covers five roundings: (1 + u)^5 <= 1 + 8u = 1 + 4ε for u <= 1/8.
    template <class T>
    static constexpr T inflated(const T& bound) {
        return detail::rounded_product(bound, T(1 + 4 * number_traits<T>::epsilon()));
    }
};

}  // namespace errbound
