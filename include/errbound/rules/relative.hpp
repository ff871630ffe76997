// Bound rule `relative`: counts factors 1 + δ, as error analyses on paper do. It suits products,
// quotients and sums of numbers of one sign. Rounding must be to nearest.
//
// Notation: docs/notation.md; v is the computed value, x the exact one. The bound is a count k: v =
// x·Π(1 + δᵢ)^±1 with k factors, |δᵢ| <= u (Higham 2002, Lemma 3.1; Stewart's counter). So v and x
// have the same sign, and |ln(v/x)| <= kw with w = −ln(1 − u); k need not be whole. Exact numbers
// have k = 0. The error is about k·u|v|. It is infinite after an overflow, and for subnormal
// results that may be rounded. It is infinite if kw >= 7/4, and if cancellation leaves a result no
// larger than its error, such as x − x of an inexact x.
#pragma once

#include <errbound/error_free.hpp>
#include <errbound/rules/rule.hpp>
#include <errbound/sign.hpp>
#include <limits>

namespace errbound {

struct relative {
    static constexpr const char* name = "relative";

    template <class T>
    struct bound {
        double factors;  ///< k, a double for every T; infinite if there is no bound
    };

    /// Proof: proofs/rules/IeeeRelative.v, relative_exact_known.
    template <class T>
    static constexpr bound<T> exact(const T& value) {
        return {number_traits<T>::is_finite(value) ? 0 : unknown};
    }
    /// Infinite unless error < |value|. Proof: proofs/rules/IeeeRelative.v, relative_within_known.
    template <class T>
    static constexpr bound<T> within(const T& value, const T& error) {
        using traits = number_traits<T>;
        if (error == 0) return exact(value);
        if (!(error > 0) || !traits::is_finite(value)) return {unknown};
        return {factors_of<T>(error, traits::abs(value))};
    }
    /// |v − x| <= |v|(e^L − 1), L = kw, and e^L − 1 <= L/(1 − L/2) for 0 <= L < 2, since ln((2 +
    /// L)/(2 − L)) = L + L³/12 + ... Proof: proofs/rules/IeeeRelative.v, relative_error_known.
    template <class T>
    static constexpr T error(const T& value, const bound<T>& b) {
        using traits = number_traits<T>;
        if (b.factors == 0) return T(0);
        // A subnormal product is off by more than the factor covers.
        const double l = upper<double>(b.factors * of_one_factor<T>()) +
                         std::numeric_limits<double>::denorm_min();
        if (!(l < 1.75)) return traits::infinity();
        const double r = l / (1 - l / 2) * (1 + 8 * epsilon);
        T share = static_cast<T>(r);
        if (static_cast<double>(share) < r) share = upper<T>(share) + traits::underflow_unit();
        return upper<T>(detail::rounded_product(traits::abs(value), share)) +
               traits::underflow_unit();
    }
    /// The value's sign if the error is finite. Proof: proofs/rules/IeeeRelative.v,
    /// relative_sign_known.
    template <class T>
    static constexpr sign_type sign(const T& value, const bound<T>& b) {
        if (!number_traits<T>::is_finite(error<T>(value, b))) return sign_type::uncertain;
        if (value == 0) return sign_type::zero;
        return value > 0 ? sign_type::positive : sign_type::negative;
    }

    /// Proof: proofs/rules/IeeeRelative.v, relative_add_known.
    template <class T>
    static constexpr bound<T> add(const T& v, rule_operand<T, relative> a,
                                  rule_operand<T, relative> b) {
        return sum<T>(v, a.value, a.bound, b.value, b.bound);
    }
    /// Proof: proofs/rules/IeeeRelative.v, relative_subtract_known.
    template <class T>
    static constexpr bound<T> subtract(const T& v, rule_operand<T, relative> a,
                                       rule_operand<T, relative> b) {
        return sum<T>(v, a.value, a.bound, T(-b.value), b.bound);
    }
    /// k = ka + kb, plus one unless exact. Proof: proofs/rules/IeeeRelative.v,
    /// relative_multiply_known.
    template <class T>
    static constexpr bound<T> multiply(const T& v, rule_operand<T, relative> a,
                                       rule_operand<T, relative> b) {
        if (is_zero(a) || is_zero(b)) return exact<T>(v);
        const with_error<T> product = two_product<T>(a.value, b.value);
        const bool is_exact =
            product_error_is_exact<T>(a.value, b.value, product) && product.error == 0;
        return rounded_to<T>(v, count_sum(a.bound.factors, b.bound.factors), is_exact);
    }
    /// k = ka + kb, plus one unless exact. Infinite if b has value 0 or an infinite count. Proof:
    /// proofs/rules/IeeeRelative.v, relative_divide_known.
    template <class T>
    static constexpr bound<T> divide(const T& v, rule_operand<T, relative> a,
                                     rule_operand<T, relative> b) {
        if (b.value == 0 || !(b.bound.factors < unknown)) return {unknown};
        if (is_zero(a)) return exact<T>(v);
        const division_remainder<T> division = remainder_of_division<T>(a.value, b.value, v);
        return rounded_to<T>(v, count_sum(a.bound.factors, b.bound.factors),
                             division.exact && division.value == 0);
    }
    /// Proof: proofs/rules/IeeeRelative.v, relative_scale_known.
    template <class T>
    static constexpr bound<T> scale(const T& v, rule_operand<T, relative> a, int e) {
        return rounded_to<T>(v, a.bound.factors,
                             e >= 0 || number_traits<T>::scale(v, -e) == a.value);
    }

    /// Σ aᵢbᵢ by absolute errors, or by the counts of single operations if that gives less. The
    /// errors of products (from their counts) and of partial sums (by two_sum) become relative only
    /// at the end. So the bound can stay finite if partial sums cancel. For n terms of one size and
    /// sign k is about n/2, not n. Proof: proofs/rules/IeeeRelative.v, relative_dot_known.
    template <class T>
    class dot_bound {
      public:
        constexpr void add_product(const T& product, const T& before, const T& sum,
                                   rule_operand<T, relative> a, rule_operand<T, relative> b) {
            using traits = number_traits<T>;
            const bound<T> of_product = multiply<T>(product, a, b);
            const T rounded_off = traits::abs(two_sum<T>(before, product).error);
            off_ = upper<T>(T(off_ + upper<T>(T(error<T>(product, of_product) + rounded_off))));
            counted_ = relative::sum<T>(sum, before, counted_, product, of_product);
        }
        constexpr bound<T> finished(const T& sum) const {
            const bound<T> by_size = within<T>(sum, off_);
            return by_size.factors < counted_.factors ? by_size : counted_;
        }

      private:
        T off_ = T(0);
        bound<T> counted_ = {0};
    };

  private:
    static constexpr double unknown = std::numeric_limits<double>::infinity();
    static constexpr double epsilon = std::numeric_limits<double>::epsilon();

    template <class T>
    static constexpr bool is_zero(rule_operand<T, relative> a) {
        return a.value == 0 && a.bound.factors == 0;
    }
    /// At least the successor of x >= 0, or x if subnormal.
    template <class T>
    static constexpr T upper(const T& x) {
        return detail::rounded_product(x, T(1 + number_traits<T>::epsilon()));
    }

    /// At least −ln(1 − u), for one factor. 1 + 8ε, with double's ε, covers twelve roundings.
    template <class T>
    static constexpr double of_one_factor() {
        const double u = static_cast<double>(number_traits<T>::unit_roundoff());
        return u * (1 - u / 2) / (1 - u) * (1 + 8 * epsilon);
    }
    static constexpr double count_sum(double j, double k) {
        const with_error<double> sum = two_sum<double>(j, k);
        return sum.error > 0 ? upper<double>(sum.value) : sum.value;
    }
    /// The number of factors in a relative error r = error/size < 1: at least −ln(1 − r)/w. Uses u
    /// <= w and −ln(1 − r) <= r(6 − 5r)/(2(1 − r)(3 − r)). (With x = 1/(1 − r): ln x <= (x − 1)(x +
    /// 5)/(4x + 2), equal at 1, and the difference has the derivative (x − 1)³/(x(2x + 1)²).)
    template <class T>
    static constexpr double factors_of(const T& error, const T& size) {
        using traits = number_traits<T>;
        if (!(size > 0)) return unknown;  // also for −0, where the share would be −∞
        const T share = upper<T>(T(error / size)) + traits::underflow_unit();
        if (!(share < T(1))) return unknown;
        // r >= share even if T is wider than double.
        const double r =
            upper<double>(static_cast<double>(share)) + std::numeric_limits<double>::denorm_min();
        if (!(r < 1)) return unknown;
        const double u = static_cast<double>(traits::unit_roundoff());
        return r * (6 - detail::rounded_product(5.0, r)) / (2 * (1 - r) * (3 - r) * u) *
               (1 + 8 * epsilon);
    }

    template <class T>
    static constexpr bound<T> rounded_to(const T& v, double k, bool is_exact) {
        using traits = number_traits<T>;
        if (!traits::is_finite(v)) return {unknown};
        if (is_exact) return {k};
        if (traits::abs(v) >= traits::smallest_normal()) return {count_sum(k, 1)};
        return {unknown};
    }
    // Operands of one sign: k = max(ka, kb), since the sum's ratio v/x lies between theirs. Unlike
    // signs: k follows from the relative error (Ea + Eb)/|â + b̂|, with the operands' errors Ea and
    // Eb.
    template <class T>
    static constexpr bound<T> sum(const T& v, const T& a, const bound<T>& of_a, const T& b,
                                  const bound<T>& of_b) {
        using traits = number_traits<T>;
        const bool is_exact = two_sum<T>(a, b).error == 0;
        const double k = of_a.factors < of_b.factors ? of_b.factors : of_a.factors;
        if (k == 0 || (a >= 0 && b >= 0) || (a <= 0 && b <= 0))
            return rounded_sum<T>(v, k, is_exact);
        const T off = upper<T>(T(error<T>(a, of_a) + error<T>(b, of_b)));
        // |â + b̂| is at least the predecessor of |v|, which is at least |v|(1 − ε), rounded.
        const T size = traits::abs(v);
        const T least = is_exact ? size : detail::rounded_product(size, T(1 - traits::epsilon()));
        if (!traits::is_finite(v) || !(off < least)) return {unknown};
        return rounded_sum<T>(v, factors_of<T>(off, least), is_exact);
    }
    /// Sums that underflow are exact.
    template <class T>
    static constexpr bound<T> rounded_sum(const T& v, double k, bool is_exact) {
        if (!number_traits<T>::is_finite(v)) return {unknown};
        return {is_exact ? k : count_sum(k, 1)};
    }
};

}  // namespace errbound
