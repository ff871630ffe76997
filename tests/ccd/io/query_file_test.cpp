// The readers of stored queries: what they read, and what they say about bad input.
#include <gtest/gtest.h>

#include <ccd/io/query_file.hpp>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "tests/support/files.hpp"

namespace {

using namespace ccd;
using namespace ccd::io;
using test_files::message_of;
using test_files::repeated;
using test_files::temporary_directory;
using test_files::write;
namespace fs = std::filesystem;

query_file queries(const std::string& text, bool round = false) {
    return parse_queries(text, "q.csv", kind::vertex_face, round);
}

const std::vector<vertex_face<double>>& vertex_faces(const query_file& file) {
    return std::get<std::vector<vertex_face<double>>>(file.queries);
}

std::string query_error(const std::string& text) {
    return message_of([&] { queries(text); });
}

TEST(Queries, RowsBecomePoints) {
    std::string text;
    for (int row = 0; row < 8; ++row) text += std::to_string(row) + ",2,1,1,0,1\n";
    const query_file vf = queries(text);
    EXPECT_EQ(vf.kind(), kind::vertex_face);
    ASSERT_EQ(vf.size(), 1U);
    EXPECT_FALSE(vf.truth.has_value());
    const auto& q = vertex_faces(vf)[0];
    EXPECT_EQ(q.v, (moving_point<double>{{0, 1, 0}, {2, 1, 0}}));
    EXPECT_EQ(q.f0, (moving_point<double>{{0.5, 1, 0}, {2.5, 1, 0}}));
    EXPECT_EQ(q.f1, (moving_point<double>{{1, 1, 0}, {3, 1, 0}}));
    EXPECT_EQ(q.f2, (moving_point<double>{{1.5, 1, 0}, {3.5, 1, 0}}));

    const query_file ee = parse_queries(text, "q", kind::edge_edge, false);
    const auto& edges = std::get<std::vector<edge_edge<double>>>(ee.queries);
    ASSERT_EQ(edges.size(), 1U);
    EXPECT_EQ(edges[0].a1, q.f0);
    EXPECT_EQ(edges[0].b1, q.f2);
}

TEST(Queries, ByteOrderMarksAndCarriageReturns) {
    const std::string rows = repeated("1,1,1,1,1,1\n", 8);
    EXPECT_EQ(queries("\xef\xbb\xbf" + rows).size(), 1U);
    EXPECT_EQ(query_error("\xff\xfe" + rows),
              "q.csv: found UTF-16 or UTF-32, expected ASCII or UTF-8");
    EXPECT_EQ(query_error("\xef\xbb\xbf").substr(0, 27), "q.csv: found an empty file,");
    EXPECT_EQ(queries(repeated("1,1,1,1,1,1\r", 16)).size(), 2U);
    EXPECT_EQ(query_error(std::string("1,\0,1\n", 7)),
              "q.csv:1: found '\\x00' as y, expected a decimal or hexadecimal float");
}

TEST(Queries, FormsAndLineEnds) {
    const query_file truth =
        queries(repeated("1,1,1,1,1,1,1\r\n", 8) + repeated("1,1,1,1,1,1,0\r\n", 8) + "\r\n\n");
    EXPECT_EQ(truth.truth, (std::vector<bool>{true, false}));
    EXPECT_EQ(truth.size(), 2U);
    const query_file decimal = queries(repeated("0.1, 0x1.8p1 ,-3e2,1\n", 7) + "0.1,3,-300,1");
    EXPECT_EQ(decimal.truth, std::vector<bool>{true});
    EXPECT_EQ(vertex_faces(decimal)[0].f2.t1, (point<double>{0.1, 3, -300}));
    EXPECT_EQ(vertex_faces(decimal)[0].v.t0, (point<double>{0.1, 3, -300}));
    EXPECT_EQ(vertex_faces(queries(repeated("1,3,0,1,0,1\n", 8), true))[0].v.t0.x, 1.0 / 3);
}

TEST(Queries, BadInput) {
    const std::string good = "1,1,1,1,1,1\n", seven = repeated(good, 7);
    EXPECT_EQ(query_error("").substr(0, 33), "q.csv: found an empty file, expec");
    EXPECT_EQ(query_error("\n\r\n").substr(0, 26), "q.csv: found an empty file");
    EXPECT_EQ(
        query_error(repeated(good, 12)),
        "q.csv:12: found a truncated query, 4 rows from line 9 on, expected 8 rows per query");
    EXPECT_EQ(query_error(good + "1,1,1.5,1,1,1\n"),
              "q.csv:2: found '1.5' as the numerator of y, expected an integer");
    EXPECT_EQ(query_error("1,1,1,1,1,x\n"),
              "q.csv:1: found 'x' as the denominator of z, expected an integer");
    EXPECT_EQ(query_error("nan,1,1,1,1,1\n"),
              "q.csv:1: found 'nan' as the numerator of x, expected an integer");
    EXPECT_EQ(query_error("1,1,1,,1,1\n"),
              "q.csv:1: found '' as the denominator of y, expected an integer");
    EXPECT_EQ(query_error(seven + "1,1,1,0,1,1\n"),
              "q.csv:8: found '1'/'0' as y, expected a nonzero denominator");
    EXPECT_EQ(query_error(good + "1,3,1,1,1,1\n"),
              "q.csv:2: found '1'/'3' as x, which no double equals, expected an exact double (or "
              "--round)");
    EXPECT_EQ(query_error("1,1,1,1,1" + repeated("0", 400) + ",1\n"),
              "q.csv:1: found '1" + repeated("0", 36) +
                  "...'/'1' as z, which overflows, expected a finite double");
    EXPECT_EQ(
        query_error("1,1,1,1," + repeated("1", 9999) + ",1\n"),
        "q.csv:1: found more than 4096 digits as z, expected a number that a double can equal");
    EXPECT_EQ(query_error("0,NaN,0\n"), "q.csv:1: found 'NaN' as y, expected a finite number");
    EXPECT_EQ(query_error("0,0,-inf\n"), "q.csv:1: found '-inf' as z, expected a finite number");
    EXPECT_EQ(query_error("0,0,1e999\n"),
              "q.csv:1: found '1e999' as z, which overflows, expected a finite double");
    EXPECT_EQ(
        query_error("0,0,0x1p-2000\n"),
        "q.csv:1: found '0x1p-2000' as z, which no double equals, expected an exact double (or "
        "--round)");
    EXPECT_EQ(query_error("0,zero,0\n"),
              "q.csv:1: found 'zero' as y, expected a decimal or hexadecimal float");
    EXPECT_EQ(query_error(good + "1,1,1\n"),
              "q.csv:2: found 3 columns, expected 6 as in the first row");
    EXPECT_EQ(query_error("1,2\n").substr(0, 46), "q.csv:1: found '1,2' (columns: 2), expected 6 ");
    EXPECT_EQ(query_error(good + "\n" + good), "q.csv:2: found a blank line, expected a row");
    EXPECT_EQ(query_error("1,1,1,1,1,1,2\n"), "q.csv:1: found '2' as truth, expected 0 or 1");
    EXPECT_EQ(query_error("1,1,1,1,1,1,1\n1,1,1,1,1,1,0\n"),
              "q.csv:2: found truth 0, expected 1 as in the first row of this query");
    std::string garbage;
    for (int i = 0; i < 4096; ++i) garbage += static_cast<char>(i * 37 + i / 256);
    const std::string message = query_error(garbage);
    EXPECT_TRUE(message.starts_with("q.csv:1: found '"));
    EXPECT_LT(message.size(), 300U);
}

TEST(Queries, KindFromPath) {
    EXPECT_EQ(kind_from_path("a/vertex-face/data.csv"), kind::vertex_face);
    EXPECT_EQ(kind_from_path("a/edge-edge/b/data.csv"), kind::edge_edge);
    EXPECT_EQ(kind_from_path("queries/227vf.csv"), kind::vertex_face);
    EXPECT_EQ(kind_from_path("vertex-face/227ee.csv"), kind::edge_edge);
    EXPECT_EQ(kind_from_path("ee/data.csv"), kind::edge_edge);
    EXPECT_EQ(kind_from_path("vf.csv"), kind::vertex_face);
    EXPECT_EQ(kind_from_path("coffee.csv"), std::nullopt);
    EXPECT_EQ(kind_from_path("not-edge-edges/data.csv"), std::nullopt);
}

TEST(Queries, Files) {
    const temporary_directory directory;
    const fs::path file = directory.path / "queries" / "7vf.csv";
    write(file, repeated("1,1,1,1,1,1\n", 16));
    EXPECT_FALSE(read_queries(file, std::nullopt, false).truth.has_value());
    EXPECT_EQ(read_queries(file, kind::edge_edge, false).kind(), kind::edge_edge);

    const fs::path truth = directory.path / "mma_bool" / "7vf_mma_bool.json";
    write(truth, "[true, false]");
    EXPECT_EQ(read_queries(file, std::nullopt, false).truth, (std::vector<bool>{true, false}));
    write(truth, "[true]");
    const auto read = [&] { read_queries(file, std::nullopt, false); };
    EXPECT_NE(message_of(read).find("found 1 truth values, expected 2, one per query of"),
              std::string::npos);

    EXPECT_NE(message_of([&] {
                  read_queries("/no/such/vf.csv", std::nullopt, false);
              }).find("/no/such/vf.csv: found no such file"),
              std::string::npos);
    EXPECT_NE(message_of([&] {
                  read_queries(directory.path, kind::edge_edge, false);
              }).find("found a directory, expected a file"),
              std::string::npos);
    write(directory.path / "plain.csv", "1,1,1\n");
    EXPECT_NE(message_of([&] {
                  read_queries(directory.path / "plain.csv", std::nullopt, false);
              }).find("found no kind of query in the path"),
              std::string::npos);
}

TEST(Queries, Truth) {
    EXPECT_EQ(parse_truth("[true,false ,true]\n", "t"), (std::vector<bool>{true, false, true}));
    EXPECT_TRUE(parse_truth("[]", "t").empty());
    const auto error = [](const std::string& text) {
        return message_of([&] { parse_truth(text, "t.json"); });
    };
    EXPECT_EQ(error("[true, 1]"), "t.json: element 1: found number, expected true or false");
    EXPECT_EQ(error("{}"), "t.json: found object, expected a JSON array of booleans");
    EXPECT_EQ(error("[true"), "t.json: found no JSON at byte 6, expected a JSON array of booleans");
    EXPECT_NE(error("").find("found no JSON"), std::string::npos);
    EXPECT_NE(error("\x7f\xff garbage").find("found no JSON"), std::string::npos);
    EXPECT_NE(error("[1e999]").find("number out of range"), std::string::npos);
    EXPECT_EQ(error(std::string(1000000, '[')),
              "t.json: element 0: found array, expected true or false");
}

}  // namespace
