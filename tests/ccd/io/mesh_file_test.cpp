// The readers of meshes: what they read, bit for bit, and what they say about bad input.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <ccd/io/mesh_file.hpp>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/support/files.hpp"

namespace {

using namespace ccd;
using namespace ccd::io;
using test_files::message_of;
using test_files::temporary_directory;
using test_files::write;
namespace fs = std::filesystem;

std::uint64_t bits(double value) {
    return std::bit_cast<std::uint64_t>(value);
}

mesh some_mesh() {
    // All coordinates are floats, so that every form can hold them.
    return {{{0, 0.5, -0.0},
             {static_cast<double>(0.1F), 1, 0x1p-149},
             {-3, static_cast<double>(std::numeric_limits<float>::max()), 7},
             {1e10, 2, 3}},
            {{0, 1, 2}, {3, 2, 1}},
            {{3, 0}}};
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
            index_type + " " + list + "\nelement edge " + std::to_string(m.edges.size()) +
            "\nproperty " + index_type + " vertex1\nproperty " + index_type +
            " vertex2\nend_header\n";
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
    const auto append_indices = [&](const auto& element) {
        for (const ccd::vertex_index i : element) {
            if (ascii)
                text += ' ' + std::to_string(i);
            else
                append(text, static_cast<Index>(i), big);
        }
        if (ascii) text += '\n';
    };
    for (const face& f : m.faces) {
        text += ascii ? '3' : '\3';
        append_indices(f);
    }
    for (const edge& e : m.edges) append_indices(e);
    return text;
}

void expect_same(const mesh& a, const mesh& b) {
    EXPECT_EQ(a.faces, b.faces);
    EXPECT_EQ(a.edges, b.edges);
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

TEST(Ply, WrittenAsReadBack) {
    mesh frame = some_mesh();
    expect_same(parse_mesh_ply(ply_of(frame), "written"), frame);
    frame.vertices[0] = {-0.0, 0x1p-1074, 0x1.fffffffffffffp1023};
    frame.faces = {};
    frame.edges = {{2, 1}};
    expect_same(parse_mesh_ply(ply_of(frame), "written"), frame);
}

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

// A carriage return within a line whose end is a line feed: to others a blank, or an end of the
// line.
TEST(Ply, RefusesControlCharactersInTheHeader) {
    for (const char* name : {"fa\rce", "fa\vce", "fa\x7f"})
        EXPECT_EQ(
            ply_error(std::string("ply\nformat ascii 1.0\nelement ") + name + " 0\nend_header\n")
                .substr(0, 37),
            "m.ply:3: found a control character in");
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
              "m.ply:13: found a face with 4 vertices, expected a triangle (the option "
              "triangulate splits polygons)");
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

TEST(Ply, EdgesAlone) {
    const std::string text =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
        "property float z\nelement edge 2\nproperty float length\nproperty uint vertex2\n"
        "property uint vertex1\nend_header\n0 0 0\n1 0 0\n2 0 0\n1 1 0\n1 2 1\n";
    EXPECT_EQ(parse_mesh_ply(text, "m").edges, (std::vector<edge>{{0, 1}, {1, 2}}));
    const auto with = [&text](const std::string& from, const std::string& to) {
        std::string changed = text;
        return ply_error(changed.replace(changed.find(from), from.size(), to));
    };
    EXPECT_EQ(with("1 2 1\n", "1 3 1\n"),
              "m.ply: edge 1: found vertex index 3, expected less than 3");
    EXPECT_EQ(with("uint vertex2", "float vertex2"),
              "m.ply: found no property 'vertex2' of edge, expected integers vertex1 and vertex2");
    EXPECT_NE(with("1 2 1\n", "1 -2 1\n").find("expected an integer of the declared type"),
              std::string::npos);
}

TEST(Obj, Reads) {
    const mesh m = parse_mesh_obj(
        "# comment\r\nmtllib a.mtl\no thing\nv 0 0 0\nv 0.1\t1e-310 -2 1.0 # with w\n"
        "v 1 2 3 0.5 0.5 0.5\nvt 0 0\nvn 0 0 1\ns off\nf 1 2 3\nf 1/1 2/1 3/1\nf 1//1 3//1 2//1\n"
        "f -3/1/1 -2/-1/-1 -1/1/1\nv 5 5 5\nf -1 +1 2",
        "m");
    expect_same(m, {{{0, 0, 0}, {0.1, 1e-310, -2}, {1, 2, 3}, {5, 5, 5}},
                    {{0, 1, 2}, {0, 1, 2}, {0, 2, 1}, {0, 1, 2}, {3, 0, 1}}});
}

TEST(Obj, ContentOfOtherKinds) {
    EXPECT_EQ(obj_error(""), "m.obj: found an empty file, expected an OBJ mesh");
    EXPECT_EQ(obj_error("\x7f"
                        "ELF\1\2"),
              "m.obj:1: found a control character in '\\x7fELF\\x01\\x02', expected text");
}

const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
const mesh triangle_mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};

std::string with_line_ends(const std::string& text, const std::string& end) {
    std::string result;
    for (const char c : text) result += c == '\n' ? end : std::string(1, c);
    return result;
}

TEST(Obj, ByteOrderMarkHidTheFirstVertex) {
    expect_same(parse_mesh_obj("\xef\xbb\xbf" + triangle, "m"), triangle_mesh);
    // As where two files, each with a mark, are put together.
    EXPECT_EQ(
        obj_error("v 0 0 0\n\xef\xbb\xbf" + triangle),
        "m.obj:2: found the keyword '\\xef\\xbb\\xbfv', expected v, f, l or another of OBJ's");
    for (const char* mark : {"\xff\xfe", "\xfe\xff"})
        EXPECT_EQ(obj_error(mark + triangle),
                  "m.obj: found UTF-16 or UTF-32, expected ASCII or UTF-8");
    EXPECT_EQ(obj_error(std::string("v\0 \0\x30\0\n\0", 8)),
              "m.obj:1: found a control character in 'v\\x00 \\x000\\x00', expected text");
}

TEST(Obj, KeywordsThatWereIgnoredTookTheirLinesWithThem) {
    const auto error = [](const std::string& line) { return obj_error(triangle + line + "\n"); };
    for (const char* word : {"V", "F", "vv", "\xc2\xa0v", "t", "v,", "1", "face", "fn", "v:"})
        EXPECT_TRUE(error(std::string(word) + " 0 0 0").starts_with("m.obj:5: found the keyword '"))
            << word;
    for (const char* word : {"curv", "surf", "bzp", "bsp", "cdc", "cdp", "call", "csh"})
        EXPECT_EQ(error(std::string(word) + " 1 2 3"),
                  std::string("m.obj:5: found '") + word +
                      "', which a mesh cannot hold, expected triangles");
    for (const char* line :
         {"vt 0 0", "vn 0 0 1", "vp 0", "p 1", "g a b", "s off", "mg 0", "o", "bevel on", "lod 1",
          "usemtl a#b", "mtllib a b", "cstype bezier", "deg 3", "parm u 0 1", "end", " \t", ""})
        EXPECT_EQ(error(line), "no error") << line;
    expect_same(parse_mesh_obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nfo 1 2 3\n", "m"), triangle_mesh);
}

TEST(Obj, LinesThatEndInCarriageReturnsWereOneLine) {
    for (const char* end : {"\r", "\r\n", "\r\r\n", "\n\r"}) {
        expect_same(parse_mesh_obj(with_line_ends("# all of it\n" + triangle, end), "m"),
                    triangle_mesh);
        expect_same(parse_mesh_obj(with_line_ends("o one\n" + triangle, end), "m"), triangle_mesh);
    }
    for (const char* end : {"\f", "\v", "\x1a", "\x1c"})
        EXPECT_NE(obj_error(with_line_ends("o one\n" + triangle, end)).find("a control character"),
                  std::string::npos);
}

TEST(Obj, LinesJoinedByBackslashes) {
    expect_same(parse_mesh_obj("v 0 \\\n 0\\\r\n 0\nv 1 0 0\ng a \\\nv 5 5 5\nv 0 1 0\nf \\\n"
                               "\\\n1 2 \\\n3 # last\n",
                               "m"),
                triangle_mesh);
    EXPECT_EQ(obj_error("v 0 0 \\\n0\nv 1 0 0\nv 0 1 \\\nx\nf 1 2 3\n"),
              "m.obj:4: found 'x', expected a number");
    // "f 1 2 34" or "f 1 2 3 4", a comment of one line or of two: readers differ.
    EXPECT_EQ(obj_error("f 1 2 3\\\n4\n"),
              "m.obj:1: found a backslash that may split a word, expected a blank before it");
    EXPECT_EQ(obj_error(triangle + "f 1 2 3 \\"),
              "m.obj:5: found a backslash at the end of the file, expected a line after it");
    EXPECT_EQ(obj_error(triangle + "f 1 2 \\ \n3\n").substr(0, 16), "m.obj:5: found '");
}

TEST(Ply, HeadersWithMarksCarriageReturnsAndComments) {
    const mesh m = some_mesh();
    for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
        const std::string text = ply<double, std::int32_t>(m, format, "double", "int");
        const std::size_t body = text.find("end_header\n") + 11;
        std::string header = text.substr(0, body);
        header.replace(header.find("element"), 0, "comment element vertex 7\nobj_info \xff\n");
        for (const char* end : {"\n", "\r\n", "\r"})
            expect_same(parse_mesh_ply(
                            "\xef\xbb\xbf" + with_line_ends(header, end) + text.substr(body), "m"),
                        m);
    }
    EXPECT_EQ(ply_error("\xff\xfep"), "m.ply: found UTF-16 or UTF-32, expected ASCII or UTF-8");
    const std::string one = ascii_ply("3", "1", "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    expect_same(parse_mesh_ply(with_line_ends(one, "\r"), "m"), triangle_mesh);
}

TEST(Ply, BinaryBodyThatBeginsLikeALineEnd) {
    // 0x0a0d0a0a: the first bytes of x are LF and CR, which do not belong to the header.
    mesh m = triangle_mesh;
    m.vertices[0].x = std::bit_cast<float>(0x0a0d0a0aU);
    for (const char* end : {"\n", "\r\n", "\r"}) {
        const std::string text = ply<float, std::int32_t>(m, "binary_big_endian", "float", "int");
        const std::size_t body = text.find("end_header\n") + 11;
        expect_same(
            parse_mesh_ply(with_line_ends(text.substr(0, body), end) + text.substr(body), "m"), m);
    }
}

TEST(Ply, StripsOfTrianglesWereSkippedBesideFaces) {
    std::string text = ascii_ply("3", "1", "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n4 0 1 2 -1\n");
    text.replace(text.find("end_header"), 0,
                 "element tristrips 1\nproperty list int int vertex_indices\n");
    EXPECT_EQ(ply_error(text),
              "m.ply: found vertex indices in element 'tristrips', expected them in face or edge");
}

TEST(Ply, CountsOfMoreThan64Bits) {
    for (const char* count :
         {"18446744073709551616", "99999999999999999999999", "1e3", "3.0", "+3"}) {
        EXPECT_TRUE(ply_error(ascii_ply(count, "1", "")).ends_with("expected element NAME COUNT"));
        EXPECT_TRUE(ply_error(ascii_ply("3", count, "")).ends_with("expected element NAME COUNT"));
    }
    EXPECT_EQ(ply_error(ascii_ply("3", "18446744073709551615", "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")),
              "m.ply:14: found the end of the file, expected face 1 (truncated, or a wrong count)");
}

TEST(Meshes, Topology) {
    const mesh a = some_mesh();
    const auto error = [&](const mesh& b) {
        return message_of([&] { require_same_topology(a, "a.ply", b, "b.ply"); });
    };
    mesh b = a;
    b.vertices[0].x = 17;
    EXPECT_EQ(error(b), "no error");
    b.edges[0] = {0, 3};
    EXPECT_EQ(error(b), "b.ply: edge 0: found vertices 0 3, expected 3 0 as in a.ply");
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

mesh larger_mesh() {
    mesh m;
    for (int i = 0; i < 23; ++i) m.vertices.push_back({i * 0.25, i * 3.0, -i * 0.5});
    for (vertex_index i = 0; i + 2 < 23; ++i) m.faces.push_back({i + 2, i, i + 1});
    for (vertex_index i = 0; i < 5; ++i) m.edges.push_back({i, 22 - i});
    return m;
}

std::string obj(const mesh& m) {
    std::string text;
    for (const auto& p : m.vertices)
        text += "v " + std::to_string(p.x) + ' ' + std::to_string(p.y) + ' ' + std::to_string(p.z) +
                '\n';
    const auto elements = [&](const char* word, const auto& all) {
        for (const auto& element : all) {
            text += word;
            for (const vertex_index v : element) text += ' ' + std::to_string(v + 1);
            text += '\n';
        }
    };
    elements("f", m.faces);
    elements("l", m.edges);
    return text;
}

/// Shares, put together, are the file.
void expect_shared(const fs::path& path, const mesh& whole) {
    for (std::size_t shares = 1; shares < 30; ++shares) {
        mesh together;
        for (std::size_t i = 0; i < shares; ++i) {
            const mesh_share share = read_mesh_share(path, i, shares);
            EXPECT_EQ(share.vertices.first, together.vertices.size());
            EXPECT_EQ(share.faces.first, together.faces.size());
            EXPECT_EQ(share.edges.first, together.edges.size());
            EXPECT_EQ(share.vertices.all, whole.vertices.size());
            const auto append = [&](auto& all, const auto& more) {
                EXPECT_LE(more.size(), (whole.vertices.size() + shares - 1) / shares);
                all.insert(all.end(), more.begin(), more.end());
            };
            append(together.vertices, share.elements.vertices);
            append(together.faces, share.elements.faces);
            append(together.edges, share.elements.edges);
        }
        expect_same(together, whole);
    }
}

TEST(Shares, MakeTheWholeOfEveryForm) {
    const temporary_directory directory;
    const mesh m = larger_mesh();
    for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
        write(directory.path / "m.ply", ply<double, std::int32_t>(m, format, "double", "int"));
        expect_shared(directory.path / "m.ply", m);
    }
    write(directory.path / "m.obj", obj(m));
    expect_shared(directory.path / "m.obj", m);
    write(
        directory.path / "m.ply",
        ascii_header + "9 3 2 1 0 2 1.5 2.5\r\n0.5\r\n-7 2 1 1 0.1 0.5\r\n1 0 0 0\r\n2 0 0 0\r\n");
    expect_shared(directory.path / "m.ply", {{{-7, 0.1, 0.5}, {1, 0, 0}, {2, 0, 0}}, {{2, 1, 0}}});
}

TEST(Shares, BadFilesAreToldOfBySomeShare) {
    const temporary_directory directory;
    const fs::path path = directory.path / "m.ply";
    const auto first_error = [&](const std::string& text) {
        write(path, text);
        for (std::size_t i = 0; i < 3; ++i) {
            const std::string error = message_of([&] { read_mesh_share(path, i, 3); });
            if (error != "no error") return error.substr(path.string().size() + 2);
        }
        return std::string("no error");
    };
    const std::string good =
        ply<double, std::int32_t>(larger_mesh(), "binary_little_endian", "double", "int");
    EXPECT_EQ(first_error(good), "no error");
    EXPECT_EQ(first_error(""), "found an empty file, expected a PLY mesh");
    for (std::size_t size = 1; size < good.size(); size += 7)
        EXPECT_NE(first_error(good.substr(0, size)), "no error") << size;
    EXPECT_EQ(first_error(good + '0'),
              "found 1 bytes after the last element, expected the end of the file");
    std::string quad = good;
    quad[quad.size() - 5 * 8 - 13 * 10] = 4;  // the eleventh face's count
    EXPECT_EQ(first_error(quad),
              "face 11: found a face with 4 vertices, expected a triangle (the option "
              "triangulate splits polygons)");
    mesh beyond = larger_mesh();
    beyond.faces[20][1] = 23;
    EXPECT_EQ(first_error(ply<double, std::int32_t>(beyond, "ascii", "double", "int")),
              "face 20: found vertex index 23, expected less than 23");
    EXPECT_THROW(read_mesh_share(path, 3, 3), std::invalid_argument);
    if (fs::exists("/dev/null")) {  // not on Windows
        EXPECT_NE(
            message_of([&] { read_mesh_share("/dev/null", 0, 3); }).find("expected one, of which"),
            std::string::npos);
    }
    EXPECT_NE(message_of([&] { read_mesh_share(directory.path / "none", 0, 3); }).find("no such"),
              std::string::npos);
}

}  // namespace
