// Bound rule `safe`: SafeBound (Wang 2014; Section 4.2 of the TightCCD paper), its gaps closed. The
// bound is (B, k): |f| <= B and |f̂ − f| <= B[(1 + ε)^k − 1]. Additions to the printed rule: B is
// inflated for its own rounding, underflow is covered, and a product with an exact zero is an exact
// zero. Overflow makes B infinite and the value infinite or NaN, so no sign is certain. The rule
// has no division, since (B, k) gives no lower bound of |f|.
#pragma once

#include <errbound/detail/rounded.hpp>
#include <errbound/rules/rule.hpp>

namespace errbound {

struct safe {
    static constexpr const char* name = "safe";
    static constexpr bool holds_in_directed_rounding = true;  ///< except for overflow
    static constexpr bool has_division = false;               ///< `divide` only names the reason

    template <class T>
    struct bound {
        T magnitude;     ///< B
        int operations;  ///< k; 0 for an exact number
    };

    /// Proof: proofs/rules/IeeeSafe.v, safe_exact_known.
    template <class T>
    static constexpr bound<T> exact(const T& value) {
        return {number_traits<T>::abs(value), 0};
    }
    /// B = max(|value| + error, error/ε), k = 1. Proof: proofs/rules/IeeeSafe.v, safe_within_known.
    template <class T>
    static constexpr bound<T> within(const T& value, const T& error) {
        using traits = number_traits<T>;
        if (error == 0) return exact(value);
        if (!(error > 0)) return {traits::infinity(), 1};
        // If error/ε overflows, some rounding directions give the largest number: too small.
        const bool overflows = error > traits::largest() * traits::epsilon();
        const T least = overflows ? traits::infinity() : error / traits::epsilon();
        return {enlarged<T>((traits::max)(traits::abs(value) + error, least)), 1};
    }
    /// B[(1 + ε)^k − 1] <= B·kε(1 + kε), since e^x − 1 <= x + x² for x <= 1. Proof:
    /// proofs/rules/IeeeSafe.v, safe_error_known; in any direction, proofs/rules/Safe.v,
    /// safe_error_sound.
    template <class T>
    static constexpr T error(const T& value, const bound<T>& b) {
        using traits = number_traits<T>;
        const T x = T(b.operations) * traits::epsilon();
        if (!(x <= 1) || b.operations == too_many || !traits::is_finite(value))
            return traits::infinity();
        if (b.operations == 0) return T(0);
        return enlarged<T>(detail::rounded_product(b.magnitude, enlarged<T>(x * (1 + x))) +
                           traits::underflow_unit());
    }

    /// B = Ba + Bb, k = max(ka, kb) + 1. Proof: proofs/rules/IeeeSafe.v, safe_add_known; in any
    /// direction, proofs/rules/Safe.v, safe_add_sound.
    template <class T>
    static constexpr bound<T> add(const T&, rule_operand<T, safe> a, rule_operand<T, safe> b) {
        const int k =
            a.bound.operations < b.bound.operations ? b.bound.operations : a.bound.operations;
        return {enlarged<T>(a.bound.magnitude + b.bound.magnitude), counted(k)};
    }
    /// Proof: proofs/rules/IeeeSafe.v, safe_subtract_known; in any direction, proofs/rules/Safe.v,
    /// safe_subtract_sound.
    template <class T>
    static constexpr bound<T> subtract(const T& v, rule_operand<T, safe> a,
                                       rule_operand<T, safe> b) {
        return add(v, a, b);
    }
    /// B = Ba·Bb, at least the smallest normal number m, k = ka + kb + 1. The 1 in k covers a
    /// rounding error: ε relatively, or η = mε <= Bε on underflow. Proof: proofs/rules/IeeeSafe.v,
    /// safe_multiply_known; in any direction, proofs/rules/Safe.v, safe_multiply_sound.
    template <class T>
    static constexpr bound<T> multiply(const T&, rule_operand<T, safe> a, rule_operand<T, safe> b) {
        using traits = number_traits<T>;
        if (is_zero(a) || is_zero(b)) return {T(0), 0};
        return {(traits::max)(enlarged<T>(a.bound.magnitude * b.bound.magnitude),
                              traits::smallest_normal()),
                counted(a.bound.operations + b.bound.operations)};
    }
    template <class T>
    static constexpr bound<T> divide(const T&, rule_operand<T, safe>, rule_operand<T, safe>) {
        static_assert(sizeof(T) == 0,
                      "errbound: SafeBound has no rule for division (it bounds numbers from above "
                      "only); use the rule `tight`, or rewrite the expression without division");
        return {};
    }
    /// (B·2^e, k) is exact unless it underflows; then B is at least m and k grows by one. Proof:
    /// proofs/rules/IeeeSafe.v, safe_scale_known; in any direction, proofs/rules/Safe.v,
    /// safe_scale_sound.
    template <class T>
    static constexpr bound<T> scale(const T& v, rule_operand<T, safe> a, int e) {
        using traits = number_traits<T>;
        const T scaled = traits::scale(a.bound.magnitude, e);
        if (e >= 0 ||
            (traits::scale(v, -e) == a.value && traits::scale(scaled, -e) == a.bound.magnitude))
            return {scaled, a.bound.operations};
        return {(traits::max)(enlarged<T>(scaled), traits::smallest_normal()),
                counted(a.bound.operations)};
    }

  private:
    static constexpr int too_many = 1 << 29;  ///< the error is infinite; 2·too_many fits an int
    static constexpr int counted(int k) { return k < too_many - 1 ? k + 1 : too_many; }

    template <class T>
    static constexpr T enlarged(const T& x) {
        return detail::rounded_product(x, T(1 + 4 * number_traits<T>::epsilon()));
    }
    template <class T>
    static constexpr bool is_zero(rule_operand<T, safe> a) {
        return a.value == 0 && a.bound.operations == 0;
    }
};

}  // namespace errbound
