// Bound rule `residual`: the rounding error itself, to first order. Each operation's exact error
// (error_free.hpp) is carried along beside the value and propagated in plain floating point; only
// what that leaves out is bounded, and it is of second order. Rounding must be to nearest.
//
// Notation: v the computed value, c the correction, ρ the remainder, |v + c − true value| <= ρ;
// u = 2^-p, η the smallest positive number, δ an operation's exact error. Before ρ stands what the
// rule's own arithmetic needs:
//  * every rounding of a correction is counted in ρ, as u times its result, or exactly where
//    two_sum gives it; an underflow of a product on the way as η/2;
//  * roundings of ρ: up to eight, paid for by the factor 1 + 8ε >= (1 + u)^9 (u <= 1/8);
//  * where δ is not known exactly (near underflow; overflow inside Dekker's product), δ = 0 is
//    taken and u|v| + η/2, which bounds it, goes into ρ;
//  * exact numbers have c = ρ = 0; sums of numbers with ρ = 0 keep ρ = 0 as long as c holds their
//    error exactly, and v + c = 0, ρ = 0 is a certain zero;
//  * a value that is not finite has a correction or remainder that is not finite either, which no
//    sign passes.
// Source: error-free transformations as in Ogita, Rump, Oishi 2005 (Accurate sum and dot product),
// propagated as in Langlois 2001 (Automatic linear correction of rounding errors).
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

    /// Proof: proofs/IeeeResidual.v, residual_exact_known.
    template <class T>
    static constexpr bound<T> exact(const T& value) {
        return {T(0), value - value};  // NaN if the value is not finite
    }
    /// Proof: proofs/IeeeResidual.v, residual_within_known.
    template <class T>
    static constexpr bound<T> within(const T& value, const T& error) {
        return {T(0), error >= 0 ? error + (value - value) : number_traits<T>::infinity()};
    }
    /// The bound of a number of this value that is known to be 0.
    /// Proof: proofs/IeeeResidual.v, residual_displacement_known.
    template <class T>
    static constexpr bound<T> displacement(const T& value) {
        return {-value, value - value};
    }
    /// |c| + ρ. Proof: proofs/IeeeResidual.v, residual_error_known.
    template <class T>
    static constexpr T error(const T&, const bound<T>& b) {
        using traits = number_traits<T>;
        if (b.remainder == 0) return traits::abs(b.correction);
        return inflated<T>(traits::abs(b.correction) + b.remainder);
    }
    /// c.
    template <class T>
    static constexpr T correction(const T&, const bound<T>& b) {
        return b.correction;
    }
    /// v + c is known to ρ, a bound of second order: that tells far more than error(). With
    /// s = v ⊕ c, |v + c| >= |s|(1 − u), and (1 + 8ε)(1 − u)/(1 + u) > 1; where s is subnormal, it
    /// is exact. Proof: proofs/IeeeResidual.v, residual_sign_known.
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
    /// Proof: proofs/IeeeResidual.v, residual_negate_known.
    template <class T>
    static constexpr bound<T> negate(const bound<T>& b) {
        return {-b.correction, b.remainder};
    }

    /// a + b = v + δ + (ca + cb) ± (ρa + ρb); the two sums that make c are error-free too.
    /// Proof: proofs/IeeeResidual.v, residual_add_known.
    template <class T>
    static constexpr bound<T> add(const T& v, rule_operand<T, residual> a,
                                  rule_operand<T, residual> b) {
        return sum<T>(v, a.value, a.bound, b.value, b.bound);
    }
    /// Proof: proofs/IeeeResidual.v, residual_subtract_known.
    template <class T>
    static constexpr bound<T> subtract(const T& v, rule_operand<T, residual> a,
                                       rule_operand<T, residual> b) {
        return sum<T>(v, a.value, a.bound, T(-b.value), negate<T>(b.bound));
    }
    /// ab = v + δ + (va·cb + ca·vb) + ca·cb, and with the remainders
    /// (|va| + |ca|)ρb + (|vb| + |cb| + ρb)ρa.
    /// Proof: proofs/IeeeResidual.v, residual_multiply_known.
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
    /// With q = v and the remainder of division r: a/b − q = N/b, N = r + ca − q·cb ± (ρa + |q|ρb),
    /// and N/b − N/vb = N/vb·(vb − b)/b. So c = N/vb, and what is left is at most
    /// (|N/vb|(|cb| + ρb) + ρa + |q|ρb + roundings)/(|vb| − |cb| − ρb). Where r is not known, it is
    /// left out of c: what N/vb then lacks, r/vb, is the error of q. Unknown where b may be zero.
    /// Proof: proofs/IeeeResidual.v, residual_divide_known.
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
        // that of the distance among them, the outer one for four.
        const T lost = unknown + traits::underflow_unit();
        const T c = traits::abs(correction) + lost, q = traits::abs(v);
        const T left = (detail::rounded_product(c, off) +
                        (detail::rounded_product(q, b.bound.remainder) + a.bound.remainder)) +
                       roundings<T>(x, T(0), inherited, numerator);
        return {correction,
                inflated<T>(inflated<T>(left) / distance + detail::half_ulp<T>(correction) + lost)};
    }
    /// Scaling by a power of two is exact unless it underflows: then value, correction and
    /// remainder are each off by at most η/2. Proof: proofs/IeeeResidual.v, residual_scale_known.
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

    /// What the roundings of two products x and y and of two sums take at most, with 4η for these
    /// products' underflows and those of four others.
    template <class T>
    static constexpr T roundings(const T& x, const T& y, const T& first, const T& second) {
        using traits = number_traits<T>;
        const T sizes =
            (traits::abs(x) + traits::abs(y)) + (traits::abs(first) + traits::abs(second));
        return detail::rounded_product(sizes, traits::unit_roundoff()) +
               4 * traits::underflow_unit();
    }
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
