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
std::vector<Query> some_queries() {
    std::vector<Query> all;
    for (const auto& family : query_families::families)
        for (std::uint64_t i = 0; i < 4; ++i)
            all.push_back(query_families::as_query<Query>(
                query_families::make(family, ccd::kind_of<Query>, 1, i)));
    return all;
}

template <class Query>
validation::report validated(const std::vector<ccd::lab::query_rule>& rules,
                             const std::vector<Query>& queries) {
    return validation::examine(ccd::lab::evidence_of_queries(rules, std::span(queries)), 0);
}

TEST(QueryValidation, EveryRuleKeepsItsPromises) {
    const auto rules = ccd::lab::query_rules();
    const auto queries = some_queries<ccd::vertex_face<double>>();
    const validation::report vf = validated(rules, queries);
    expect_all_kept(vf);
    expect_all_kept(validated(rules, some_queries<ccd::edge_edge<double>>()));
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
