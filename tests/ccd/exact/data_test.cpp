// Stored queries with known answers, from the public benchmark: every method keeps its promise.
#include <gtest/gtest.h>

#include <algorithm>
#include <ccd/io/query_file.hpp>
#include <ccd/method.hpp>
#include <cstddef>
#include <iostream>
#include <optional>
#include <string>

#include "ccd/exact/integers.hpp"
#include "tests/support/stored_data.hpp"

namespace {

struct errors {
    std::size_t queries = 0, uncertain = 0, false_positives = 0, false_negatives = 0;
};

/// Compares decide(query) with the stored answers.
template <class Decide>
errors expect_promise_kept(const std::string& name, bool may_lose, bool may_report,
                           const Decide& decide) {
    errors all;
    for (const auto& path : stored_data::files_in(stored_data::folder(), ".csv")) {
        const ccd::io::query_file file = ccd::io::read_queries(path, std::nullopt, false);
        if (!file.truth) continue;
        EXPECT_EQ(file.truth->size(), file.size()) << path;
        for (std::size_t i = 0; i < file.size(); ++i) {
            const bool truth = (*file.truth)[i];
            const ccd::verdict said =
                std::visit([&](const auto& queries) { return decide(queries[i]); }, file.queries);
            const bool lost = truth && !ccd::may_collide(said);
            const bool invented = !truth && ccd::may_collide(said);
            const bool is_uncertain = said.outcome == ccd::outcome::uncertain;
            ++all.queries;
            all.uncertain += is_uncertain;
            all.false_negatives += lost;
            all.false_positives += invented;
            const auto where = [&] { return name + ", query " + std::to_string(i) + " of "; };
            EXPECT_TRUE(may_lose || !lost) << where() << path;
            EXPECT_TRUE(may_lose || is_uncertain || !invented) << where() << path;
            EXPECT_TRUE(may_report || (!invented && !is_uncertain)) << where() << path;
        }
    }
    EXPECT_GT(all.queries, 0u) << "no query with truth";
    std::cout << name << ": " << all.queries << " queries, " << all.false_positives
              << " false positives, " << all.false_negatives << " false negatives, "
              << all.uncertain << " uncertain\n";
    return all;
}

class StoredQueries : public testing::TestWithParam<ccd::method_info> {};

TEST_P(StoredQueries, PromiseIsKept) {
    if (!is_directory(stored_data::folder())) GTEST_SKIP() << stored_data::missing;
    const ccd::method_info& method = GetParam();
    expect_promise_kept(std::string(method.name), method.may_lose_collisions,
                        method.may_report_false_collisions,
                        [&](const auto& query) { return ccd::decide(method.method, query); });
}

// Decides all queries by a stage that few reach in `exact`, because of its filter.
TEST(StoredQueriesInIntegers, OfFixedWidth) {
    if (!is_directory(stored_data::folder())) GTEST_SKIP() << stored_data::missing;
    const errors all = expect_promise_kept("integers", false, true, [](const auto& query) {
        return ccd::detail::decide_in_integers(query);
    });
    // Speed depends on the number of queries left to the reference, currently none.
    EXPECT_LE(all.uncertain, all.queries / 1000);
}

INSTANTIATE_TEST_SUITE_P(Methods, StoredQueries, testing::ValuesIn(ccd::methods()),
                         [](const testing::TestParamInfo<ccd::method_info>& method) {
                             std::string name(method.param.name);
                             std::ranges::replace(name, '-', '_');
                             return name;
                         });

}  // namespace
