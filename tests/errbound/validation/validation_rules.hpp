// Rules that are broken on purpose, and checks of reports.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <errbound/rules/derived.hpp>
#include <errbound/validation/validation.hpp>
#include <string>

namespace validation_test {

namespace validation = errbound::validation;
using errbound::number_traits;
using errbound::rule_operand;

/// TightBound as the paper prints it: no term for underflow, none for the bound's own rounding.
struct as_printed : errbound::derived_rule<as_printed, errbound::tight> {
    static constexpr const char* name = "as_printed";
    static constexpr bool has_division = false;
    template <class T>
    static constexpr bound<T> add(const T& v, rule_operand<T, as_printed> a,
                                  rule_operand<T, as_printed> b) {
        return {rounding(v) + a.bound.error + b.bound.error};
    }
    template <class T>
    static constexpr bound<T> subtract(const T& v, rule_operand<T, as_printed> a,
                                       rule_operand<T, as_printed> b) {
        return add(v, a, b);
    }
    template <class T>
    static constexpr bound<T> multiply(const T& v, rule_operand<T, as_printed> a,
                                       rule_operand<T, as_printed> b) {
        using traits = number_traits<T>;
        return {rounding(v) + traits::abs(a.value) * b.bound.error +
                a.bound.error * traits::abs(b.value) + a.bound.error * b.bound.error};
    }
    template <class T>
    static bound<T> scale(const T&, rule_operand<T, as_printed> a, int e) {
        return {number_traits<T>::scale(a.bound.error, e)};
    }

  private:
    template <class T>
    static constexpr T rounding(const T& v) {
        using traits = number_traits<T>;
        return traits::abs(v) * traits::epsilon() / (1 - traits::epsilon());
    }
};

/// `tight` with an eighth of ε for a sum's rounding: too small a factor.
struct too_small : errbound::derived_rule<too_small, errbound::tight> {
    static constexpr const char* name = "too_small";
    template <class T>
    static constexpr bound<T> add(const T& v, rule_operand<T, too_small> a,
                                  rule_operand<T, too_small> b) {
        using traits = number_traits<T>;
        return {traits::abs(v) * (traits::epsilon() / 8) + a.bound.error + b.bound.error};
    }
    template <class T>
    static constexpr bound<T> subtract(const T& v, rule_operand<T, too_small> a,
                                       rule_operand<T, too_small> b) {
        return add(v, a, b);
    }
};

/// The same, also for types without subnormal numbers.
struct too_small_for_sums : errbound::derived_rule<too_small_for_sums, too_small> {
    static constexpr const char* name = "too_small_for_sums";
    static constexpr bool holds_without_subnormals = true;
};

inline std::string all_violations(const validation::report& r) {
    std::string text;
    for (const auto& v : r.violations)
        text += v.rule + " " + v.number + ": " + v.what + "\n" + v.code;
    return text;
}

/// The number of values that the reference may leave undetermined. `affine` is certain of zeros if
/// errors of one source cancel, but the reference only compares single values.
inline std::uint64_t allowed_undetermined(const validation::rule_counts& c) {
    return c.rule == "affine" ? c.values / 1000 : 0;
}

inline void expect_all_kept(const validation::report& r) {
    EXPECT_EQ(r.violation_count(), 0U) << all_violations(r);
    EXPECT_FALSE(r.counts.empty());
    for (const auto& c : r.counts) {
        EXPECT_LE(c.undetermined, allowed_undetermined(c)) << c.rule << " " << c.number;
        EXPECT_GT(c.cases, 0U) << c.rule << " " << c.number;
    }
}

}  // namespace validation_test
