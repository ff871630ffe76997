// Bound rule `none`: plain arithmetic without bounds.
#pragma once

#include <errbound/rules/rule.hpp>

namespace errbound {

/// Treats every finite result as exact: signs are guesses (proofs/rules/IeeeRules.v, none_guesses).
struct none {
    static constexpr const char* name = "none";
    static constexpr error_meaning error_is = error_meaning::nothing;
    static constexpr bool holds_without_subnormals = true;  // it promises nothing

    template <class T>
    struct bound {};

    template <class T>
    static constexpr bound<T> exact(const T&) {
        return {};
    }
    template <class T>
    static constexpr bound<T> within(const T&, const T&) {
        return {};
    }
    template <class T>
    static constexpr T error(const T& value, const bound<T>&) {
        using traits = number_traits<T>;
        return traits::is_finite(value) ? T(0) : traits::infinity();
    }
    template <class T>
    static constexpr bound<T> add(const T&, rule_operand<T, none>, rule_operand<T, none>) {
        return {};
    }
    template <class T>
    static constexpr bound<T> subtract(const T&, rule_operand<T, none>, rule_operand<T, none>) {
        return {};
    }
    template <class T>
    static constexpr bound<T> multiply(const T&, rule_operand<T, none>, rule_operand<T, none>) {
        return {};
    }
    template <class T>
    static constexpr bound<T> divide(const T&, rule_operand<T, none>, rule_operand<T, none>) {
        return {};
    }
    template <class T>
    static constexpr bound<T> scale(const T&, rule_operand<T, none>, int) {
        return {};
    }
};

}  // namespace errbound
