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
    for (const auto& family : query_families::families)
        for (const ccd::kind which : ccd::stored_kinds)
            for (std::uint64_t i = 0; i < queries_per_family / family.thinning; ++i)
                query_families::visit_stored_query(
                    which, make(family, which, 1, i), [&](const auto& query) {
                        ++queries;
                        const outcome answer = ccd::decide_bsc<TypeParam>(query).outcome;
                        if (answer == outcome::uncertain) return;
                        ++certain;
                        EXPECT_EQ(answer, ccd::decide_reference(query).outcome)
                            << family.name << " " << i;
                    });
    EXPECT_GT(certain, queries / 5) << TypeParam::name;
}

}  // namespace
