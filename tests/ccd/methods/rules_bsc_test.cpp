// BSC over every bound rule, on every family of random queries: `separate` and `collides` are
// certain under every rule.
#include <gtest/gtest.h>

#include <ccd/methods/bsc.hpp>
#include <ccd/reference.hpp>
#include <cstddef>
#include <cstdint>
#include <errbound/rules/affine.hpp>
#include <errbound/rules/relative.hpp>

#include "tests/support/query_families.hpp"

namespace {

using ccd::outcome;

template <class Rule>
class BscBy : public testing::Test {};
using rules = testing::Types<errbound::safe, errbound::tight, errbound::sharp, errbound::interval,
                             errbound::residual, errbound::affine, errbound::relative>;
TYPED_TEST_SUITE(BscBy, rules);

TYPED_TEST(BscBy, CertainAnswersAreRight) {
    constexpr std::uint64_t queries_per_family = 20;
    std::size_t certain = 0, queries = 0;
    const auto check = [&](const auto& query, const auto& family, std::uint64_t index) {
        ++queries;
        const outcome answer = ccd::decide_bsc<TypeParam>(query).outcome;
        if (answer == outcome::uncertain) return;
        ++certain;
        EXPECT_EQ(answer, ccd::decide_reference(query).outcome) << family.name << " " << index;
    };
    for (const auto& family : query_families::families) {
        for (std::uint64_t i = 0; i < queries_per_family / family.thinning; ++i) {
            using query_families::kind;
            check(query_families::as_query<ccd::vertex_face<double>>(
                      make(family, kind::vertex_face, 1, i)),
                  family, i);
            check(query_families::as_query<ccd::edge_edge<double>>(
                      make(family, kind::edge_edge, 1, i)),
                  family, i);
        }
    }
    EXPECT_GT(certain, queries / 5) << TypeParam::name;
}

}  // namespace
