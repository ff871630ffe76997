// Derives a bound rule from another, to change one operation.
//   struct mine : errbound::derived_rule<mine, errbound::tight> {
//       static constexpr const char* name = "mine";
//       template <class T>
//       static constexpr bound<T> add(const T& v, errbound::rule_operand<T, mine> a,
//                                     errbound::rule_operand<T, mine> b);  // the changed operation
//   };
#pragma once

#include <errbound/rules/rule.hpp>

namespace errbound {

/// Same as Rule in state, operations and constants, except the two below and dot_bound: dot
/// products apply Self's operations one by one. If an operation of Rule calls another (`subtract`
/// calls `add`), it calls Rule's, not Self's. A changed operation voids Rule's promise: set
/// error_is, or prove and validate the change.
template <class Self, class Rule>
struct derived_rule : Rule {
    /// Rule's proof does not cover Self. Self may redefine these.
    static constexpr bool holds_in_directed_rounding = false, holds_without_subnormals = false;

    template <class T>
    using bound = typename Rule::template bound<T>;

    template <class T>
    static constexpr bound<T> add(const T& v, rule_operand<T, Self> a, rule_operand<T, Self> b) {
        return Rule::template add<T>(v, original<T>(a), original<T>(b));
    }
    template <class T>
    static constexpr bound<T> subtract(const T& v, rule_operand<T, Self> a,
                                       rule_operand<T, Self> b) {
        return Rule::template subtract<T>(v, original<T>(a), original<T>(b));
    }
    template <class T>
    static constexpr bound<T> multiply(const T& v, rule_operand<T, Self> a,
                                       rule_operand<T, Self> b) {
        return Rule::template multiply<T>(v, original<T>(a), original<T>(b));
    }
    template <class T>
    static constexpr bound<T> divide(
        const T& v, rule_operand<T, Self> a,
        rule_operand<T, Self> b) requires(detail::rule_has_divide<Rule, T>) {
        return Rule::template divide<T>(v, original<T>(a), original<T>(b));
    }
    template <class T>
    static constexpr bound<T> scale(const T& v, rule_operand<T, Self> a, int e) {
        return Rule::template scale<T>(v, original<T>(a), e);
    }
    template <class T>
    static constexpr bound<T> square_root(const T& v, rule_operand<T, Self> a) requires(
        detail::rule_has_square_root<Rule, T>) {
        return Rule::template square_root<T>(v, original<T>(a));
    }
    template <class T>
    static constexpr bound<T> fused(
        const T& v, rule_operand<T, Self> a, rule_operand<T, Self> b,
        rule_operand<T, Self> c) requires(detail::rule_has_fused<Rule, T>) {
        return Rule::template fused<T>(v, original<T>(a), original<T>(b), original<T>(c));
    }

    template <class T>
    static constexpr rule_operand<T, Rule> original(rule_operand<T, Self> a) {
        return {a.value, a.bound};
    }
};

}  // namespace errbound
