// Bound rule `tight`: TightBound (Theorem 1 of the TightCCD paper), with its gaps closed.
//
// Notation: docs/notation.md; v is the computed result, σ a bound. Additions to the printed rule:
// bounds are inflated for their own roundings. Products add 4η: one η for an underflow of the
// value, three for products in the bound. Sums add no η (unless the type has no subnormal numbers):
// an inexact sum v is so large that |v|ε is at least its unit in the last place. A product with an
// exact zero is exact. Overflow and NaN give infinite or NaN bounds and no certain sign. Only under
// directed rounding, overflow to the largest finite number goes unnoticed. Without underflow the
// bound exceeds that of `safe` at most slightly: proofs/rules/ComputedComparison.v,
// tight_at_most_safe_computed.
#pragma once

#include <errbound/detail/absolute_bound.hpp>
#include <errbound/detail/rounded.hpp>
#include <errbound/detail/running_bound.hpp>
#include <errbound/detail/sum_of_bounds.hpp>
#include <errbound/rules/rule.hpp>

namespace errbound {

struct tight : detail::absolute_bound {
    static constexpr const char* name = "tight";
    static constexpr bool holds_in_directed_rounding = true;
    static constexpr bool holds_without_subnormals = true;

    /// |v − (a + b)| <= |v|ε/(1 − ε) + σa + σb. With p < 40, σa and σb are not inflated if
    /// they far exceed the error of this sum, as in long sums (detail/sum_of_bounds.hpp). Source:
    /// Theorem 1, Add. Proof: proofs/rules/IeeeRules.v, tight_add_known; in any direction,
    /// proofs/rules/Tight.v, tight_add_sound.
    template <class T>
    static constexpr bound<T> add(const T& v, rule_operand<T, tight> a, rule_operand<T, tight> b) {
        using traits = number_traits<T>;
        // Here |v|ε and the sum v may each lose less than η by underflow; x − x is exact.
        if constexpr (!has_subnormals<T>)
            if (v != 0 || traits::abs(a.value) != traits::abs(b.value))
                return {inflated<T>(rounding(v) + (a.bound.error + b.bound.error) +
                                    2 * traits::underflow_unit())};
        const T own = rounding(v);
        return {detail::sum_of_bounds<T>(inflated<T>(own + (a.bound.error + b.bound.error)), own,
                                         a.bound.error, b.bound.error)};
    }
    /// Source: Theorem 1, Subtract. Proof: proofs/rules/IeeeRules.v, tight_subtract_known; in any
    /// direction, proofs/rules/Tight.v, tight_subtract_sound.
    template <class T>
    static constexpr bound<T> subtract(const T& v, rule_operand<T, tight> a,
                                       rule_operand<T, tight> b) {
        return add(v, a, b);
    }
    /// |v − ab| <= |v|ε/(1 − ε) + |â|σb + σa|b̂| + σaσb. Proof: proofs/rules/IeeeRules.v,
    /// tight_multiply_known; in any direction, proofs/rules/Tight.v, tight_multiply_sound.
    template <class T>
    static constexpr bound<T> multiply(const T& v, rule_operand<T, tight> a,
                                       rule_operand<T, tight> b) {
        using traits = number_traits<T>;
        if (is_zero(a) || is_zero(b)) return {rounding(v)};  // 0, or NaN if the other is not finite
        const T inherited =
            detail::rounded_product(traits::abs(a.value), b.bound.error) +
            detail::rounded_product(a.bound.error, T(traits::abs(b.value) + b.bound.error));
        return {inflated<T>(rounding(v) + inherited + 4 * traits::underflow_unit())};
    }
    /// |v − a/b| <= |v|ε/(1 − ε) + (σa + |â/b̂|σb)/(|b̂| − σb) if |b̂| > σb, otherwise infinite.
    /// The paper prints the last term as (σa(|b̂| − σb) + (|â| + σa)σb)/((|b̂| − σb)|b̂|). It is
    /// the same, because that numerator is σa|b̂| + |â|σb. Source: Theorem 1, Divide. Proof:
    /// proofs/rules/IeeeRules.v, tight_divide_known; in any direction, proofs/rules/Tight.v,
    /// tight_divide_sound.
    template <class T>
    static constexpr bound<T> divide(const T& v, rule_operand<T, tight> a,
                                     rule_operand<T, tight> b) {
        using traits = number_traits<T>;
        const T distance = traits::abs(b.value) - b.bound.error;  // of b from zero
        if (!(distance > 0)) return {traits::infinity()};
        if constexpr (!has_subnormals<T>)
            if (!(distance > traits::underflow_unit())) return {traits::infinity()};
        if (is_zero(a)) return {rounding(v)};
        // |â/b̂| may have been rounded down, so it is inflated separately. If b is not exact, 4η
        // covers underflow in the numerator before the division enlarges it.
        const T quotient = inflated<T>(traits::abs(v) + traits::underflow_unit());
        const T lost = b.bound.error > 0 ? 4 * traits::underflow_unit() : T(0);
        const T inherited =
            (a.bound.error + detail::rounded_product(quotient, b.bound.error) + lost) / distance;
        return {inflated<T>(rounding(v) + inflated<T>(inherited) + 4 * traits::underflow_unit())};
    }
    /// If it underflows, value and bound are each off by less than η. Proof:
    /// proofs/rules/IeeeRules.v, tight_scale_known; in any direction, proofs/rules/Tight.v,
    /// tight_scale_sound.
    template <class T>
    static constexpr bound<T> scale(const T& v, rule_operand<T, tight> a, int e) {
        using traits = number_traits<T>;
        const T scaled = traits::scale(a.bound.error, e);
        const bool lossless = e >= 0 || (traits::scale(v, -e) == a.value &&
                                         traits::scale(scaled, -e) == a.bound.error);
        return {lossless ? scaled + (v - v) : inflated<T>(scaled + 2 * traits::underflow_unit())};
    }

    /// Σ aᵢbᵢ, with a running error bound (Higham 2002, Section 3.3). Roundings add at most
    /// |pᵢ|ε/(1 − ε) + η for each computed product pᵢ, and |sᵢ|ε/(1 − ε) for each computed partial
    /// sum sᵢ except s₁ = p₁. The arguments' errors add Σ |â|σb + σa(|b̂| + σb).
    ///
    /// One factor covers the roundings of this bound for m terms. Summation rounds each |pᵢ|ε and
    /// |sᵢ|ε at most m + 1 times, each argument's error at most m + 2 times. At most four more
    /// roundings follow. With j = m + 6, 1 + (j + 1)ε >= 1/(1 − jε) >= (1 − ε)^−j if j²ε <= 1/2.
    /// Underflow loses less than η per product, 2η per term with inexact arguments, and η at the
    /// end. Proof: proofs/rules/IeeeDotProduct.v, tight_dot_known; in any direction,
    /// proofs/rules/DotProduct.v, tight_dot_sound.
    template <class T>
    class dot_bound : detail::running_bound<T, dot_bound<T>,
                                            has_subnormals<T> ? number_traits<T>::digits - 2 : 0> {
        static constexpr bool serves = dot_bound::pays;

      public:
        constexpr void add_product(const T& product, const T&, const T& sum,
                                   rule_operand<T, tight> a,
                                   rule_operand<T, tight> b) requires serves {
            if (is_zero(a) || is_zero(b)) return;  // adds 0, or a NaN that makes the sum NaN
            this->add_term(T(rounding(product) + (first_ ? T(0) : rounding(sum))), a, b);
            first_ = false;
        }
        constexpr bound<T> finished(const T& sum) { return {this->closed() + (sum - sum)}; }

        static constexpr int factor_units(int terms) { return terms + 7; }
        static constexpr int underflows(int terms, int uncertain) {
            return terms + 2 * uncertain + 1;
        }

      private:
        bool first_ = true;
    };

  private:
    /// |v|ε(1 + ε), less than |v|ε/(1 − ε) by some |v|ε³, which the factor 1 + 8ε covers.
    template <class T>
    static constexpr T rounding(const T& v) {
        using traits = number_traits<T>;
        return detail::rounded_product(traits::abs(v),
                                       T(traits::epsilon() * (1 + traits::epsilon())));
    }
    // Covers six roundings in any direction: (1 + 8ε)(1 − ε)^6 > 1 for p >= 5 (p >= 3 to nearest).
    // The library's types with fewer bits only round to nearest.
    template <class T>
    static constexpr T inflated(const T& bound) {
        return detail::rounded_product(bound, T(1 + 8 * number_traits<T>::epsilon()));
    }
};

}  // namespace errbound
