// Ranges of stored queries: read one at a time, they are the file's queries.
#include "ccd/io/query_ranges.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <ccd/io/query_file.hpp>
#include <ccd/methods/transform.hpp>
#include <filesystem>
#include <iterator>
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

/// All that tells queries apart.
std::vector<double> numbers_of(const query_file& file) {
    std::vector<double> numbers;
    for (const auto& query : std::get<std::vector<vertex_face<double>>>(file.queries))
        for (const auto& p : points_of(query))
            for (const auto& x : {p.t0, p.t1}) numbers.insert(numbers.end(), {x.x, x.y, x.z});
    return numbers;
}

void expect_whole(const fs::path& file, std::size_t queries_of_a_range) {
    const query_file whole = read_queries(file, std::nullopt, false);
    const query_index index = index_queries(file, queries_of_a_range);
    EXPECT_EQ(index.ranges.size(), (whole.size() + queries_of_a_range - 1) / queries_of_a_range);
    range_reader reader(file, std::nullopt, false, index);
    std::vector<double> numbers;
    std::vector<bool> truth;
    for (std::size_t i = 0; i < index.ranges.size(); ++i) {
        const query_file part = reader.read(i);
        EXPECT_LE(part.size(), queries_of_a_range);
        EXPECT_EQ(part.truth.has_value(), whole.truth.has_value());
        std::ranges::copy(numbers_of(part), std::back_inserter(numbers));
        if (part.truth) truth.insert(truth.end(), part.truth->begin(), part.truth->end());
    }
    EXPECT_EQ(numbers, numbers_of(whole));
    EXPECT_EQ(truth, whole.truth.value_or(std::vector<bool>()));
}

/// read_queries of ranges that partition the file.
void expect_ranges(const fs::path& file, std::size_t size) {
    const query_file whole = read_queries(file, std::nullopt, false);
    std::vector<double> numbers;
    std::vector<bool> truth;
    for (std::size_t first = 0; first < whole.size(); first += size) {
        const query_file part = read_queries(file, std::nullopt, false, {first, size});
        EXPECT_EQ(part.size(), std::min(size, whole.size() - first));
        std::ranges::copy(numbers_of(part), std::back_inserter(numbers));
        if (part.truth) truth.insert(truth.end(), part.truth->begin(), part.truth->end());
    }
    EXPECT_EQ(numbers, numbers_of(whole));
    EXPECT_EQ(truth, whole.truth.value_or(std::vector<bool>()));
    EXPECT_EQ(message_of([&] { read_queries(file, std::nullopt, false, {whole.size()}); }),
              file.string() + ": found " + std::to_string(whole.size()) +
                  " queries, expected more than the first " + std::to_string(whole.size()) +
                  ", which are skipped");
}

std::string rows(std::size_t queries, const std::string& end, const std::string& last_column) {
    std::string text;
    for (std::size_t i = 0; i < 8 * queries; ++i)
        text += std::to_string(i) + ", 0.5 ,-1" + last_column + end;
    return text;
}

TEST(QueryRanges, AreTheFile) {
    const temporary_directory directory;
    const fs::path file = directory.path / "queries" / "vf.csv";
    for (const std::string end : {"\n", "\r\n", "\r"})
        for (const std::string column : {"", ",1"})
            for (const std::string tail : {"", "\n", "\r\n \t\r\n\r\n"})
                for (const std::string head : {"", "\xEF\xBB\xBF"}) {
                    std::string text = head + rows(17, end, column);
                    text.resize(text.size() - end.size());
                    write(file, text + tail);
                    for (const std::size_t size : {1, 2, 5, 17, 100}) expect_whole(file, size);
                    expect_ranges(file, 5);
                }
    write(file, rows(5, "\n", ""));
    write(directory.path / "mma_bool" / "vf_mma_bool.json", "[true,false,false,true,true]");
    for (const std::size_t size : {1, 2, 5}) {
        expect_whole(file, size);
        expect_ranges(file, size);
    }
}

TEST(QueryRanges, ErrorsNameTheFilesLines) {
    const temporary_directory directory;
    const fs::path file = directory.path / "vf.csv";
    const auto message = [&](const std::string& text, std::size_t range) {
        write(file, text);
        return message_of(
            [&] { range_reader(file, std::nullopt, false, index_queries(file, 2)).read(range); });
    };
    const std::string good = rows(4, "\n", "");
    EXPECT_NE(message(good + "1,2,x\n", 2).find("vf.csv:33: found 'x' as z"), std::string::npos);
    EXPECT_NE(message(good + "1,2,3,0\n", 2).find("vf.csv:33: found 4 columns, expected 3"),
              std::string::npos);
    EXPECT_NE(message(good + "1,2,3\n1,2,3\n", 2)
                  .find("vf.csv:34: found a truncated query, 2 rows from line 33 on"),
              std::string::npos);
    EXPECT_NE(message("\n \n", 0).find("found an empty file"), std::string::npos);
    EXPECT_NE(message_of([&] { index_queries(directory.path, 1); }).find("found no regular file"),
              std::string::npos);
    write(file, good);
    const query_index index = index_queries(file, 2);
    write(file, "");
    EXPECT_NE(message_of([&] {
                  range_reader(file, std::nullopt, false, index).read(1);
              }).find("cannot be read from byte"),
              std::string::npos);
    write(directory.path / "q" / "vf.csv", good);
    write(directory.path / "mma_bool" / "vf_mma_bool.json", "[true,true,true]");
    const auto read = [&](std::size_t range) {
        return message_of([&] {
            const fs::path path = directory.path / "q" / "vf.csv";
            range_reader(path, std::nullopt, false, index_queries(path, 2)).read(range);
        });
    };
    EXPECT_NE(read(1).find("found 3 truth values, expected 4"), std::string::npos);
    write(directory.path / "mma_bool" / "vf_mma_bool.json", "[true]");
    EXPECT_NE(read(0).find("found 1 truth values, expected at least 2"), std::string::npos);
}

}  // namespace
