// Custom rules compared with those of the library: they decide like the methods of their names, in
// double and float. Wrong answers are counted. The main program reads files and prints its
// messages.
#include <gtest/gtest.h>

#include <algorithm>
#include <ccd/method.hpp>
#include <ccd/study/rules.hpp>
#include <cstddef>
#include <errbound/rules/derived.hpp>
#include <random>
#include <string>
#include <vector>

#include "errbound/support/output_file.hpp"
#include "tests/support/files.hpp"

namespace {

using ccd::study::compare_rules;
using ccd::study::rule_row;
using query = ccd::vertex_face<double>;

struct renamed : errbound::derived_rule<renamed, errbound::tight> {
    static constexpr const char* name = "renamed";
};
/// Reports all values as exact, and promises it.
struct boasting : errbound::derived_rule<boasting, errbound::none> {
    static constexpr const char* name = "boasting";
    static constexpr errbound::error_meaning error_is = errbound::error_meaning::bound;
};

/// A vertex that falls onto a face's edge, or near it, at t = 1/2.
std::vector<query> near_edges(std::size_t count) {
    std::mt19937_64 random(3);
    const auto draw = [&] { return static_cast<double>(random() >> 11) * 0x1p-52 - 1; };
    std::vector<query> queries;
    for (std::size_t i = 0; i < count; ++i) {
        const auto moving = [&](double x, double y, double z, double down) {
            return ccd::moving_point<double>{{x, y, z + down}, {x, y, z - down}};
        };
        const double a = draw(), b = draw(), share = (draw() + 1) / 2;
        const double off = i % 2 == 0 ? 0x1p-40 * draw() : 0.1 * draw();
        queries.push_back({moving(a + share * (1 - a), b + share * (2 - b) + off, 0, 1),
                           moving(a, b, 0.3, 0), moving(1, 2, -0.2, 0), moving(5, -1, 0, 0)});
    }
    return queries;
}
std::vector<bool> truth_of(const std::vector<query>& queries) {
    std::vector<bool> truth;
    for (const query& q : queries)
        truth.push_back(ccd::decide_exact(q).outcome == ccd::outcome::collides);
    return truth;
}

TEST(CompareRules, DecideAsTheMethodsDo) {
    const std::vector<query> queries = near_edges(400);
    const auto rows = compare_rules<renamed, errbound::residual>(queries, truth_of(queries), 1);
    ASSERT_EQ(rows.size(), 4U);
    EXPECT_EQ(rows[0].rule, "renamed");
    EXPECT_EQ(rows[1].number, "float");
    for (const auto& [row, method] :
         {std::pair{rows[0], ccd::method::tight}, std::pair{rows[2], ccd::method::residual}}) {
        std::size_t reported = 0;
        for (const query& q : queries)
            reported += ccd::decide(method, q).outcome != ccd::outcome::separate;
        EXPECT_EQ(row.collisions, reported) << row.rule;
    }
    for (const rule_row& row : rows) {
        EXPECT_EQ(row.queries, queries.size());
        EXPECT_EQ(row.false_negatives, 0U);
        EXPECT_EQ(row.wrong, 0U);
        EXPECT_TRUE(row.promises && !row.is_broken());
        EXPECT_GT(row.ns_per_query, 0);
    }
    EXPECT_LE(rows[2].uncertain, rows[0].uncertain);
    EXPECT_LT(rows[0].uncertain, rows[1].uncertain);  // float is less accurate
}

TEST(CompareRules, CountsBrokenPromises) {
    const std::vector<query> queries = near_edges(400);
    const auto rows = compare_rules<boasting, errbound::none>(queries, truth_of(queries), 1);
    EXPECT_GT(rows[1].wrong, 0U);
    EXPECT_TRUE(rows[1].is_broken());
    EXPECT_EQ(rows[3].wrong, rows[1].wrong);
    EXPECT_FALSE(rows[3].is_broken());  // `none` promises nothing
    EXPECT_EQ(compare_rules<renamed>(std::vector<query>(), {}).front().queries, 0U);
}

template <class... Rules>
int run(const std::vector<std::string>& arguments) {
    std::vector<const char*> all{"program"};
    for (const std::string& a : arguments) all.push_back(a.c_str());
    return ccd::study::rules_main<Rules...>(static_cast<int>(all.size()), all.data());
}

/// Writes a colliding query; `truth` follows each of its rows.
void write_query(const std::filesystem::path& file, const std::string& truth = "") {
    std::string text;
    for (const char* row : {"0x1.3p-2,0.1,0.7", "0.1,-0.3,0", "1.3,0,0.1", "0.1,1.7,0",
                            "0.23,0.1,-0.7", "0,-0.3,0", "1.3,0.1,0", "0,1.7,0.1"})
        text += row + truth + '\n';
    test_files::write(file, text);
}

/// The files of `ccd report`, with a method for each rule and number type.
TEST(RulesMain, WritesCsvJsonAndPictures) {
    const test_files::temporary_directory folder;
    const std::string file = (folder.path / "vf.csv").string();
    write_query(file);
    const auto out = folder.path / "made" / "out";
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    EXPECT_EQ((run<renamed, errbound::none>({"--out", out.string(), file})), 0);
    testing::internal::GetCapturedStdout();
    const bool drawn = testing::internal::GetCapturedStderr().empty();
    const std::string csv = errbound::support::read_whole(out / "methods.csv");
    EXPECT_TRUE(csv.starts_with("data_set,origin,kind,method,queries,colliding,")) << csv;
    EXPECT_NE(csv.find(",stored,vf,\"renamed, float\",1,1,1,0,0,0,1,"), std::string::npos) << csv;
    EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 5);
    const std::string json = errbound::support::read_whole(out / "methods.json");
    EXPECT_NE(json.find("\"method\": \"none, double\""), std::string::npos) << json;
    EXPECT_EQ(std::filesystem::exists(out / "pareto-queries.png"), drawn);
    EXPECT_EQ(run<renamed>({"--out", out.string()}), 2);
    testing::internal::CaptureStdout();
    EXPECT_EQ(run<renamed>({"--out", file, file}), 1);  // a file is not a folder
    testing::internal::GetCapturedStdout();
}

TEST(RulesMain, ReadsFilesAndSaysWhatItMust) {
    const test_files::temporary_directory folder;
    const std::string file = (folder.path / "vf.csv").string();
    write_query(file);
    testing::internal::CaptureStdout();
    EXPECT_EQ((run<renamed, errbound::none>({file})), 0);
    const std::string text = testing::internal::GetCapturedStdout();
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 5) << text;
    EXPECT_NE(text.find("renamed      float           1          1"), std::string::npos) << text;
    EXPECT_EQ(run<renamed>({}), 2);
    testing::internal::CaptureStderr();
    EXPECT_EQ(run<renamed>({(folder.path / "no_vf.csv").string()}), 1);
    EXPECT_NE(testing::internal::GetCapturedStderr().find("no_vf.csv"), std::string::npos);
    // The stored answer contradicts that of the method, so its promise counts as broken.
    const std::string stored = (folder.path / "truth" / "vf.csv").string();
    write_query(stored, ",0");
    EXPECT_EQ(run<renamed>({stored}), 1);
    EXPECT_EQ(run<errbound::none>({stored}), 0);
}

}  // namespace
