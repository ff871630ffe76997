// What the tests of validation share: rules that are broken on purpose, and what to expect of a
// report.
#pragma once

#include <gtest/gtest.h>

#include <errbound/validation/validation.hpp>
#include <string>

namespace validation_test {

namespace validation = errbound::validation;
using errbound::number_traits;
using errbound::rule_operand;

/// TightBound as the paper prints it: no term for underflow, none for the bound's own rounding.
struct as_printed {
    static constexpr const char* name = "as_printed";
    template <class T>
    struct bound {
        T error;
    };
    template <class T>
    static constexpr bound<T> exact(const T& value) {
        return {value - value};
    }
    template <class T>
    static constexpr bound<T> within(const T& value, const T& error) {
        return {error + (value - value)};
    }
    template <class T>
    static constexpr T error(const T&, const bound<T>& b) {
        return b.error;
    }
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
struct too_small {
    static constexpr const char* name = "too_small";
    template <class T>
    using bound = errbound::tight::bound<T>;
    template <class T>
    static rule_operand<T, errbound::tight> as_tight(rule_operand<T, too_small> a) {
        return {a.value, a.bound};
    }
    template <class T>
    static constexpr bound<T> exact(const T& value) {
        return errbound::tight::exact(value);
    }
    template <class T>
    static constexpr bound<T> within(const T& value, const T& error) {
        return errbound::tight::within(value, error);
    }
    template <class T>
    static constexpr T error(const T&, const bound<T>& b) {
        return b.error;
    }
    template <class T>
    static bound<T> add(const T& v, rule_operand<T, too_small> a, rule_operand<T, too_small> b) {
        using traits = number_traits<T>;
        return {traits::abs(v) * (traits::epsilon() / 8) + a.bound.error + b.bound.error};
    }
    template <class T>
    static bound<T> subtract(const T& v, rule_operand<T, too_small> a,
                             rule_operand<T, too_small> b) {
        return add(v, a, b);
    }
    template <class T>
    static bound<T> multiply(const T& v, rule_operand<T, too_small> a,
                             rule_operand<T, too_small> b) {
        return errbound::tight::multiply<T>(v, as_tight<T>(a), as_tight<T>(b));
    }
    template <class T>
    static bound<T> divide(const T& v, rule_operand<T, too_small> a, rule_operand<T, too_small> b) {
        return errbound::tight::divide<T>(v, as_tight<T>(a), as_tight<T>(b));
    }
    template <class T>
    static bound<T> scale(const T& v, rule_operand<T, too_small> a, int e) {
        return errbound::tight::scale<T>(v, as_tight<T>(a), e);
    }
};

inline std::string all_violations(const validation::report& r) {
    std::string text;
    for (const auto& v : r.violations)
        text += v.rule + " " + v.number + ": " + v.what + "\n" + v.code;
    return text;
}

inline void expect_all_kept(const validation::report& r) {
    EXPECT_EQ(r.violation_count(), 0U) << all_violations(r);
    EXPECT_FALSE(r.counts.empty());
    for (const auto& c : r.counts) {
        EXPECT_EQ(c.undetermined, 0U) << c.rule << " " << c.number;
        EXPECT_GT(c.cases, 0U) << c.rule << " " << c.number;
    }
}

}  // namespace validation_test
