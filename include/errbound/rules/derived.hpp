// A bound rule that is another but for a part.
//
//   struct mine : errbound::derived_rule<mine, errbound::tight> {
//       static constexpr const char* name = "mine";
//       template <class T>
//       static constexpr bound<T> add(const T& v, errbound::rule_operand<T, mine> a,
//                                     errbound::rule_operand<T, mine> b);  // what is different
//   };
#pragma once

#include <errbound/rules/rule.hpp>

namespace errbound {

/// Everything as in Rule: its state, its operations, what it says of itself; but for a dot_bound,
/// which would not see what is different: dot products are one operation after the other. Self, the
/// rule that is made, hides what it has another of. Rule's operations call Rule's own (its
/// `subtract` its `add`), not Self's. Self has Rule's name in tables unless it has one of its own.
/// What Rule promises no longer follows where an operation is changed: say so by error_is, or prove
/// it, and have it validated.
template <class Self, class Rule>
struct derived_rule : Rule {
    /// What a proof needs less than others is not taken for proved of Self, too: Self may say it.
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

    /// An operand as one of Rule's, for Self to hand on.
    template <class T>
    static constexpr rule_operand<T, Rule> original(rule_operand<T, Self> a) {
        return {a.value, a.bound};
    }
};

}  // namespace errbound
