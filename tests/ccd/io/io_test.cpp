// Tests of the readers and writers: what they read, bit for bit, and what they say about bad input.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <ccd/io/mesh_file.hpp>
#include <ccd/io/query_file.hpp>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <errbound/support/error.hpp>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "ccd/io/text.hpp"
#include "errbound/support/output_file.hpp"

namespace {

using namespace ccd;
using namespace ccd::io;
using namespace errbound::support;
namespace fs = std::filesystem;

/// A directory that goes away with the test.
class temporary_directory {
  public:
    temporary_directory() {
        const std::string name = std::string("errbound-") +
                                 ::testing::UnitTest::GetInstance()->current_test_info()->name() +
                                 "-" + std::to_string(getpid());
        path = fs::temp_directory_path() / name;
        fs::create_directories(path);
    }
    temporary_directory(const temporary_directory&) = delete;
    temporary_directory& operator=(const temporary_directory&) = delete;
    ~temporary_directory() { fs::remove_all(path); }

    fs::path path;
};

void write(const fs::path& path, const std::string& text) {
    fs::create_directories(path.parent_path());
    std::ofstream(path, std::ios::binary) << text;
}

/// The message of the file_error that `call` throws.
std::string message_of(const std::function<void()>& call) {
    try {
        call();
    } catch (const file_error& error) {
        return error.what();
    }
    return "no error";
}

std::string repeated(const std::string& text, int times) {
    std::string result;
    for (int i = 0; i < times; ++i) result += text;
    return result;
}

query_file queries(const std::string& text, bool round = false) {
    return parse_queries(text, "q.csv", kind::vertex_face, round);
}

const std::vector<vertex_face<double>>& vertex_faces(const query_file& file) {
    return std::get<std::vector<vertex_face<double>>>(file.queries);
}

std::string query_error(const std::string& text) {
    return message_of([&] { queries(text); });
}

std::uint64_t bits(double value) {
    return std::bit_cast<std::uint64_t>(value);
}

// Numbers

TEST(Numbers, QuotientsAreExact) {
    EXPECT_EQ(parse_quotient("3", "-4", false).value, -0.75);
    EXPECT_EQ(parse_quotient("-3", "-4", false).value, 0.75);
    EXPECT_EQ(parse_quotient("6", "3", false).value, 2);
    EXPECT_EQ(parse_quotient("0007", "02", false).value, 3.5);
    EXPECT_EQ(bits(parse_quotient("0", "-5", false).value), bits(0.0));
    EXPECT_EQ(parse_quotient("18446744073709551616", "36893488147419103232", false).value, 0.5);
    EXPECT_EQ(parse_quotient("-9223372036854775808", "1", false).value, -0x1p63);
    EXPECT_EQ(parse_quotient("1", "9223372036854775808", false).value, 0x1p-63);
}

TEST(Numbers, QuotientsReachTheEndsOfTheFormat) {
    // 2^1074 and the largest double, in decimal.
    std::string power = "1";
    for (int i = 0; i < 1074; ++i) {
        int carry = 0;
        for (auto digit = power.rbegin(); digit != power.rend(); ++digit) {
            const int doubled = 2 * (*digit - '0') + carry;
            *digit = static_cast<char>('0' + doubled % 10);
            carry = doubled / 10;
        }
        if (carry != 0) power.insert(power.begin(), '1');
    }
    EXPECT_EQ(parse_quotient("1", power, false).value, 0x1p-1074);
    EXPECT_EQ(parse_quotient("-3", power, false).value, -0x3p-1074);
    EXPECT_EQ(parse_quotient(power, power, false).value, 1);
    EXPECT_EQ(parse_quotient(power, "1", false).status, number_status::overflow);
    EXPECT_EQ(parse_quotient("1", power + "0", false).status, number_status::inexact);
    EXPECT_EQ(parse_quotient("1", power + "0", true).value, 0);
    EXPECT_EQ(parse_quotient("9", power + "0", true).value, 0x1p-1074);
    // Ties to even.
    EXPECT_EQ(parse_quotient("5", power + "0", true).value, 0);
    EXPECT_EQ(parse_quotient("15", power + "0", true).value, 0x2p-1074);
    EXPECT_EQ(parse_quotient("9007199254740993", "1", true).value, 9007199254740992.0);
    EXPECT_EQ(parse_quotient("9007199254740995", "1", true).value, 9007199254740996.0);
}

TEST(Numbers, RoundedQuotientsAgreeWithDecimals) {
    std::mt19937_64 random(7);
    for (int i = 0; i < 20000; ++i) {
        const std::string digits = std::to_string(random()) + std::to_string(random() % 1000);
        const int shift = static_cast<int>(random() % 345);
        const number quotient =
            parse_quotient(digits, std::string("1").append(repeated("0", shift)), true);
        const number decimal = parse_double(digits + "e-" + std::to_string(shift), false);
        ASSERT_EQ(quotient.status, number_status::ok);
        ASSERT_EQ(bits(quotient.value), bits(decimal.value)) << digits << "e-" << shift;
    }
}

TEST(Numbers, DoublesSurviveHexadecimalAndQuotient) {
    std::mt19937_64 random(8);
    for (int i = 0; i < 20000; ++i) {
        const double value = std::bit_cast<double>(random());
        if (!std::isfinite(value)) continue;
        char text[512];
        std::snprintf(text, sizeof text, "%a", value);
        ASSERT_EQ(bits(parse_double(text, false).value), bits(value)) << text;
        std::snprintf(text, sizeof text, "%.17g", value);
        ASSERT_EQ(bits(parse_double(text, false).value), bits(value)) << text;
        if (std::fabs(value) >= 0x1p52) {
            std::snprintf(text, sizeof text, "%.0f", value);
            ASSERT_EQ(bits(parse_quotient(text, "1", false).value), bits(value)) << text;
        }
    }
}

TEST(Numbers, Floats) {
    EXPECT_EQ(parse_double("1e-999", false).value, 0);
    EXPECT_EQ(parse_double("-1e999", false).status, number_status::overflow);
    EXPECT_EQ(parse_double("inf", false).status, number_status::not_finite);
    EXPECT_EQ(parse_double("-nan", false).status, number_status::not_finite);
    EXPECT_EQ(parse_double("+0.1", false).value, 0.1);
    EXPECT_TRUE(std::signbit(parse_double("-0", false).value));
    for (const char* bad :
         {"", "-", "+-1", "--1", "1x", "0x", "0xp1", "0x1p", "0x1q", "1 2", "e5"}) {
        EXPECT_EQ(parse_double(bad, false).status, number_status::malformed) << bad;
    }
    EXPECT_EQ(parse_double("0x1.8p3", false).value, 12);
    EXPECT_EQ(parse_double("-0X.8P+1", false).value, -1);
    EXPECT_EQ(parse_double("0x1p-1075", false).status, number_status::inexact);
    EXPECT_EQ(parse_double("0x1p-1075", true).value, 0);
    EXPECT_EQ(parse_double("0x1p-99999999999999", true).value, 0);
    EXPECT_EQ(parse_double("0x1p1024", true).status, number_status::overflow);
    EXPECT_EQ(parse_double("0x1.00000000000008p0", false).status, number_status::inexact);
    EXPECT_EQ(parse_double("0x1.00000000000008p0", true).value, 1);
    EXPECT_EQ(parse_float("0.1").value, static_cast<double>(0.1F));
    EXPECT_EQ(parse_float("1e39").status, number_status::overflow);
    EXPECT_EQ(parse_float("0x1p-149").value, 0x1p-149);
    EXPECT_EQ(parse_float("0x1p-150").status, number_status::inexact);
}

TEST(Numbers, ExcerptsAreShortAndPrintable) {
    EXPECT_EQ(excerpt("a b"), "'a b'");
    EXPECT_EQ(excerpt(std::string("\0\n\x80", 3)), "'\\x00\\x0a\\x80'");
    const std::string garbage = excerpt(std::string(1000, '\7'));
    EXPECT_LE(garbage.size(), 42U);
    EXPECT_TRUE(garbage.ends_with("...'"));
}

// Queries

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
    EXPECT_NE(error(std::string(1000000, '[')).find("found no JSON"), std::string::npos);
}

// Meshes

mesh some_mesh() {
    // All coordinates are floats, so that every form can hold them.
    return {{{0, 0.5, -0.0},
             {static_cast<double>(0.1F), 1, 0x1p-149},
             {-3, static_cast<double>(std::numeric_limits<float>::max()), 7},
             {1e10, 2, 3}},
            {{0, 1, 2}, {3, 2, 1}}};
}

template <class T>
void append(std::string& bytes, T value, bool big) {
    auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
    if (big != (std::endian::native == std::endian::big)) std::reverse(raw.begin(), raw.end());
    bytes.append(raw.data(), raw.size());
}

template <class Coordinate, class Index>
std::string ply(const mesh& m, const std::string& format, const std::string& coordinate_type,
                const std::string& index_type, const std::string& list = "vertex_indices") {
    const bool ascii = format == "ascii", big = format == "binary_big_endian";
    std::string text = "ply\nformat " + format + " 1.0\ncomment made by a test\nelement vertex " +
                       std::to_string(m.vertices.size());
    for (const char* axis : {"x", "y", "z"}) {
        text += "\nproperty " + coordinate_type + " " + axis;
    }
    text += "\nelement face " + std::to_string(m.faces.size()) + "\nproperty list uchar " +
            index_type + " " + list + "\nend_header\n";
    for (const point<double>& p : m.vertices) {
        for (const double value : {p.x, p.y, p.z}) {
            if (ascii) {
                char digits[64];
                std::snprintf(digits, sizeof digits, "%.17g ", value);
                text += digits;
            } else {
                append(text, static_cast<Coordinate>(value), big);
            }
        }
        if (ascii) text += '\n';
    }
    for (const face& f : m.faces) {
        text += ascii ? '3' : '\3';
        for (const ccd::index i : f) {
            if (ascii) {
                text += ' ' + std::to_string(i);
            } else {
                append(text, static_cast<Index>(i), big);
            }
        }
        if (ascii) text += '\n';
    }
    return text;
}

void expect_same(const mesh& a, const mesh& b) {
    EXPECT_EQ(a.faces, b.faces);
    ASSERT_EQ(a.vertices.size(), b.vertices.size());
    for (std::size_t i = 0; i < a.vertices.size(); ++i) {
        EXPECT_EQ(bits(a.vertices[i].x), bits(b.vertices[i].x)) << i;
        EXPECT_EQ(bits(a.vertices[i].y), bits(b.vertices[i].y)) << i;
        EXPECT_EQ(bits(a.vertices[i].z), bits(b.vertices[i].z)) << i;
    }
}

std::string ply_error(const std::string& text) {
    return message_of([&] { parse_mesh_ply(text, "m.ply"); });
}

std::string obj_error(const std::string& text) {
    return message_of([&] { parse_mesh_obj(text, "m.obj"); });
}

TEST(Ply, EveryFormGivesTheSameMeshBitForBit) {
    const mesh m = some_mesh();
    for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
        SCOPED_TRACE(format);
        expect_same(parse_mesh_ply(ply<float, std::int32_t>(m, format, "float", "int"), "m"), m);
        expect_same(parse_mesh_ply(ply<double, std::uint32_t>(m, format, "double", "uint"), "m"),
                    m);
        expect_same(
            parse_mesh_ply(ply<double, std::int8_t>(m, format, "float64", "char", "vertex_index"),
                           "m"),
            m);
        expect_same(parse_mesh_ply(ply<float, std::uint16_t>(m, format, "float32", "ushort"), "m"),
                    m);
    }
}

TEST(Ply, DoublesAreNotRoundedToFloats) {
    mesh m = some_mesh();
    m.vertices[0] = {0.1, 0x1p-1074, 0x1.fffffffffffffp1023};
    for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
        expect_same(parse_mesh_ply(ply<double, std::int32_t>(m, format, "double", "int"), "m"), m);
    }
}

const std::string ascii_header =
    "ply\r\nformat ascii 1.0\r\nobj_info none\r\nelement face 1\r\nproperty uchar colour\r\n"
    "property list uchar int vertex_indices\r\nproperty list int float extra\r\n"
    "element camera 1\r\nproperty double view\r\nelement vertex 3\r\nproperty short x\r\n"
    "property list uchar uchar more\r\nproperty double y\r\nproperty float z\r\n"
    "end_header\r\n";

TEST(Ply, UnknownElementsAndPropertiesAreSkipped) {
    expect_same(parse_mesh_ply(ascii_header + "9 3 2 1 0 2 1.5 2.5\r\n0.5\r\n-7 2 1 1 0.1 0.5\r\n"
                                              "1 0 0 0\r\n2 0 0 0\r\n\r\n",
                               "m"),
                {{{-7, 0.1, 0.5}, {1, 0, 0}, {2, 0, 0}}, {{2, 1, 0}}});
}

std::string ascii_ply(const std::string& vertices, const std::string& faces,
                      const std::string& body) {
    return "ply\nformat ascii 1.0\nelement vertex " + vertices +
           "\nproperty double x\nproperty double y\nproperty double z\nelement face " + faces +
           "\nproperty list uchar int vertex_indices\nend_header\n" + body;
}

TEST(Ply, BadInput) {
    const std::string three = "0 0 0\n1 0 0\n0 1 0\n";
    EXPECT_EQ(ply_error(ascii_ply("3", "1", three + "3 0 1 2\n")), "no error");
    EXPECT_EQ(ply_error(""), "m.ply: found an empty file, expected a PLY mesh");
    EXPECT_EQ(ply_error("\x7f"
                        "ELF\n"),
              "m.ply:1: found '\\x7fELF', expected 'ply'");
    EXPECT_EQ(ply_error("ply\nformat ascii 1.0\n"),
              "m.ply:3: found the end of the file in the header, expected end_header");
    // Wrong counts, ascii: too many and too few vertices, too many and too few faces.
    EXPECT_EQ(ply_error(ascii_ply("4", "1", three + "3 0 1 2\n")),
              "m.ply:13: found '2' after the last property, expected the end of the line");
    EXPECT_EQ(ply_error(ascii_ply("2", "1", three + "3 0 1 2\n")),
              "m.ply:12: found a face with 0 vertices, expected a triangle");
    EXPECT_EQ(ply_error(ascii_ply("3", "2", three + "3 0 1 2\n")),
              "m.ply:14: found the end of the file, expected face 1 (truncated, or a wrong count)");
    EXPECT_EQ(ply_error(ascii_ply("3", "1", three + "3 0 1 2\n3 0 1 2\n")),
              "m.ply:14: found '3 0 1 2' after the last element, expected the end of the file");
    EXPECT_EQ(ply_error(ascii_ply("18446744073709551615", "1", "")),
              "m.ply: found 18446744073709551615 vertices, expected fewer than 2^32");
    EXPECT_EQ(
        ply_error(ascii_ply("4000000000", "1", "")),
        "m.ply:10: found the end of the file, expected vertex 0 (truncated, or a wrong count)");
    EXPECT_EQ(ply_error(ascii_ply("-1", "1", "")),
              "m.ply:3: found 'element vertex -1', expected element NAME COUNT");
    // Faces.
    EXPECT_EQ(ply_error(ascii_ply("3", "1", three + "3 0 1 3\n")),
              "m.ply: face 0: found vertex index 3, expected less than 3");
    EXPECT_EQ(ply_error(ascii_ply("3", "1", three + "3 0 -1 2\n")),
              "m.ply:13: found vertex index -1, expected 0 or more");
    EXPECT_EQ(ply_error(ascii_ply("3", "1", three + "2 0 1\n")),
              "m.ply:13: found a face with 2 vertices, expected a triangle");
    EXPECT_EQ(ply_error(ascii_ply("3", "1", three + "4 0 1 2 0\n")),
              "m.ply:13: found a face with 4 vertices, expected a triangle");
    EXPECT_EQ(ply_error(ascii_ply("3", "1", three + "3 1 1 2\n")),
              "m.ply: face 0: found a repeated vertex (1 1 2), expected three different ones");
    EXPECT_EQ(ply_error(ascii_ply("3", "0", three)),
              "m.ply: found no faces, expected at least one");
    // Coordinates.
    EXPECT_EQ(ply_error(ascii_ply("1", "1", "0 nan 0\n")),
              "m.ply:10: found 'nan', expected a finite number");
    EXPECT_EQ(ply_error(ascii_ply("1", "1", "0 1e999 0\n")),
              "m.ply:10: found '1e999', which overflows, expected a finite number");
    EXPECT_EQ(ply_error(ascii_ply("1", "1", "0 zero 0\n")),
              "m.ply:10: found 'zero', expected a number");
    EXPECT_EQ(ply_error(ascii_ply("1", "1", "0 0\n")),
              "m.ply:10: found too few values, expected one per property");
    EXPECT_EQ(ply_error(ascii_header + "9 3 2 1 0 0\n0.5\n40000 0 0 0\n"),
              "m.ply:18: found '40000', expected an integer of the declared type");
}

TEST(Ply, BadHeaders) {
    const auto header = [](const std::string& lines) {
        return ply_error("ply\nformat ascii 1.0\n" + lines + "end_header\n");
    };
    EXPECT_EQ(ply_error("ply\nend_header\n"),
              "m.ply:2: found no format line before end_header, expected one");
    EXPECT_NE(ply_error("ply\nformat utf8 1.0\n").find("found 'format utf8 1.0'"),
              std::string::npos);
    EXPECT_NE(ply_error("ply\nformat ascii 2.0\n").find("expected version 1.0"), std::string::npos);
    EXPECT_NE(header("").find("found no element 'vertex'"), std::string::npos);
    EXPECT_NE(header("element vertex 1\nelement vertex 1\n").find("twice"), std::string::npos);
    EXPECT_NE(header("element vertex 1\n").find("found no properties in element 'vertex'"),
              std::string::npos);
    EXPECT_NE(header("property float x\n").find("before any element"), std::string::npos);
    EXPECT_NE(header("element a 1\nproperty quad x\n").find("found type 'quad'"),
              std::string::npos);
    EXPECT_NE(header("element a 1\nproperty list float int x\n").find("an integer type"),
              std::string::npos);
    EXPECT_NE(header("element vertex 0\nelement face 1\nproperty list uchar int vertex_index\n")
                  .find("found no property 'x' of vertex"),
              std::string::npos);
    EXPECT_NE(header("element vertex 0\nproperty int x\nproperty int y\nproperty int z\n"
                     "element face 1\nproperty list uchar float vertex_indices\n")
                  .find("found no list of vertex indices in face"),
              std::string::npos);
}

TEST(Ply, BadBinary) {
    const std::string good =
        ply<double, std::int32_t>(some_mesh(), "binary_little_endian", "double", "int");
    const std::size_t header = good.find("end_header\n") + 11;
    EXPECT_EQ(
        ply_error(good.substr(0, header + 30)),
        "m.ply: vertex 1: found the end of the file, expected more data (truncated, or a wrong "
        "count)");
    for (std::size_t size = 0; size < good.size(); ++size) {
        EXPECT_NE(ply_error(good.substr(0, size)), "no error") << size;
    }
    EXPECT_EQ(ply_error(good + "x"),
              "m.ply: found 1 bytes after the last element, expected the end of the file");
    mesh m = some_mesh();
    m.vertices[2].y = std::numeric_limits<double>::infinity();
    EXPECT_EQ(ply_error(ply<float, std::int32_t>(m, "binary_big_endian", "float", "int")),
              "m.ply: vertex 2: found an infinity as y, expected a finite number");
    m.vertices[2].y = std::nan("");
    EXPECT_EQ(ply_error(ply<double, std::int32_t>(m, "binary_big_endian", "double", "int")),
              "m.ply: vertex 2: found NaN as y, expected a finite number");
    // A list that claims 4 GiB.
    EXPECT_EQ(
        ply_error("ply\nformat binary_little_endian 1.0\nelement a 1\nproperty list uint "
                  "double b\nelement vertex 0\nproperty int x\nproperty int y\nproperty int z\n"
                  "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
                  "\xff\xff\xff\xff"),
        "m.ply: a 0: found the end of the file, expected more data (truncated, or a wrong "
        "count)");
}

TEST(Obj, Reads) {
    const mesh m = parse_mesh_obj(
        "# comment\r\nmtllib a.mtl\no thing\nv 0 0 0\nv 0.1\t1e-310 -2 1.0 # with w\n"
        "v 1 2 3 0.5 0.5 0.5\nvt 0 0\nvn 0 0 1\ns off\nf 1 2 3\nf 1/1 2/1 3/1\nf 1//1 3//1 2//1\n"
        "f -3/1/1 -2/-1/-1 -1/1/1\nv 5 5 5\nf -1 1 2",
        "m");
    expect_same(m, {{{0, 0, 0}, {0.1, 1e-310, -2}, {1, 2, 3}, {5, 5, 5}},
                    {{0, 1, 2}, {0, 1, 2}, {0, 2, 1}, {0, 1, 2}, {3, 0, 1}}});
}

TEST(Obj, BadInput) {
    const std::string three = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    EXPECT_EQ(obj_error(""), "m.obj: found an empty file, expected an OBJ mesh");
    EXPECT_EQ(obj_error("\x7f"
                        "ELF\1\2"),
              "m.obj: found no vertices, expected lines 'v x y z' and 'f i j k'");
    EXPECT_EQ(obj_error(three), "m.obj: found no faces, expected lines 'v x y z' and 'f i j k'");
    EXPECT_EQ(obj_error("v 0 0\n"), "m.obj:1: found 2 values of a vertex, expected 3 (x y z)");
    EXPECT_EQ(obj_error("v 0 0 0 2\n"), "m.obj:1: found a vertex with weight, expected none or 1");
    EXPECT_EQ(obj_error("v 0 nan 0\n"), "m.obj:1: found 'nan', expected a finite number");
    EXPECT_EQ(obj_error("v 0 -inf 0\n"), "m.obj:1: found '-inf', expected a finite number");
    EXPECT_EQ(obj_error("v 0 1,5 0\n"), "m.obj:1: found '1,5', expected a number");
    EXPECT_EQ(obj_error(three + "f 1 2\n"),
              "m.obj:4: found a face with 2 vertices, expected a triangle");
    EXPECT_EQ(obj_error(three + "f 1 2 3 1\n"),
              "m.obj:4: found a face with 4 vertices, expected a triangle");
    EXPECT_EQ(obj_error(three + "f 1 2 4\n"),
              "m.obj:4: face 0 (indices from 0): found vertex index 3, expected less than 3");
    EXPECT_EQ(obj_error(three + "f 1 2 2\n"),
              "m.obj:4: face 0 (indices from 0): found a repeated vertex (0 1 1), expected three "
              "different ones");
    for (const char* bad : {"0", "-4", "99999999999"}) {
        EXPECT_NE(obj_error(three + "f 1 2 " + bad + "\n"), "no error") << bad;
    }
    for (const char* bad : {"x", "1/", "1/x", "1//", "1/2/3/4", "/1", "1.5"}) {
        EXPECT_TRUE(obj_error(three + "f 1 2 " + bad + "\n").starts_with("m.obj:4: found '"))
            << bad;
    }
}

TEST(Meshes, Topology) {
    const mesh a = some_mesh();
    const auto error = [&](const mesh& b) {
        return message_of([&] { require_same_topology(a, "a.ply", b, "b.ply"); });
    };
    mesh b = a;
    b.vertices[0].x = 17;
    EXPECT_EQ(error(b), "no error");
    b.faces[1] = {3, 1, 2};
    EXPECT_EQ(error(b), "b.ply: face 1: found vertices 3 1 2, expected 3 2 1 as in a.ply");
    b.faces.pop_back();
    EXPECT_EQ(error(b), "b.ply: found 1 faces, expected 2 as in a.ply");
    b.vertices.emplace_back();
    EXPECT_EQ(error(b), "b.ply: found 5 vertices, expected 4 as in a.ply");
}

TEST(Meshes, Files) {
    const temporary_directory directory;
    const std::string text = ply<float, std::int32_t>(some_mesh(), "ascii", "float", "int");
    write(directory.path / "m.PLY", text);
    expect_same(read_mesh(directory.path / "m.PLY"), some_mesh());
    write(directory.path / "m.stl", text);
    EXPECT_TRUE(message_of([&] {
                    read_mesh(directory.path / "m.stl");
                }).ends_with("found extension '.stl', expected .ply or .obj"));
    EXPECT_NE(message_of([&] { read_mesh(directory.path / "none.ply"); }).find("no such file"),
              std::string::npos);
    fs::create_directory(directory.path / "d.ply");
    EXPECT_NE(message_of([&] { read_mesh(directory.path / "d.ply"); }).find("found a directory"),
              std::string::npos);
}

// Output

TEST(Output, WholeOrNotAtAll) {
    const temporary_directory directory;
    const fs::path file = directory.path / "out";
    write_whole(file, "one");
    write_whole(file, "two\n");
    EXPECT_EQ(read_whole(file), "two\n");
    EXPECT_NE(message_of([&] { write_whole(directory.path, "x"); }).find("found a directory"),
              std::string::npos);
    EXPECT_NE(message_of([&] {
                  write_whole(directory.path / "no" / "out", "x");
              }).find("cannot be written"),
              std::string::npos);
    EXPECT_NE(message_of([&] { write_whole("", "x"); }).find("no file name"), std::string::npos);
    // Nothing but the file itself is left.
    EXPECT_EQ(std::distance(fs::directory_iterator(directory.path), fs::directory_iterator{}), 1);
}

TEST(Output, LinksAndDevicesStayWhatTheyAre) {
    const temporary_directory directory;
    const fs::path file = directory.path / "out", link = directory.path / "link";
    write_whole(file, "one");
    fs::create_symlink("out", link);
    write_whole(link, "two");
    EXPECT_TRUE(fs::is_symlink(link));
    EXPECT_EQ(read_whole(file), "two");
    write_whole("/dev/null", "x");
    EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

}  // namespace
