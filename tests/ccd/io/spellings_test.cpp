// More than 200 spellings of OBJ and PLY: the mesh that each one is, or the message that refuses
// it. Every mesh read is written as PLY and read again.
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <ccd/io/mesh_file.hpp>
#include <charconv>
#include <cstdint>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "tests/support/files.hpp"

namespace {

using namespace ccd;
using namespace ccd::io;

/// A text, and its meaning: vertices, then faces and edges by index; or "!" and part of a message.
struct spelling {
    const char* text;
    const char* meaning;
};

std::string described(const mesh& m) {
    std::string text;
    const auto add = [&](char element, const auto& numbers) {
        text += text.empty() ? "" : " ";
        text += element;
        for (const auto number : numbers) {
            std::array<char, 32> digits;
            text += ' ';
            text.append(digits.data(), std::to_chars(digits.begin(), digits.end(), number).ptr);
        }
    };
    for (const point<double>& p : m.vertices) add('v', std::array{p.x, p.y, p.z});
    for (const face& f : m.faces) add('f', f);
    for (const edge& e : m.edges) add('e', e);
    return text;
}

template <class Parse>
void expect_meaning(const Parse& parse, const std::string& text, std::string expected) {
    std::string found;
    const std::string message = test_files::message_of([&] {
        const mesh m = parse(text);
        found = described(m);
        EXPECT_EQ(described(parse_mesh_ply(ply_of(m), "again")), found);
    });
    if (expected.starts_with('!'))
        EXPECT_NE(message.find(expected.substr(1)), std::string::npos) << text << '\n' << message;
    else
        EXPECT_EQ(message == "no error" ? found : message, expected) << text;
}

const auto obj = [](const std::string& text) { return parse_mesh_obj(text, "m.obj"); };
const auto split_obj = [](const std::string& text) {
    return parse_mesh_obj(text, "m.obj", {.triangulate = true});
};

/// One vertex.
constexpr std::array of_vertices{
    spelling{"v 1 2 3", "v 1 2 3"},
    spelling{"v 1 2 3\n", "v 1 2 3"},
    spelling{"v 1 2 3\r", "v 1 2 3"},
    spelling{"v 1 2 3\r\n", "v 1 2 3"},
    spelling{"v\t1\t2\t3", "v 1 2 3"},
    spelling{"  v   1 2  3  ", "v 1 2 3"},
    spelling{"v +1 -2 +.5", "v 1 -2 0.5"},
    spelling{"v 1. 2.0 03", "v 1 2 3"},
    spelling{"v 1e0 2E+0 30e-1", "v 1 2 3"},
    spelling{"v 0x1p0 0X2 0x1.8p1", "v 1 2 3"},
    spelling{"v -0 0 -0.0", "v -0 0 -0"},
    spelling{"v 0.1 1e-310 4.9e-324", "v 0.1 1e-310 5e-324"},
    spelling{"v 1.7976931348623157e308 1e-999 0", "v 1.7976931348623157e+308 0 0"},
    spelling{"v 0.1000000000000000055511151231257827 0 0", "v 0.1 0 0"},
    spelling{"v 1 2 3 1", "v 1 2 3"},
    spelling{"v 1 2 3 1.0", "v 1 2 3"},
    spelling{"v 1 2 3 .5 .25 1", "v 1 2 3"},
    spelling{"v 1 2 3 255 0 0", "v 1 2 3"},
    spelling{"v 1 2 3 .5 .25 1 1", "v 1 2 3"},
    spelling{"v 1 2 3 .5 .25 1 0", "v 1 2 3"},
    spelling{"v 1 2 3 # red", "v 1 2 3"},
    spelling{"v 1 2 3 #red", "v 1 2 3"},
    spelling{"v 1 2 3\t#", "v 1 2 3"},
    spelling{"# v 4 5 6\nv 1 2 3", "v 1 2 3"},
    spelling{"#\nv 1 2 3", "v 1 2 3"},
    spelling{"# C:\\\nv 1 2 3", "v 1 2 3"},
    spelling{"v 1 2 3 # C:\\\n# C:\\meshes\\", "v 1 2 3"},
    spelling{"#\x01\xff\nv 1 2 3", "v 1 2 3"},
    spelling{"v 1 \\\n2 \\\r\n 3", "v 1 2 3"},
    spelling{"v 1 2 \\\n3 # all \\\n# of it", "v 1 2 3"},
    spelling{"\\\nv 1 2 3", "v 1 2 3"},
    spelling{"\n\n  \n\t\nv 1 2 3\n\n", "v 1 2 3"},
    spelling{"\xef\xbb\xbfv 1 2 3", "v 1 2 3"},
    spelling{"v 1 2 3\x1a", "v 1 2 3"},
    spelling{"v 1 2 3\n\x1a", "v 1 2 3"},
    spelling{"v 1 2 3\r\n\x1a\x1a\r\n", "v 1 2 3"},
    spelling{"o a#b\ng a # b\nusemtl a#1\nv 1 2 3", "v 1 2 3"},
    spelling{"vt 0 0\nvn 0 0 1\nvp 0\ns off\nmtllib a.mtl\nv 1 2 3", "v 1 2 3"},
    spelling{"v 1 2 3\nv 1 2 3", "v 1 2 3 v 1 2 3"},
    spelling{"v -1.#IND 0 0", "!m.obj:1: found '-1.#IND', expected a finite number"},
    spelling{"v 0 1.#INF 0", "!m.obj:1: found '1.#INF', expected a finite number"},
    spelling{"v 0 0 +1.#QNAN0", "!found '+1.#QNAN0', expected a finite number"},
    spelling{"v 0 0 1.#SNAN", "!found '1.#SNAN', expected a finite number"},
    spelling{"v 0 0 1.#J", "!found '1.#J', expected a finite number"},
    spelling{"v 0 0 -nan(ind)", "!found '-nan(ind)', expected a finite number"},
    spelling{"v 0 0 nan(snan)", "!found 'nan(snan)', expected a finite number"},
    spelling{"v 0 nan 0", "!found 'nan', expected a finite number"},
    spelling{"v NaN 0 0", "!found 'NaN', expected a finite number"},
    spelling{"v 0 -inf 0", "!found '-inf', expected a finite number"},
    spelling{"v 0 Infinity 0", "!found 'Infinity', expected a finite number"},
    spelling{"v 0 0 1e999", "!found '1e999', which overflows, expected a finite number"},
    spelling{"v 0 0 0x1p1024", "!found '0x1p1024', which overflows"},
    spelling{"v 1 2 3#red", "!found '3#red', expected a number"},
    spelling{"v 1 2#3 4", "!found '2#3', expected a number"},
    spelling{"v 1 2 # 3", "!found 2 values of a vertex, expected 3 (x y z)"},
    spelling{"v", "!found 0 values of a vertex"},
    spelling{"v 1 2 3 4 5", "!found 5 values of a vertex"},
    spelling{"v 1 2 3 0.5", "!found a vertex with weight, expected none or 1"},
    spelling{"v 1 2 3 4 5 6 7 8", "!found more than 7 values of a vertex"},
    spelling{"v 1 2 3 0 0 nan", "!found 'nan', expected a finite number"},
    spelling{"v 1,5 2 3", "!found '1,5', expected a number"},
    spelling{"v 1 2 3f", "!found '3f', expected a number"},
    spelling{"v 1 2 1e", "!found '1e', expected a number"},
    spelling{"v 1 2 0x", "!found '0x', expected a number"},
    spelling{"v 1 2 --3", "!found '--3', expected a number"},
    spelling{"v 1 2 \\\n3\\\n4", "!a backslash that may split a word"},
    spelling{"v 1 2 3 \\", "!a backslash at the end of the file"},
    spelling{"v 1 2 3\n\x1av 1 2 3", "!found a control character in '\\x1av 1 2 3'"},
    spelling{"v 1 2 3\x1a\nv 1 2 3", "!found a control character in 'v 1 2 3\\x1a'"},
    spelling{"v 1 2 3\f", "!found a control character"},
    spelling{"V 1 2 3", "!found the keyword 'V'"},
    spelling{"v#1 2 3", "!found the keyword 'v#1'"},
    spelling{"o nothing\n", "!m.obj: found no vertices, expected lines 'v x y z'"},
    spelling{"", "!m.obj: found an empty file"},
    spelling{"\x1a", "!m.obj: found no vertices"},
    spelling{"\xff\xfev", "!found UTF-16 or UTF-32"},
};

/// Elements of five vertices.
constexpr std::array of_elements{
    spelling{"", ""},
    spelling{"f 1 2 3", "f 0 1 2"},
    spelling{"f\t1  2\t3 ", "f 0 1 2"},
    spelling{"f 3 1 2", "f 2 0 1"},
    spelling{"f +1 +2 03", "f 0 1 2"},
    spelling{"f -5 -4 -3", "f 0 1 2"},
    spelling{"f 1 -1 3", "f 0 4 2"},
    spelling{"f 1/1 2/2 3/3", "f 0 1 2"},
    spelling{"f 1/1/1 2/2/2 3/3/3", "f 0 1 2"},
    spelling{"f 1//1 2//2 3//3", "f 0 1 2"},
    spelling{"f 1/1/ 2/2/ 3/3/", "f 0 1 2"},
    spelling{"f 1/ 2/ 3/", "f 0 1 2"},
    spelling{"f 1// 2// 3//", "f 0 1 2"},
    spelling{"f 1 2/ 3/7/", "f 0 1 2"},
    spelling{"f 1/-1/-1 2/9 3//99", "f 0 1 2"},
    spelling{"f 4 4 5", "f 3 3 4"},
    spelling{"f 4 5 4", "f 3 4 3"},
    spelling{"f 5 4 4", "f 4 3 3"},
    spelling{"f 4 4 4", "f 3 3 3"},
    spelling{"f 1 2 3\nf 1 2 3\nf 3 2 1", "f 0 1 2 f 0 1 2 f 2 1 0"},
    spelling{"fo 1 2 3", "f 0 1 2"},
    spelling{"f 1 2 \\\n3", "f 0 1 2"},
    spelling{"f 1 2 3 # 4", "f 0 1 2"},
    spelling{"f 1 2 3 #4 \\\nf 1 2 4", "f 0 1 2 f 0 1 3"},
    spelling{"l 1 2", "e 0 1"},
    spelling{"l 2 1", "e 1 0"},
    spelling{"l 1 2 3 1", "e 0 1 e 1 2 e 2 0"},
    spelling{"l 1/1 2/2", "e 0 1"},
    spelling{"l 1/ 2/", "e 0 1"},
    spelling{"l 1 1", "e 0 0"},
    spelling{"l 1 1 2", "e 0 0 e 0 1"},
    spelling{"l -1 -2", "e 4 3"},
    spelling{"l 1 2\nl 1 2", "e 0 1 e 0 1"},
    spelling{"f 1 2 3\nl 4 5", "f 0 1 2 e 3 4"},
    spelling{"l 4 5\nf 1 2 3", "f 0 1 2 e 3 4"},
    spelling{"p 1", "e 0 0"},
    spelling{"p 1 3 5", "e 0 0 e 2 2 e 4 4"},
    spelling{"p -1", "e 4 4"},
    spelling{"p 1/ 1", "e 0 0"},
    spelling{"f 1 2 3\np 1 2 4", "f 0 1 2 e 3 3"},
    spelling{"p 4 1\nf 1 2 3", "f 0 1 2 e 3 3"},
    spelling{"l 1 2\np 2", "e 0 1"},
    spelling{"f 1 2 3\ng a\no b\ns 1\nf 1 2 4", "f 0 1 2 f 0 1 3"},
    spelling{"f 1 2 3\x1a", "f 0 1 2"},
    spelling{"f 1 2", "!m.obj:6: found a face with 2 vertices, expected a triangle"},
    spelling{"f", "!found a face with 0 vertices, expected a triangle"},
    spelling{"f # 1 2 3", "!found a face with 0 vertices"},
    spelling{"f 1 2 3 4",
             "!found a face with 4 vertices, expected a triangle (the option triangulate"},
    spelling{"f 1 2 3 4 5", "!found a face with 5 vertices, expected a triangle"},
    spelling{"f 1 2 3#4", "!found '3#4', expected v, v/vt, v//vn or v/vt/vn"},
    spelling{"f 1 2 0", "!found vertex index 0, expected 1 or more"},
    spelling{"f 1 2 6", "!m.obj:6: face 0 (indices from 0): found vertex index 5, expected less"},
    spelling{"f 1 2 -6", "!found vertex index -6"},
    spelling{"f 1 2 4294967296", "!found vertex index 4294967296"},
    spelling{"f 1 2 99999999999999999999", "!found '99999999999999999999'"},
    spelling{"f 1 2 3.0", "!found '3.0', expected v,"},
    spelling{"f 1 2 x", "!found 'x', expected v,"},
    spelling{"f 1 2 /3", "!found '/3', expected v,"},
    spelling{"f 1 2 //", "!found '//', expected v,"},
    spelling{"f 1/0 2 3", "!found '1/0', expected v,"},
    spelling{"f 1//0 2 3", "!found '1//0', expected v,"},
    spelling{"f 1/x 2 3", "!found '1/x', expected v,"},
    spelling{"f 1/1/1/1 2 3", "!found '1/1/1/1', expected at most v/vt/vn"},
    spelling{"f 1/// 2 3", "!found '1///', expected at most v/vt/vn"},
    spelling{"f ++1 2 3", "!found '++1', expected v,"},
    spelling{"f 1,2,3", "!found '1,2,3', expected v,"},
    spelling{"l 1", "!found 1 as the number of a line's vertices, expected 2 or more"},
    spelling{"l 1 6", "!edge 0 (indices from 0): found vertex index 5, expected less than 5"},
    spelling{"p", "!found a point element without vertices"},
    spelling{"p 6", "!m.obj:6: point 0 (indices from 0): found vertex index 5"},
    spelling{"p x", "!found 'x', expected v,"},
    spelling{"F 1 2 3", "!found the keyword 'F'"},
    spelling{"face 1 2 3", "!found the keyword 'face'"},
    spelling{"surf 0 1 0 1 1 2 3 4", "!found 'surf', which a mesh cannot hold"},
};

/// Elements of five vertices, polygons split.
constexpr std::array of_polygons{
    spelling{"f 1 2 3", "f 0 1 2"},
    spelling{"f 1 2 3 4", "f 0 1 2 f 0 2 3"},
    spelling{"f 2 3 4 1", "f 1 2 3 f 1 3 0"},
    spelling{"f 1 2 3 4 5", "f 0 1 2 f 0 2 3 f 0 3 4"},
    spelling{"f 1/1/ 2/2/ 3/3/ 4/4/", "f 0 1 2 f 0 2 3"},
    spelling{"f -5 -4 -3 -2", "f 0 1 2 f 0 2 3"},
    spelling{"f 1 2 2 3", "f 0 1 1 f 0 1 2"},
    spelling{"f 1 2 1 2 1", "f 0 1 0 f 0 0 1 f 0 1 0"},
    spelling{"f 1 2 3\nf 1 2 3 4\nl 4 5", "f 0 1 2 f 0 1 2 f 0 2 3 e 3 4"},
    spelling{"f 1 2", "!found a face with 2 vertices, expected a triangle"},
    spelling{"f 1 2 3 6", "!m.obj:6: triangle 1 (indices from 0): found vertex index 5"},
};

const std::string five = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 5 5 5\n";
const std::string described_five = "v 0 0 0 v 1 0 0 v 0 1 0 v 0 0 1 v 5 5 5";

std::string with_five(const char* meaning) {
    if (*meaning == '!') return meaning;
    return described_five + (*meaning == '\0' ? "" : " ") + meaning;
}

TEST(Spellings, Obj) {
    for (const auto& [text, meaning] : of_vertices) expect_meaning(obj, text, meaning);
    for (const auto& [text, meaning] : of_elements)
        expect_meaning(obj, five + text, with_five(meaning));
    for (const auto& [text, meaning] : of_polygons)
        expect_meaning(split_obj, five + text, with_five(meaning));
}

constexpr std::string_view ply_vertices =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\n"
    "property double z\n";

/// What follows the header's lines above; '@' stands for the three vertices' lines.
constexpr std::array of_ply{
    spelling{"end_header\n@", ""},
    spelling{"end_header\n@\n\n", ""},
    spelling{"end_header\n@\x1a", ""},
    spelling{"end_header\n@\n\x1a\r\n", ""},
    spelling{"element face 0\nend_header\n@", ""},
    spelling{"element face 0\nproperty list uchar int vertex_indices\nend_header\n@", ""},
    spelling{"element edge 0\nend_header\n@", ""},
    spelling{"element face 0\nelement edge 0\nend_header\n@", ""},
    spelling{"comment C:\\\nobj_info # \x01\nend_header\n@", ""},
    spelling{"element face 1\nproperty list uchar int vertex_indices\nend_header\n@3 0 1 2",
             "f 0 1 2"},
    spelling{"element face 1\nproperty list uint8 uint32 vertex_index\nend_header\n@3 0 1 2\n",
             "f 0 1 2"},
    spelling{"element face 1\nproperty list int char vertex_index\nend_header\n@+3 0 01 2.0\n",
             "f 0 1 2"},
    spelling{"element face 1\nproperty list uchar int vertex_indices\nend_header\n@3 1 1 2",
             "f 1 1 2"},
    spelling{"element face 1\nproperty list uchar int vertex_indices\nend_header\n@3 2 2 2",
             "f 2 2 2"},
    spelling{
        "element face 2\nproperty list uchar int vertex_indices\nend_header\n@3 0 1 2\n3 0 1 2",
        "f 0 1 2 f 0 1 2"},
    spelling{"element face 1\nproperty uchar red\nproperty list uchar int vertex_indices\n"
             "end_header\n@7 3 0 1 2",
             "f 0 1 2"},
    spelling{"element edge 1\nproperty int vertex1\nproperty int vertex2\nend_header\n@0 1",
             "e 0 1"},
    spelling{"element edge 1\nproperty uchar vertex2\nproperty uint vertex1\nend_header\n@0 1",
             "e 1 0"},
    spelling{"element edge 1\nproperty int vertex1\nproperty int vertex2\nend_header\n@1 1",
             "e 1 1"},
    spelling{"element face 1\nproperty list uchar int vertex_indices\nelement edge 1\n"
             "property int vertex1\nproperty int vertex2\nend_header\n@3 0 1 2\n2 2",
             "f 0 1 2 e 2 2"},
    spelling{"element camera 1\nproperty float view\nend_header\n@nan", ""},
    spelling{
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n@4 0 1 2 0",
        "!m.ply:13: found a face with 4 vertices, expected a triangle (the option triangulate"},
    spelling{"element face 1\nproperty list uchar int vertex_indices\nend_header\n@2 0 1",
             "!found a face with 2 vertices, expected a triangle"},
    spelling{"element face 1\nproperty list uchar int vertex_indices\nend_header\n@3 0 1 3",
             "!face 0: found vertex index 3, expected less than 3"},
    spelling{"element face 1\nproperty list uchar int vertex_indices\nend_header\n@3 0 -1 2",
             "!found vertex index -1, expected 0 or more"},
    spelling{"element face 1\nproperty list uchar int vertex_indices\nend_header\n@3 0 1 1.#INF",
             "!found '1.#INF', expected an integer of the declared type"},
    spelling{"element face 1\nproperty list uchar int corners\nend_header\n@3 0 1 2",
             "!found no list of vertex indices in face"},
    spelling{"element face 1\nproperty list uchar int vertex_indices\nend_header\n@3 0 1 2 # all",
             "!found '# all' after the last property"},
    spelling{"element edge 1\nproperty int vertex1\nend_header\n@0",
             "!found no property 'vertex2'"},
    spelling{"element edge 1\nproperty int vertex1\nproperty int vertex2\nend_header\n@0 3",
             "!edge 0: found vertex index 3, expected less than 3"},
    spelling{"element tristrips 1\nproperty list int int vertex_indices\nend_header\n@3 0 1 2",
             "!found vertex indices in element 'tristrips'"},
    spelling{"end_header\n0 0 0\n", "!found the end of the file, expected vertex 1"},
    spelling{"end_header\n@0 0 0\n", "!after the last element, expected the end of the file"},
    spelling{"end_header\n@\x1a\x01", "!after the last element, expected the end of the file"},
    spelling{"end_header\n0 0 -1.#IND\n", "!m.ply:8: found '-1.#IND', expected a finite number"},
    spelling{"end_header\n0 nan(ind) 0\n", "!found 'nan(ind)', expected a finite number"},
    spelling{"end_header\n0 inf 0\n", "!found 'inf', expected a finite number"},
    spelling{"end_header\n0 0\n", "!found too few values, expected one per property"},
    spelling{"# no comment\nend_header\n@", "!found '# no comment', expected format, element,"},
};

/// The last face of three vertices, split.
constexpr std::array of_ply_polygons{
    spelling{"3 0 1 2", "f 0 1 2"},
    spelling{"4 0 1 2 0", "f 0 1 2 f 0 2 0"},
    spelling{"5 0 1 2 1 2", "f 0 1 2 f 0 2 1 f 0 1 2"},
    spelling{"4 0 1 2 3", "!triangle 1: found vertex index 3, expected less than 3"},
    spelling{"2 0 1", "!found a face with 2 vertices"},
};

static_assert(of_vertices.size() + of_elements.size() + of_polygons.size() + of_ply.size() +
                  of_ply_polygons.size() >=
              200);

TEST(Spellings, Ply) {
    const std::string described_three = "v 0 0 0 v 1 0 0 v 0 1 0";
    const auto expect = [&](const mesh_options& options, std::string text, const char* meaning) {
        if (const auto at = text.find('@'); at != std::string::npos)
            text.replace(at, 1, "0 0 0\n1 0 0\n0 1 0\n");
        expect_meaning(
            [&](const std::string& all) { return parse_mesh_ply(all, "m.ply", options); },
            std::string(ply_vertices) + text,
            *meaning == '!' ? meaning : described_three + (*meaning == '\0' ? "" : " ") + meaning);
    };
    for (const auto& [text, meaning] : of_ply) expect({}, text, meaning);
    const std::string faces =
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n@";
    for (const auto& [text, meaning] : of_ply_polygons)
        expect({.triangulate = true}, faces + text, meaning);
}

std::string obj_of(const mesh& m) {
    std::string text;
    for (const point<double>& p : m.vertices) {
        std::array<char, 128> line;
        std::snprintf(line.data(), line.size(), "v %a %.17g %a\n", p.x, p.y, p.z);
        text += line.data();
    }
    const auto add = [&text](const char* keyword, const auto& elements) {
        for (const auto& e : elements) {
            text += keyword;
            for (const vertex_index i : e) text += ' ' + std::to_string(i + 1);
            text += '\n';
        }
    };
    add("f", m.faces);
    add("l", m.edges);
    return text;
}

/// Faces and edges of any vertices, repeated ones too; or none of them.
TEST(Spellings, WhatStepTakesIsReadAsItWasWritten) {
    std::mt19937_64 random(12);
    for (int i = 0; i < 500; ++i) {
        mesh m;
        m.vertices.resize(i == 0 ? 0 : 1 + random() % 5);
        for (point<double>& p : m.vertices)
            for (double* x : {&p.x, &p.y, &p.z}) do
                    *x = std::bit_cast<double>(random());
                while (*x - *x != 0);
        const auto any = [&] { return static_cast<vertex_index>(random() % m.vertices.size()); };
        for (auto n = i == 0 ? 0 : random() % 4; n > 0; --n)
            m.faces.push_back({any(), any(), any()});
        for (auto n = i == 0 ? 0 : random() % 4; n > 0; --n) m.edges.push_back({any(), any()});
        EXPECT_EQ(described(parse_mesh_ply(ply_of(m), "m")), described(m));
        if (i == 0) continue;
        EXPECT_EQ(described(obj(obj_of(m))), described(m));
    }
}

}  // namespace
