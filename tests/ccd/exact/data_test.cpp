// Stored queries with known answers, from the public benchmark: every method keeps its promise.
//
// Data are in the folder ERRBOUND_SHARED_DATA of the environment, else of the build.
#include <gtest/gtest.h>

#include <algorithm>
#include <ccd/io/query_file.hpp>
#include <ccd/method.hpp>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include "ccd/exact/integers.hpp"

namespace {

namespace fs = std::filesystem;

fs::path data_folder() {
    if (const char* folder = std::getenv("ERRBOUND_SHARED_DATA")) return folder;
#ifdef ERRBOUND_SHARED_DATA
    return ERRBOUND_SHARED_DATA;
#else
    return {};
#endif
}

std::vector<fs::path> query_paths(const fs::path& folder) {
    std::vector<fs::path> paths;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        if (entry.path().extension() == ".csv") paths.push_back(entry.path());
    }
    std::sort(paths.begin(), paths.end());
    return paths;
}

ccd::verdict decide(ccd::method method, const ccd::io::query_file& file, std::size_t i) {
    return std::visit([=](const auto& queries) { return ccd::decide(method, queries[i]); },
                      file.queries);
}

struct errors {
    std::size_t queries = 0, uncertain = 0, false_positives = 0, false_negatives = 0;
};

class stored_query_methods : public testing::TestWithParam<ccd::method_info> {};

TEST_P(stored_query_methods, promise_is_kept) {
    const fs::path folder = data_folder();
    if (!fs::is_directory(folder)) {
        GTEST_SKIP() << "No stored queries at \"" << folder.string()
                     << "\": set ERRBOUND_SHARED_DATA to the folder that holds them.";
    }
    const ccd::method_info& method = GetParam();
    errors all;
    for (const fs::path& path : query_paths(folder)) {
        const ccd::io::query_file file = ccd::io::read_queries(path, std::nullopt, false);
        if (!file.truth) continue;
        ASSERT_EQ(file.truth->size(), file.size()) << path;
        for (std::size_t i = 0; i < file.size(); ++i) {
            const bool truth = (*file.truth)[i];
            const ccd::verdict said = decide(method.method, file, i);
            const bool lost = truth && !ccd::may_collide(said);
            const bool invented = !truth && ccd::may_collide(said);
            ++all.queries;
            all.uncertain += said.outcome == ccd::outcome::uncertain;
            all.false_negatives += lost;
            all.false_positives += invented;
            if (!method.may_lose_collisions) {
                EXPECT_FALSE(lost) << method.name << " lost query " << i << " of " << path;
                EXPECT_FALSE(!truth && said.outcome == ccd::outcome::collides)
                    << method.name << " is certain of a false collision: query " << i << " of "
                    << path;
            }
            if (!method.may_report_false_collisions) {
                EXPECT_FALSE(invented) << method.name << " invented query " << i << " of " << path;
                EXPECT_NE(said.outcome, ccd::outcome::uncertain) << "query " << i << " of " << path;
            }
        }
    }
    EXPECT_GT(all.queries, 0u) << "no query with truth under " << folder;
    std::cout << method.name << ": " << all.queries << " queries, " << all.false_positives
              << " false positives, " << all.false_negatives << " false negatives, "
              << all.uncertain << " uncertain\n";
}

// Decides all queries by a stage that few reach in `exact`, because of its filter.
TEST(stored_queries, are_decided_in_integers_of_fixed_width) {
    const fs::path folder = data_folder();
    if (!fs::is_directory(folder)) GTEST_SKIP() << "No stored queries.";
    errors all;
    for (const fs::path& path : query_paths(folder)) {
        const ccd::io::query_file file = ccd::io::read_queries(path, std::nullopt, false);
        if (!file.truth) continue;
        for (std::size_t i = 0; i < file.size(); ++i) {
            const ccd::outcome said = std::visit(
                [i](const auto& queries) {
                    return ccd::detail::decide_in_integers(queries[i]).outcome;
                },
                file.queries);
            ++all.queries;
            all.uncertain += said == ccd::outcome::uncertain;
            if (said == ccd::outcome::uncertain) continue;
            EXPECT_EQ(said == ccd::outcome::collides, (*file.truth)[i])
                << "query " << i << " of " << path;
        }
    }
    // Speed depends on the number of queries left to the reference, currently none.
    EXPECT_LE(all.uncertain, all.queries / 1000);
    std::cout << all.queries << " queries, " << all.uncertain << " uncertain\n";
}

INSTANTIATE_TEST_SUITE_P(methods, stored_query_methods, testing::ValuesIn(ccd::methods()),
                         [](const testing::TestParamInfo<ccd::method_info>& method) {
                             std::string name(method.param.name);
                             std::ranges::replace(name, '-', '_');
                             return name;
                         });

}  // namespace
