// Bound rule `residual`: carries each rounding error itself, to first order, by error_free.hpp.
// Only the second-order remainder is bounded. Rounding must be to nearest.
//
// Notation: docs/notation.md; v is the computed value, c the correction and ρ its bound, the member
// `remainder`: |v + c − exact value| <= ρ. va, ca, ρa are those of a. δ is an operation's rounding
// error. Exact numbers have c = ρ = 0. Sums keep ρ = 0 while c holds their error exactly. If v + c
// = 0 and ρ = 0, the sign is certainly zero. If v is not finite, at least one of c and ρ is not, so
// no sign is certain. Sources: Ogita, Rump, Oishi 2005 (Accurate sum and dot product); Langlois
// 2001 (Automatic linear correction of rounding errors).
#pragma once

#include <errbound/detail/sum_of_bounds.hpp>
#include <errbound/error_free.hpp>
#include <errbound/rules/rule.hpp>
#include <errbound/sign.hpp>

namespace errbound {

struct residual {
    static constexpr const char* name = "residual";
    static constexpr int minimal_precision = 3;
    static constexpr bool keeps_first_order = true;

    template <class T>
    struct bound {
        T correction, remainder;
    };

    /// Proof: proofs/rules/IeeeResidual.v, residual_exact_known.
    template <class T>
    static constexpr bound<T> exact(const T& value) {
        return {T(0), value - value};  // NaN if the value is not finite
    }
    /// Proof: proofs/rules/IeeeResidual.v, residual_within_known.
    template <class T>
    static constexpr bound<T> within(const T& value, const T& error) {
        return {T(0), error >= 0 ? error + (value - value) : number_traits<T>::infinity()};
    }
    /// The exact value is 0. Proof: proofs/rules/IeeeResidual.v, residual_displacement_known.
    template <class T>
    static constexpr bound<T> displacement(const T& value) {
        return {-value, value - value};
    }
    /// |c| + ρ. Proof: proofs/rules/IeeeResidual.v, residual_error_known.
    template <class T>
    static constexpr T error(const T&, const bound<T>& b) {
        using traits = number_traits<T>;
        if (b.remainder == 0) return traits::abs(b.correction);
        return inflated<T>(traits::abs(b.correction) + b.remainder);
    }
    template <class T>
    static constexpr T correction(const T&, const bound<T>& b) {
        return b.correction;
    }
    /// The exact value is within ρ of v + c. For s = v ⊕ c, |v + c| >= |s|(1 − u), and (1 + 8ε)(1 −
    /// u)/(1 + u) > 1; a subnormal s is exact. Proof: proofs/rules/IeeeResidual.v,
    /// residual_sign_known.
    template <class T>
    static constexpr sign_type sign(const T& value, const bound<T>& b) {
        using traits = number_traits<T>;
        const T corrected = value + b.correction;
        if (corrected == 0 && b.remainder == 0) return sign_type::zero;
        if (!(traits::abs(corrected) > inflated<T>(b.remainder)) ||
            !traits::is_finite(error<T>(value, b)))
            return sign_type::uncertain;
        return corrected > 0 ? sign_type::positive : sign_type::negative;
    }
    /// Proof: proofs/rules/IeeeResidual.v, residual_negate_known.
    template <class T>
    static constexpr bound<T> negate(const bound<T>& b) {
        return {-b.correction, b.remainder};
    }

    /// a + b = v + δ + (ca + cb) ± (ρa + ρb). Proof: proofs/rules/IeeeResidual.v,
    /// residual_add_known.
    template <class T>
    static constexpr bound<T> add(const T& v, rule_operand<T, residual> a,
                                  rule_operand<T, residual> b) {
        return sum<T>(v, a.value, a.bound, b.value, b.bound);
    }
    /// Proof: proofs/rules/IeeeResidual.v, residual_subtract_known.
    template <class T>
    static constexpr bound<T> subtract(const T& v, rule_operand<T, residual> a,
                                       rule_operand<T, residual> b) {
        return sum<T>(v, a.value, a.bound, T(-b.value), negate<T>(b.bound));
    }
    /// ab = v + δ + (va·cb + ca·vb) + ca·cb; ρa and ρb add (|va| + |ca|)ρb + (|vb| + |cb| +
    /// ρb)ρa. If δ is not known exactly, it counts as 0, and ρ includes u|v| + η. Proof:
    /// proofs/rules/IeeeResidual.v, residual_multiply_known.
    template <class T>
    static constexpr bound<T> multiply(const T& v, rule_operand<T, residual> a,
                                       rule_operand<T, residual> b) {
        using traits = number_traits<T>;
        if (is_zero(a) || is_zero(b)) return exact<T>(v);
        const with_error<T> product = two_product<T>(a.value, b.value);
        const bool known = product_error_is_exact<T>(a.value, b.value, product);
        const T own = known ? product.error : T(0);
        const T unknown = known ? T(0) : detail::half_ulp<T>(v);
        if (is_exact(a) && is_exact(b)) return {own, unknown};

        const T ca = traits::abs(a.bound.correction), cb = traits::abs(b.bound.correction);
        const T x = detail::rounded_product(a.value, b.bound.correction);
        const T y = detail::rounded_product(a.bound.correction, b.value);
        const T inherited = x + y;
        const T correction = own + inherited;
        const T remainder =
            detail::rounded_product(T(traits::abs(a.value) + ca), b.bound.remainder) +
            (detail::rounded_product(T(traits::abs(b.value) + cb + b.bound.remainder),
                                     a.bound.remainder) +
             detail::rounded_product(ca, cb));
        return {correction,
                inflated<T>(remainder + roundings<T>(x, y, inherited, correction) + unknown)};
    }
    /// Let q = v, r = va − q·vb and N = r + ca − q·cb. Then a/b − q = (N + d)/b with |d| <= ρa +
    /// |q|ρb, and N/b − N/vb = N/vb·(vb − b)/b. So c = N/vb, and ρ is at most (|N/vb|(|cb| + ρb) +
    /// ρa + |q|ρb + roundings)/(|vb| − |cb| − ρb). If r is not known exactly, c omits it, and ρ
    /// includes u|v| + η instead: r/vb is the rounding error of q. Infinite if b may be zero.
    /// Proof: proofs/rules/IeeeResidual.v, residual_divide_known.
    template <class T>
    static constexpr bound<T> divide(const T& v, rule_operand<T, residual> a,
                                     rule_operand<T, residual> b) {
        using traits = number_traits<T>;
        const T off = error<T>(b.value, b.bound);
        const T distance = traits::abs(b.value) - off;  // of b from zero
        if (!(distance > 0)) return {T(0), traits::infinity()};
        if (is_zero(a)) return exact<T>(v);
        const division_remainder<T> division = remainder_of_division<T>(a.value, b.value, v);
        const bool known = division.exact;
        const T own = known ? division.value : T(0);
        const T unknown = known ? T(0) : detail::half_ulp<T>(v);
        if (own == 0 && is_exact(a) && is_exact(b)) return {T(0), unknown + (v - v)};

        const T x = detail::rounded_product(v, b.bound.correction);
        const T inherited = a.bound.correction - x;
        const T numerator = own + inherited;
        const T correction = numerator / b.value;
        // |N/vb| <= |c|(1 + u) + η/2 + unknown. The inner factor 1 + 8ε covers seven roundings,
        // including that of the distance, the outer one four.
        const T lost = unknown + traits::underflow_unit();
        const T c = traits::abs(correction) + lost, q = traits::abs(v);
        const T left = (detail::rounded_product(c, off) +
                        (detail::rounded_product(q, b.bound.remainder) + a.bound.remainder)) +
                       roundings<T>(x, T(0), inherited, numerator);
        return {correction,
                inflated<T>(inflated<T>(left) / distance + detail::half_ulp<T>(correction) + lost)};
    }
    /// Exact unless it underflows; then value, correction and remainder are each off by at most
    /// η/2. Proof: proofs/rules/IeeeResidual.v, residual_scale_known.
    template <class T>
    static constexpr bound<T> scale(const T& v, rule_operand<T, residual> a, int e) {
        using traits = number_traits<T>;
        const T correction = traits::scale(a.bound.correction, e);
        const T remainder = traits::scale(a.bound.remainder, e);
        const bool lossless = e >= 0 || (traits::scale(v, -e) == a.value &&
                                         traits::scale(correction, -e) == a.bound.correction &&
                                         traits::scale(remainder, -e) == a.bound.remainder);
        return {correction, lossless ? remainder + (v - v)
                                     : inflated<T>(remainder + 2 * traits::underflow_unit())};
    }

  private:
    template <class T>
    static constexpr bound<T> sum(const T& v, const T& a, const bound<T>& a_bound, const T& b,
                                  const bound<T>& b_bound) {
        using traits = number_traits<T>;
        const T own = two_sum<T>(a, b).error;
        const with_error<T> inherited = two_sum<T>(a_bound.correction, b_bound.correction);
        const with_error<T> correction = two_sum<T>(own, inherited.value);
        const T lost = traits::abs(inherited.error) + traits::abs(correction.error);
        const T remainder =
            detail::sum_of_bounds<T>(inflated<T>((a_bound.remainder + b_bound.remainder) + lost),
                                     inflated<T>(lost), a_bound.remainder, b_bound.remainder);
        return {correction.value, remainder + (v - v)};
    }

    /// Bounds the roundings of products x and y and of two sums: u times each result, and 4η for
    /// the underflows of these and four other products.
    template <class T>
    static constexpr T roundings(const T& x, const T& y, const T& first, const T& second) {
        using traits = number_traits<T>;
        const T sizes =
            (traits::abs(x) + traits::abs(y)) + (traits::abs(first) + traits::abs(second));
        return detail::rounded_product(sizes, traits::unit_roundoff()) +
               4 * traits::underflow_unit();
    }
    // Covers up to eight roundings of ρ: 1 + 8ε >= (1 + u)^9 (u <= 1/8).
    template <class T>
    static constexpr T inflated(const T& bound) {
        return detail::rounded_product(bound, T(1 + 8 * number_traits<T>::epsilon()));
    }
    template <class T>
    static constexpr bool is_exact(rule_operand<T, residual> a) {
        return a.bound.correction == 0 && a.bound.remainder == 0;
    }
    template <class T>
    static constexpr bool is_zero(rule_operand<T, residual> a) {
        return a.value == 0 && is_exact(a);
    }
};

}  // namespace errbound
