// Bound rule `interval`: interval arithmetic, rounded outwards without touching the rounding mode,
// which must be to nearest. The exact and the computed value lie in [lower, upper]. Ends are
// finite, except for [−∞, ∞] (NaN in a format without infinities), which stands for any overflow or
// NaN. Notation: docs/notation.md. The ends of sums, and of products and quotients of points (lower
// = upper), are rounded correctly, by the sign of the exact error; exact results stay points. Near
// underflow, ends may lie further out. Other products and quotients take one step outwards.
#pragma once

#include <errbound/error_free.hpp>
#include <errbound/rules/rule.hpp>
#include <errbound/sign.hpp>

namespace errbound {

struct interval {
    static constexpr const char* name = "interval";
    static constexpr int minimal_precision = 3;

    template <class T>
    struct bound {
        T lower, upper;
    };

    /// Proof: proofs/rules/IeeeInterval.v, interval_exact_known.
    template <class T>
    static constexpr bound<T> exact(const T& value) {
        return checked<T>(value, value, value);
    }
    /// Proof: proofs/rules/IeeeInterval.v, interval_within_known.
    template <class T>
    static constexpr bound<T> within(const T& value, const T& error) {
        if (error == 0) return exact(value);
        if (!(error > 0)) return unknown<T>();
        return checked<T>(value, below<T>(value - error), above<T>(value + error));
    }
    /// Proof: proofs/rules/IeeeInterval.v, interval_error_known.
    template <class T>
    static constexpr T error(const T& value, const bound<T>& b) {
        using traits = number_traits<T>;
        const T off = (traits::max)(b.upper - value, value - b.lower);
        if (off == 0) return off;
        const T enough = above<T>(off);
        // Ends of one sign are at most the largest number apart.
        return certain(sign<T>(value, b)) && !(enough < traits::largest()) ? traits::largest()
                                                                           : enough;
    }
    /// Proof: proofs/rules/IeeeInterval.v, interval_sign_known.
    template <class T>
    static constexpr sign_type sign(const T&, const bound<T>& b) {
        if (b.lower > 0) return sign_type::positive;
        if (b.upper < 0) return sign_type::negative;
        return b.lower == 0 && b.upper == 0 ? sign_type::zero : sign_type::uncertain;
    }
    /// Proof: proofs/rules/IeeeInterval.v, interval_negate_known.
    template <class T>
    static constexpr bound<T> negate(const bound<T>& b) {
        return {-b.upper, -b.lower};
    }

    /// Proof: proofs/rules/IeeeInterval.v, interval_add_known.
    template <class T>
    static constexpr bound<T> add(const T& v, rule_operand<T, interval> a,
                                  rule_operand<T, interval> b) {
        return sum<T>(v, a.bound, b.bound);
    }
    /// Proof: proofs/rules/IeeeInterval.v, interval_subtract_known.
    template <class T>
    static constexpr bound<T> subtract(const T& v, rule_operand<T, interval> a,
                                       rule_operand<T, interval> b) {
        return sum<T>(v, a.bound, negate<T>(b.bound));
    }
    /// Both ends are among the four products of ends. If an operand is [−∞, ∞], so is the result,
    /// even if a product 0·∞ is NaN. Proof: proofs/rules/IeeeInterval.v, interval_multiply_known.
    template <class T>
    static constexpr bound<T> multiply(const T& v, rule_operand<T, interval> a,
                                       rule_operand<T, interval> b) {
        if (is_zero(a.bound) || is_zero(b.bound)) return checked<T>(v, v, v);
        if (is_point(a.bound) && is_point(b.bound)) {
            const with_error<T> p = two_product<T>(a.value, b.value);
            if (product_error_is_exact<T>(a.value, b.value, p)) return nearest<T>(v, p.error);
            return checked<T>(v, below<T>(v), above<T>(v));
        }
        return hull<T>(v, detail::rounded_product(a.bound.lower, b.bound.lower),
                       detail::rounded_product(a.bound.lower, b.bound.upper),
                       detail::rounded_product(a.bound.upper, b.bound.lower),
                       detail::rounded_product(a.bound.upper, b.bound.upper));
    }
    /// Infinite if b may be zero. Proof: proofs/rules/IeeeInterval.v, interval_divide_known.
    template <class T>
    static constexpr bound<T> divide(const T& v, rule_operand<T, interval> a,
                                     rule_operand<T, interval> b) {
        if (!(b.bound.lower > 0) && !(b.bound.upper < 0)) return unknown<T>();
        if (is_point(a.bound) && is_point(b.bound)) {
            const division_remainder<T> r = remainder_of_division<T>(a.value, b.value, v);
            if (r.exact) return nearest<T>(v, b.value < 0 ? T(-r.value) : r.value);
            return checked<T>(v, below<T>(v), above<T>(v));
        }
        return hull<T>(v, a.bound.lower / b.bound.lower, a.bound.lower / b.bound.upper,
                       a.bound.upper / b.bound.lower, a.bound.upper / b.bound.upper);
    }
    /// The roots of both ends. A root takes a step outwards unless its exact remainder shows that
    /// it is exact or rounded outwards. Proof: proofs/rules/IeeeSlopes.v,
    /// interval_square_root_known.
    template <class T>
    static constexpr bound<T> square_root(const T& v, rule_operand<T, interval> a) {
        using traits = number_traits<T>;
        if (!(a.bound.lower >= 0)) return unknown<T>();
        const T lower = traits::sqrt(a.bound.lower), upper = traits::sqrt(a.bound.upper);
        const division_remainder<T> of_lower = remainder_of_root<T>(a.bound.lower, lower);
        const division_remainder<T> of_upper = remainder_of_root<T>(a.bound.upper, upper);
        return checked<T>(v, of_lower.exact && of_lower.value >= 0 ? lower : below<T>(lower),
                          of_upper.exact && of_upper.value <= 0 ? upper : above<T>(upper));
    }
    /// The least and the greatest fma of ends, one step outwards: four products of ends, plus the
    /// lower or the upper end of c. Proof: proofs/rules/IeeeSlopes.v, interval_fused_known.
    template <class T>
    static constexpr bound<T> fused(const T& v, rule_operand<T, interval> a,
                                    rule_operand<T, interval> b, rule_operand<T, interval> c) {
        using traits = number_traits<T>;
        if (!traits::is_finite(a.bound.lower) || !traits::is_finite(b.bound.lower) ||
            !traits::is_finite(c.bound.lower))
            return unknown<T>();
        const auto least = [](const T& m, const T& n) { return n < m ? n : m; };
        const auto most = [](const T& m, const T& n) { return n > m ? n : m; };
        bool overflows = false;  // a product may overflow to NaN, which comparisons would skip
        const auto corner = [&](const T& x, const T& y, const T& z) {
            const T value = traits::fma(x, y, z);
            if constexpr (!has_infinity<T>) overflows |= !traits::is_finite(value);
            return value;
        };
        const auto end = [&](const auto& choice, const T& of_c) {
            return choice(choice(corner(a.bound.lower, b.bound.lower, of_c),
                                 corner(a.bound.lower, b.bound.upper, of_c)),
                          choice(corner(a.bound.upper, b.bound.lower, of_c),
                                 corner(a.bound.upper, b.bound.upper, of_c)));
        };
        const T lower = below<T>(end(least, c.bound.lower));
        const T upper = above<T>(end(most, c.bound.upper));
        return overflows ? unknown<T>() : checked<T>(v, lower, upper);
    }
    /// Exact unless it underflows. Proof: proofs/rules/IeeeInterval.v, interval_scale_known.
    template <class T>
    static constexpr bound<T> scale(const T& v, rule_operand<T, interval> a, int e) {
        using traits = number_traits<T>;
        const T lower = traits::scale(a.bound.lower, e), upper = traits::scale(a.bound.upper, e);
        const bool lossless = e >= 0 || (traits::scale(lower, -e) == a.bound.lower &&
                                         traits::scale(upper, -e) == a.bound.upper);
        return lossless ? checked<T>(v, lower, upper)
                        : checked<T>(v, below<T>(lower), above<T>(upper));
    }

  private:
    template <class T>
    static constexpr bound<T> unknown() {
        return {-number_traits<T>::infinity(), number_traits<T>::infinity()};
    }
    template <class T>
    static constexpr bound<T> checked(const T& value, const T& lower, const T& upper) {
        const T infinity = number_traits<T>::infinity();
        const bool finite = !has_infinity<T> || (-infinity < lower && upper < infinity);
        if (finite && lower <= value && value <= upper) return {lower, upper};
        return unknown<T>();
    }
    template <class T>
    static constexpr bool is_point(const bound<T>& b) {
        return b.lower == b.upper;
    }
    template <class T>
    static constexpr bool is_zero(const bound<T>& b) {
        return b.lower == 0 && b.upper == 0;
    }

    /// A step e > ulp(c)/2, so c ⊖ e is at most the number before c, and c ⊕ e at least the number
    /// after c. The rounded u|c| is at least x = ulp(c)/2 if x is representable. If x >= 4η, 1.25x
    /// is exact; for smaller x its rounding loses less than the added η. Source: Rump, Zimmermann,
    /// Boldo, Melquiond 2009 (BIT 49). 1.25 replaces their 1 + 2u, for p = 3 and for formats with η
    /// near u.
    template <class T>
    static constexpr T step(const T& c) {
        using traits = number_traits<T>;
        return detail::rounded_product(T(traits::abs(c) * traits::unit_roundoff()), T(1.25)) +
               traits::underflow_unit();
    }
    template <class T>
    static constexpr T below(const T& c) {
        return c - step(c);
    }
    template <class T>
    static constexpr T above(const T& c) {
        return c + step(c);
    }

    /// [v, v] if error = 0; otherwise v and a step from it towards the exact v + error.
    template <class T>
    static constexpr bound<T> nearest(const T& v, const T& error) {
        return checked<T>(v, error < 0 ? below<T>(v) : v, error > 0 ? above<T>(v) : v);
    }
    template <class T>
    static constexpr bound<T> sum(const T& v, const bound<T>& a, const bound<T>& b) {
        // A NaN error (overflow) also steps outwards.
        const auto [lower, below_error] = two_sum<T>(a.lower, b.lower);
        const auto [upper, above_error] = two_sum<T>(a.upper, b.upper);
        return checked<T>(v, below_error >= 0 ? lower : below<T>(lower),
                          above_error <= 0 ? upper : above<T>(upper));
    }
    template <class T>
    static constexpr bound<T> hull(const T& v, const T& w, const T& x, const T& y, const T& z) {
        const auto least = [](const T& m, const T& n) { return n < m ? n : m; };
        const auto most = [](const T& m, const T& n) { return n > m ? n : m; };
        if constexpr (!has_infinity<T>)  // an overflow gives NaN
            if (w != w || x != x || y != y || z != z) return unknown<T>();
        return checked<T>(v, below<T>(least(least(w, x), least(y, z))),
                          above<T>(most(most(w, x), most(y, z))));
    }
};

}  // namespace errbound
