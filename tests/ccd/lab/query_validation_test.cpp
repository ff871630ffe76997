// Validation of bound rules on queries: every rule passes, and rules broken on purpose are caught.
#include "ccd/lab/validation/query_validation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/errbound/validation/validation_rules.hpp"
#include "tests/support/query_families.hpp"

namespace {

namespace validation = errbound::validation;
using validation_test::expect_all_kept;

template <class Query>
validation::report validated(const std::vector<ccd::lab::query_rule>& rules,
                             const std::vector<Query>& queries) {
    return validation::examine(ccd::lab::evidence_of_queries(rules, std::span(queries)), 0);
}

TEST(QueryValidation, EveryRuleKeepsItsPromises) {
    const auto rules = ccd::lab::query_rules();
    const auto queries = query_families::of_all_families<ccd::vertex_face<double>>(4, 1);
    const validation::report vf = validated(rules, queries);
    expect_all_kept(vf);
    expect_all_kept(
        validated(rules, query_families::of_all_families<ccd::edge_edge<double>>(4, 1)));
    for (const char* quantity : {"k0", "3 k1", "3 k2", "k3", "Y'(0)", "Y'(1)", "Y''(0)", "Y''(1)",
                                 "G", "J", "M", "R", "Y(t_M)", "Y(t_R)"})
        EXPECT_TRUE(std::ranges::any_of(vf.distributions, [quantity](const auto& t) {
            return t.rule == "tight" && t.quantity == quantity && t.log10.ratios() > 0;
        })) << quantity;
    const validation::report caught =
        validated({ccd::lab::query_rule_of<validation_test::too_small>()}, queries);
    EXPECT_GT(caught.violation_count(), 0U);
    ASSERT_FALSE(caught.violations.empty());
    EXPECT_EQ(std::ranges::count(caught.violations.front().code, '\n'), 8);
}

}  // namespace
