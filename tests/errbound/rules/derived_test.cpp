// Rules that change one operation of another rule.
#include <gtest/gtest.h>

#include <errbound/functions.hpp>
#include <errbound/rules/derived.hpp>
#include <errbound/tracked.hpp>
#include <errbound/validation/rule_list.hpp>

namespace {

using errbound::sign_type;
using errbound::tracked;

template <class Rule>
struct same_as_rule : errbound::derived_rule<same_as_rule<Rule>, Rule> {};

/// Sums of exact numbers count as exact.
struct careless : errbound::derived_rule<careless, errbound::sharp> {
    static constexpr const char* name = "careless";
    static constexpr errbound::error_meaning error_is = errbound::error_meaning::estimate;
    template <class T>
    static constexpr bound<T> add(const T&, errbound::rule_operand<T, careless> a,
                                  errbound::rule_operand<T, careless> b) {
        return {a.bound.error + b.bound.error};
    }
};

template <class Rule>
void expect_same() {
    using derived = tracked<double, same_as_rule<Rule>>;
    using original = tracked<double, Rule>;
    const auto compute = []<class Number>(Number) {
        const Number a = 0.1, b = Number::within(0.3, 1e-10), c = -7;
        Number x = (a * b - scale(c, -3)) * (a + b);
        if constexpr (errbound::detail::rule_divides<Rule, double>) x = x / c;
        return -x;
    };
    const auto x = compute(derived());
    const auto y = compute(original());
    EXPECT_EQ(x.value(), y.value());
    EXPECT_EQ(x.error(), y.error());
    EXPECT_EQ(sign_of(x), sign_of(y));
    EXPECT_STREQ(same_as_rule<Rule>::name, Rule::name);
    static_assert(errbound::promises_bound<same_as_rule<Rule>> == errbound::promises_bound<Rule>);
}

TEST(DerivedRule, WithoutChangesIsTheRule) {
    using namespace errbound;
    for_each_rule(rule_types<none, safe, tight, sharp, interval, residual, affine>(),
                  []<class Rule>() { expect_same<Rule>(); });
}

TEST(DerivedRule, ChangesTheOperationsThatItDefines) {
    using number = tracked<double, careless>;
    constexpr number a = 0.1, b = 0.2;
    EXPECT_EQ((a + b).error(), 0);
    EXPECT_GT((a - b).error(), 0);
    EXPECT_EQ(
        (a * b).error(),
        (tracked<double, errbound::sharp>(0.1) * tracked<double, errbound::sharp>(0.2)).error());
    EXPECT_STREQ(careless::name, "careless");
    static_assert(!errbound::promises_bound<careless>);
    static_assert(!same_as_rule<errbound::tight>::holds_in_directed_rounding &&
                  errbound::tight::holds_in_directed_rounding);
    constexpr number c = number(1) / number(3) + a;
    static_assert(sign_of(c) == sign_type::positive);
}

}  // namespace
