// The readers of stored queries: points from rows, ranges of files, messages for bad input.
#include <gtest/gtest.h>

#include <algorithm>
#include <ccd/io/query_file.hpp>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ccd/io/query_ranges.hpp"
#include "tests/ccd/io/content.hpp"
#include "tests/support/files.hpp"

namespace {

using namespace ccd;
using namespace ccd::io;
using test_files::message_of;
using test_files::repeated;
using test_files::temporary_directory;
using test_files::write;
using test_queries::content;
namespace fs = std::filesystem;

/// A text or a file, and a part of the message for it.
using bad_case = std::pair<std::string, std::string>;

void expect_message(const std::string& found, const std::string& part, const std::string& of) {
    EXPECT_NE(found.find(part), std::string::npos) << of << '\n' << found;
}

query_file queries(const std::string& text, bool round = false) {
    return parse_queries(text, "q.csv", kind::vertex_face, round);
}

const std::vector<vertex_face<double>>& vertex_faces(const query_file& file) {
    return std::get<std::vector<vertex_face<double>>>(file.queries);
}

TEST(Queries, RowsBecomePoints) {
    std::string text;
    for (int row = 0; row < 8; ++row) text += std::to_string(row) + ",2,1,1,0,1\n";
    const query_file vf = queries(text), ee = parse_queries(text, "q", kind::edge_edge, false);
    EXPECT_EQ(vf.kind(), kind::vertex_face);
    ASSERT_EQ(vf.size(), 1U);
    EXPECT_FALSE(vf.truth.has_value());
    const auto& q = vertex_faces(vf)[0];
    EXPECT_EQ(q.v, (moving_point<double>{{0, 1, 0}, {2, 1, 0}}));
    EXPECT_EQ(q.f0, (moving_point<double>{{0.5, 1, 0}, {2.5, 1, 0}}));
    EXPECT_EQ(q.f1, (moving_point<double>{{1, 1, 0}, {3, 1, 0}}));
    EXPECT_EQ(q.f2, (moving_point<double>{{1.5, 1, 0}, {3.5, 1, 0}}));
    const auto& edges = std::get<std::vector<edge_edge<double>>>(ee.queries);
    ASSERT_EQ(edges.size(), 1U);
    EXPECT_EQ(edges[0].a1, q.f0);
    EXPECT_EQ(edges[0].b1, q.f2);
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
    EXPECT_EQ(queries("\xef\xbb\xbf" + repeated("1,1,1,1,1,1\n", 8)).size(), 1U);
    EXPECT_EQ(queries(repeated("1,1,1,1,1,1\r", 16)).size(), 2U);
}

TEST(Queries, BadInput) {
    const std::string good = "1,1,1,1,1,1\n";
    std::string garbage;
    for (int i = 0; i < 4096; ++i) garbage += static_cast<char>(i * 37 + i / 256);
    const std::vector<bad_case> cases{
        {"", "q.csv: file is empty; expected rows of 6 integers"},
        {"\n\r\n", "q.csv: file is empty"},
        {"\xef\xbb\xbf", "q.csv: file is empty"},
        {"\xff\xfe" + good, "q.csv: encoding is UTF-16 or UTF-32; expected ASCII or UTF-8"},
        {repeated(good, 12),
         "q.csv:12: number of rows of the query from line 9 on is 4; expected 8 (truncated)"},
        {good + "1,1,1.5,1,1,1\n", "q.csv:2: numerator of y is '1.5'; expected an integer"},
        {"1,1,1,1,1,x\n", "q.csv:1: denominator of z is 'x'; expected an integer"},
        {"1,1,1,,1,1\n", "q.csv:1: denominator of y is ''; expected an integer"},
        {repeated(good, 7) + "1,1,1,0,1,1\n",
         "q.csv:8: y is '1'/'0'; expected a nonzero denominator"},
        {good + "1,3,1,1,1,1\n",
         "q.csv:2: x is '1'/'3', which no double equals; expected an exact double (or "
         "--round)"},
        {"1,1,1,1,1" + repeated("0", 400) + ",1\n",
         "...'/'1', which overflows; expected a finite number"},
        {"1,1,1,1," + repeated("1", 9999) + ",1\n",
         "...'/'1', which has too many digits; expected at most 4096"},
        {"0x" + repeated("1", 9999) + ",1,1\n", "which has too many digits; expected at most 4096"},
        {"0,NaN,0\n", "q.csv:1: y is 'NaN'; expected a finite number"},
        {"0,0,1e999\n", "q.csv:1: z is '1e999', which overflows; expected a finite number"},
        {"0,0,0x1p-2000\n",
         "q.csv:1: z is '0x1p-2000', which no double equals; expected an exact double (or "
         "--round)"},
        {"0,zero,0\n", "q.csv:1: y is 'zero'; expected a number"},
        {std::string("1,\0,1\n", 7), "q.csv:1: y is '\\x00'; expected a number"},
        {good + "1,1,1\n", "q.csv:2: number of columns is 3; expected 6 as in the first row"},
        {"1,2\n", "q.csv:1: line is '1,2' (columns: 2); expected 6 integers"},
        {good + "\n" + good, "q.csv:2: line is blank; expected a row"},
        {"1,1,1,1,1,1,2\n", "q.csv:1: truth is '2'; expected 0 or 1"},
        {"1,1,1,1,1,1,1\n1,1,1,1,1,1,0\n",
         "q.csv:2: truth is 0; expected 1 as in the first row of this query"},
        {garbage, "q.csv:1: line is '"}};
    for (const auto& [text, part] : cases) {
        const std::string message = message_of([&text = text] { queries(text); });
        expect_message(message, part, text);
        EXPECT_LT(message.size(), 300U);
    }
}

TEST(Queries, BadStore) {
    const auto no_store = [] {
        parse_stored_queries("\x89HDF\r\n\x1a\nnothing", "s.h5", std::nullopt, false);
    };
    expect_message(message_of(no_store), "s.h5: ", "with HDF5 or without");
}

TEST(Queries, KindFromPath) {
    for (const auto& [path, kind] : {std::pair("a/vertex-face/data.csv", "vf"),
                                     {"a/edge-edge/b/data.csv", "ee"},
                                     {"queries/227vf.csv", "vf"},
                                     {"vertex-face/227ee.csv", "ee"},
                                     {"ee/data.csv", "ee"},
                                     {"vf.csv", "vf"},
                                     {"coffee.csv", ""},
                                     {"not-edge-edges/data.csv", ""}}) {
        const auto found = kind_from_path(path);
        EXPECT_EQ(found ? short_name(*found) : "", kind) << path;
    }
}

TEST(Queries, Files) {
    const temporary_directory directory;
    const fs::path file = directory.path / "queries" / "7vf.csv";
    const fs::path truth = directory.path / "mma_bool" / "7vf_mma_bool.json";
    const auto read = [](const fs::path& path) { return read_queries(path, std::nullopt, false); };
    write(file, repeated("1,1,1,1,1,1\n", 16));
    EXPECT_FALSE(read(file).truth.has_value());
    EXPECT_EQ(read_queries(file, kind::edge_edge, false).kind(), kind::edge_edge);
    write(truth, "[true, false]");
    EXPECT_EQ(read(file).truth, (std::vector<bool>{true, false}));

    write(truth, "[true]");
    write(directory.path / "plain.csv", "1,1,1\n");
    fs::create_directory(directory.path / "folder-vf");
    for (const auto& [path, part] :
         {std::pair(file, "number of truth values is 1; expected 2, one for each query of"),
          {"/no/such/vf.csv", "/no/such/vf.csv: file does not exist"},
          {directory.path / "folder-vf", "path is a directory; expected a file"},
          {directory.path / "plain.csv", "path has no kind of query"}})
        expect_message(message_of([&, &path = path] { read(path); }), part, path.string());
}

TEST(Queries, Truth) {
    EXPECT_EQ(parse_truth("[true,false ,true]\n", "t"), (std::vector<bool>{true, false, true}));
    EXPECT_TRUE(parse_truth("[]", "t").empty());
    const std::vector<bad_case> cases{
        {"[true, 1]", "t.json: type of element 1 is number; expected true or false"},
        {"{}", "t.json: type is object; expected a JSON array of booleans"},
        {"[true", "t.json: text at byte 6 is not JSON; expected a JSON array of booleans"},
        {"", "is not JSON"},
        {"\x7f\xff garbage", "is not JSON"},
        {"[1e999]", "number is out of range"},
        {std::string(1000000, '['), "t.json: type of element 0 is array; expected true or false"}};
    for (const auto& [text, part] : cases)
        expect_message(message_of([&text = text] { parse_truth(text, "t.json"); }), part,
                       text.substr(0, 20));
}

/// Checks that the ranges of range_reader and of read_queries together are the whole file.
void expect_ranges(const fs::path& file, std::size_t size) {
    const query_file whole = read_queries(file, std::nullopt, false);
    range_reader reader(file, std::nullopt, false, size);
    content by_reader, by_file;
    std::size_t read = 0;
    while (const auto part = reader.next()) {
        EXPECT_EQ(part->size(), std::min(size, whole.size() - read));
        EXPECT_EQ(part->truth.has_value(), whole.truth.has_value());
        by_reader.add(*part);
        by_file.add(read_queries(file, std::nullopt, false, {read, size}));
        read += part->size();
    }
    EXPECT_EQ(read, whole.size());
    EXPECT_EQ(reader.share(), 1);
    EXPECT_EQ(by_reader, content(whole));
    EXPECT_EQ(by_file, content(whole));
    EXPECT_EQ(message_of([&] { read_queries(file, std::nullopt, false, {whole.size()}); }),
              file.string() + ": number of queries is " + std::to_string(whole.size()) +
                  "; expected more than the first " + std::to_string(whole.size()) +
                  ", which are skipped");
}

std::string rows(std::size_t queries, const std::string& end, const std::string& last_column) {
    std::string text;
    for (std::size_t i = 0; i < 8 * queries; ++i)
        text += std::to_string(i) + ", 0.5 ,-1" + last_column + end;
    return text;
}

TEST(QueryRanges, TogetherAreTheFile) {
    const temporary_directory directory;
    const fs::path file = directory.path / "queries" / "vf.csv";
    for (const std::string end : {"\n", "\r\n", "\r"})
        for (const std::string column : {"", ",1"})
            for (const std::string tail : {"", "\n", "\r\n \t\r\n\r\n"})
                for (const std::string head : {"", "\xEF\xBB\xBF"}) {
                    std::string text = head + rows(17, end, column);
                    text.resize(text.size() - end.size());
                    write(file, text + tail);
                    for (const std::size_t size : {1, 2, 5, 17, 100}) expect_ranges(file, size);
                }
    write(file, rows(5, "\n", ""));
    write(directory.path / "mma_bool" / "vf_mma_bool.json", "[true,false,false,true,true]");
    for (const std::size_t size : {1, 2, 5}) expect_ranges(file, size);
}

TEST(QueryRanges, ErrorsHaveLinesOfTheFile) {
    const temporary_directory directory;
    const fs::path file = directory.path / "q" / "vf.csv";
    const auto message = [&](std::size_t range) {
        range_reader reader(file, std::nullopt, false, 2);
        for (; range > 0; --range) (void)reader.next();
        return message_of([&] { (void)reader.next(); });
    };
    const std::string good = rows(4, "\n", "");
    const std::vector<bad_case> cases{
        {good + "1,2,x\n", "vf.csv:33: z is 'x'"},
        {good + "1,2,3,0\n", "vf.csv:33: number of columns is 4; expected 3"},
        {good + "1,2,3\n1,2,3\n", "vf.csv:34: number of rows of the query from line 33 on is 2"}};
    for (const auto& [text, part] : cases) {
        write(file, text);
        expect_message(message(2), part, text);
    }
    write(file, "\n \n");
    expect_message(message(0), "file is empty", "blank lines");
    expect_message(message_of([&] { range_reader(directory.path, std::nullopt, false, 1); }),
                   "path is not a regular file", "a folder");
    write(file, good);
    write(directory.path / "mma_bool" / "vf_mma_bool.json", "[true,true,true]");
    expect_message(message(1), "number of truth values is 3; expected 4", "last range");
    write(directory.path / "mma_bool" / "vf_mma_bool.json", "[true]");
    expect_message(message(0), "number of truth values is 1; expected at least 2", "first range");
}

}  // namespace
