// Bound rule `tight`: TightBound (Theorem 1 of the TightCCD paper), with its gaps closed.
//
// Notation: u the unit roundoff, ε = 2u, η the smallest positive number, v the computed result,
// σ a bound. Closed here, beyond the printed rule:
//  * the bound is itself rounded: every bound is multiplied by 1 + 8ε at the end, which exceeds
//    the at most six roundings (each within a factor 1 ± ε, in any rounding direction) on the way
//    to it: (1 + 8ε)(1 − ε)^6 > 1 from 5 bits of precision on (from 3 in rounding to nearest; with
//    fewer, that it holds is checked case by case: errbound/validation/tiny_check.hpp);
//  * underflow: a product's value and the three products inside its bound are each off by less
//    than η where they underflow, so 4η is added. Sums need none: a sum that is not exact is at
//    least 2^p·η in size, and |v|ε is then at least its last place;
//    Where there are no subnormal numbers (Boost.Multiprecision's), η is the smallest normal one:
//    sums that underflow are off by less than it, and |v|ε is where it underflows, so 2η is added,
//    but where x and −x were added; and a distance of two numbers is more than η, or not known;
//  * exact zero: a product with an exact zero is an exact zero, without the 4η;
//  * overflow: an infinite or NaN value has an infinite or NaN bound, which no sign passes. (Under
//    directed rounding an operation on values or bounds may overflow to the largest finite number
//    instead; that is the one thing not noticed there.)
//
// Where nothing underflows the bound exceeds that of the rule `safe` by little, if at all:
// proofs/ComputedComparison.v, tight_at_most_safe_computed.
#pragma once

#include <errbound/detail/rounded.hpp>
#include <errbound/detail/running_bound.hpp>
#include <errbound/detail/sum_of_bounds.hpp>
#include <errbound/rules/rule.hpp>

namespace errbound {

struct tight {
    static constexpr const char* name = "tight";
    /// But for the overflow that is named above.
    static constexpr bool holds_in_directed_rounding = true;
    static constexpr bool holds_without_subnormals = true;

    /// |value − true value| <= error.
    template <class T>
    struct bound {
        T error;
    };

    /// Proof: proofs/IeeeRules.v, tight_exact_known.
    template <class T>
    static constexpr bound<T> exact(const T& value) {
        return {value - value};  // 0, or NaN if the value is not finite
    }
    /// Proof: proofs/IeeeRules.v, tight_within_known.
    template <class T>
    static constexpr bound<T> within(const T& value, const T& error) {
        return {error >= 0 ? error + (value - value) : number_traits<T>::infinity()};
    }
    /// The bound of a number of this value that is known to be 0.
    /// Proof: proofs/IeeeRules.v, tight_within_known.
    template <class T>
    static constexpr bound<T> displacement(const T& value) {
        return within<T>(value, number_traits<T>::abs(value));
    }
    /// Proof of the sign that it makes: proofs/IeeeRules.v, sign_of_known.
    template <class T>
    static constexpr T error(const T&, const bound<T>& b) {
        return b.error;
    }

    /// |v − (a + b)| <= |v|ε/(1 − ε) + σa + σb. Source: Theorem 1, Add. In long sums of short
    /// formats the factor does not multiply σa and σb (detail/sum_of_bounds.hpp).
    /// Proof: proofs/IeeeRules.v, tight_add_known; in any direction, proofs/Tight.v,
    /// tight_add_sound.
    template <class T>
    static constexpr bound<T> add(const T& v, rule_operand<T, tight> a, rule_operand<T, tight> b) {
        using traits = number_traits<T>;
        if constexpr (!has_subnormals<T>)
            if (v != 0 || traits::abs(a.value) != traits::abs(b.value))
                return {inflated<T>(rounding(v) + (a.bound.error + b.bound.error) +
                                    2 * traits::underflow_unit())};
        const T own = rounding(v);
        return {detail::sum_of_bounds<T>(inflated<T>(own + (a.bound.error + b.bound.error)), own,
                                         a.bound.error, b.bound.error)};
    }
    /// Source: Theorem 1, Subtract. Proof: proofs/IeeeRules.v, tight_subtract_known; in any
    /// direction, proofs/Tight.v, tight_subtract_sound.
    template <class T>
    static constexpr bound<T> subtract(const T& v, rule_operand<T, tight> a,
                                       rule_operand<T, tight> b) {
        return add(v, a, b);
    }
    /// |v − ab| <= |v|ε/(1 − ε) + |â|σb + σa|b̂| + σaσb. Source: Theorem 1, Multiply.
    /// Proof: proofs/IeeeRules.v, tight_multiply_known; in any direction, proofs/Tight.v,
    /// tight_multiply_sound.
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
    /// Where |b̂| > σb: |v − a/b| <= |v|ε/(1 − ε) + (σa + |â/b̂|σb)/(|b̂| − σb), which is the printed
    /// rule with its numerator multiplied out: σa(|b̂| − σb) + (|â| + σa)σb = σa|b̂| + |â|σb.
    /// Elsewhere the result is unknown. Source: Theorem 1, Divide. Proof: proofs/IeeeRules.v,
    /// tight_divide_known; in any direction, proofs/Tight.v, tight_divide_sound.
    template <class T>
    static constexpr bound<T> divide(const T& v, rule_operand<T, tight> a,
                                     rule_operand<T, tight> b) {
        using traits = number_traits<T>;
        const T distance = traits::abs(b.value) - b.bound.error;  // of b from zero
        if (!(distance > 0)) return {traits::infinity()};
        if constexpr (!has_subnormals<T>)
            if (!(distance > traits::underflow_unit())) return {traits::infinity()};
        if (is_zero(a)) return {rounding(v)};
        // |â/b̂| itself may have been rounded down; inflated() is applied to it alone too. Where b
        // is not exact, 4η covers underflow in the numerator before the division enlarges it.
        const T quotient = inflated<T>(traits::abs(v) + traits::underflow_unit());
        const T lost = b.bound.error > 0 ? 4 * traits::underflow_unit() : T(0);
        const T inherited =
            (a.bound.error + detail::rounded_product(quotient, b.bound.error) + lost) / distance;
        return {inflated<T>(rounding(v) + inflated<T>(inherited) + 4 * traits::underflow_unit())};
    }
    /// Scaling by a power of two is exact unless it underflows: then value and bound are each off
    /// by less than η. Proof: proofs/IeeeRules.v, tight_scale_known; in any direction,
    /// proofs/Tight.v, tight_scale_sound.
    template <class T>
    static constexpr bound<T> scale(const T& v, rule_operand<T, tight> a, int e) {
        using traits = number_traits<T>;
        const T scaled = traits::scale(a.bound.error, e);
        const bool lossless = e >= 0 || (traits::scale(v, -e) == a.value &&
                                         traits::scale(scaled, -e) == a.bound.error);
        return {lossless ? scaled + (v - v) : inflated<T>(scaled + 2 * traits::underflow_unit())};
    }

    /// Σ aᵢbᵢ, a running error bound: with products pᵢ and partial sums sᵢ as computed, the sum is
    /// off by at most Σ (|pᵢ| + |sᵢ|)·ε/(1 − ε), where s₁ = p₁ is left out, and η for each product;
    /// the arguments' errors add Σ |â|σb + σa(|b̂| + σb). That is what operations one by one come
    /// to, but that one factor pays for the roundings of the bounds of m terms, and not one a term
    /// and operation.
    ///
    /// Of rounding(p) and rounding(s), which are at least the last places of p, if it is normal,
    /// and of s, if it is not exact, (1 − ε)^m is left in their sum; of an argument's share
    /// (1 − ε)^(m + 2), m − 1 of which are the sum's. Three sums and the factor's own rounding
    /// follow: with j = m + 6, (1 − ε)^j is left, and the factor 1 + (j + 1)ε >= 1/(1 − jε) >=
    /// (1 − ε)^−j pays for it where j²ε <= 1/2. Underflow takes less than η each of m products of
    /// the value, of two in an uncertain argument's share, and of the last product.
    /// Source: Higham 2002, Section 3.3 (running error analysis). Proof: proofs/IeeeDotProduct.v,
    /// tight_dot_known; in any direction, proofs/DotProduct.v, tight_dot_sound.
    template <class T>
    class dot_bound : detail::running_bound<T, dot_bound<T>,
                                            has_subnormals<T> ? number_traits<T>::digits - 2 : 0> {
        static constexpr bool serves = dot_bound::pays;

      public:
        constexpr void add_product(const T& product, const T&, const T& sum,
                                   rule_operand<T, tight> a,
                                   rule_operand<T, tight> b) requires serves {
            if (is_zero(a) || is_zero(b)) return;  // 0 is added, or NaN, which the sum then is
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
    /// ε/(1 − ε) to within ε³; the factor 1 + 8ε covers the rest.
    template <class T>
    static constexpr T rounding(const T& v) {
        using traits = number_traits<T>;
        return detail::rounded_product(traits::abs(v),
                                       T(traits::epsilon() * (1 + traits::epsilon())));
    }
    template <class T>
    static constexpr T inflated(const T& bound) {
        return detail::rounded_product(bound, T(1 + 8 * number_traits<T>::epsilon()));
    }
    template <class T>
    static constexpr bool is_zero(rule_operand<T, tight> a) {
        return a.value == 0 && a.bound.error == 0;
    }
};

}  // namespace errbound
