// Spellings of OBJ and PLY: the mesh of each, or the message that refuses it. Every mesh is written
// as PLY and read again. (Spellings of numbers: text_test.cpp.)
#include <gtest/gtest.h>

#include <array>
#include <ccd/io/mesh_file.hpp>
#include <string>
#include <string_view>

#include "tests/ccd/io/meshes.hpp"
#include "tests/support/files.hpp"

namespace {

using namespace ccd;
using namespace ccd::io;
using namespace std::string_view_literals;
using test_meshes::texts;
using test_meshes::with_line_ends;

/// A text, and its meaning: vertices, then faces and edges by index; or "!" and part of a message.
struct spelling {
    std::string_view text;
    const char* meaning;
};

std::string described(const mesh& m) {
    std::string text;
    const auto add = [&](char element, const auto& numbers) {
        text += (text.empty() ? "" : " ") + std::string(1, element);
        for (const auto x : numbers) text += ' ' + test_meshes::shortest(x);
    };
    for (const point<double>& p : m.vertices) add('v', std::array{p.x, p.y, p.z});
    for (const face& f : m.faces) add('f', f);
    for (const edge& e : m.edges) add('e', e);
    return text;
}

/// `before` describes the mesh without the text's own elements.
template <class Parse>
void expect_meaning(const Parse& parse, const std::string& text, const std::string& meaning,
                    const std::string& before = "") {
    std::string found;
    const std::string message = test_files::message_of([&] {
        const mesh m = parse(text);
        found = described(m);
        EXPECT_EQ(described(parse_mesh_ply(ply_of(m), "again")), found);
    });
    if (meaning.starts_with('!'))
        EXPECT_NE(message.find(meaning.substr(1)), std::string::npos) << text << '\n' << message;
    else
        EXPECT_EQ(message == "no error" ? found : message,
                  before + (before.empty() || meaning.empty() ? "" : " ") + meaning)
            << text;
}

const auto obj = [](const std::string& text) { return parse_mesh_obj(text, "m.obj"); };
const auto split_obj = [](const std::string& text) {
    return parse_mesh_obj(text, "m.obj", {.triangulate = true});
};

/// Spellings of the vertex (1, 2, 3).
const auto of_a_vertex = texts(
    "v 1 2 3|v 1 2 3\n|v 1 2 3\r|v 1 2 3\r\n|v\t1\t2\t3|  v   1 2  3  |v 1. 2.0 03|\n\nv 1 2 3\n\n"
    "|v 1e0 2E+0 30e-1|v 0x1p0 0X2 0x1.8p1|v 1 2 3 1|v 1 2 3 1.0|v 1 2 3 .5 .25 1|v 1 2 3 255 0 0"
    "|v 1 2 3 .5 .25 1 1|v 1 2 3 .5 .25 1 0|v 1 2 3 # red|v 1 2 3 #red|v 1 2 3\t#|#\nv 1 2 3"
    "|# v 4 5 6\nv 1 2 3|# C:\\\nv 1 2 3|v 1 2 3 # C:\\\n# C:\\meshes\\|#\x01\xff\nv 1 2 3"
    "|v 1 \\\n2 \\\r\n 3|v 1 2 \\\n3 # all \\\n# of it|\\\nv 1 2 3|  \n\t\nv 1 2 3"
    "|\xef\xbb\xbfv 1 2 3|v 1 2 3\x1a|v 1 2 3\n\x1a|v 1 2 3\r\n\x1a\x1a\r\n"
    "|o a#b\ng a # b\nusemtl a#1\nv 1 2 3|vt 0 0\nvn 0 0 1\nvp 0\ns off\nmtllib a.mtl\nv 1 2 3");

/// Other vertices, and files that are refused.
constexpr spelling of_vertices[]{
    {"v +1 -2 +.5", "v 1 -2 0.5"},
    {"v -0 0 -0.0", "v -0 0 -0"},
    {"v 0.1 1e-310 4.9e-324", "v 0.1 1e-310 5e-324"},
    {"v 1.7976931348623157e308 1e-999 0", "v 1.7976931348623157e+308 0 0"},
    {"v 0.1000000000000000055511151231257827 0 0", "v 0.1 0 0"},
    {"v 1 2 3\nv 1 2 3", "v 1 2 3 v 1 2 3"},
    {"v 0 nan 0", "!value is 'nan'; expected a finite number"},
    {"v 0 -inf 0", "!value is '-inf'; expected a finite number"},
    {"v 0 0 1e999", "!value is '1e999', which overflows; expected a finite number"},
    {"v 0 0 0x1p1024", "!value is '0x1p1024', which overflows"},
    {"v 1 2 3#red", "!value is '3#red'; expected a number"},
    {"v 1 2#3 4", "!value is '2#3'; expected a number"},
    {"v 1 2 # 3", "!number of values of a vertex is 2; expected 3 (x y z)"},
    {"v", "!number of values of a vertex is 0"},
    {"v 1 2 3 4 5", "!number of values of a vertex is 5"},
    {"v 1 2 3 0.5", "!weight of a vertex is not 1; expected none or 1"},
    {"v 1 2 3 4 5 6 7 8", "!number of values of a vertex is more than 7"},
    {"v 1 2 3 0 0 nan", "!value is 'nan'; expected a finite number"},
    {"v 1,5 2 3", "!value is '1,5'; expected a number"},
    {"v 1 2 3f", "!value is '3f'; expected a number"},
    {"v 1 2 \\\n3\\\n4", "!backslash may split a word"},
    {"v 1 2 3 \\", "!last line ends with a backslash"},
    {"v 1 2 3\n\x1av 1 2 3", "!line is '\\x1av 1 2 3'; expected no control"},
    {"v 1 2 3\x1a\nv 1 2 3", "!line is 'v 1 2 3\\x1a'; expected no control"},
    {"v 1 2 3\f", "!expected no control characters"},
    {"v#1 2 3", "!keyword is 'v#1'"},
    {"o nothing\n", "!m.obj: number of vertices is 0; expected lines 'v x y z'"},
    {"", "!m.obj: file is empty"},
    {"\x1a", "!m.obj: number of vertices is 0"},
    {"\xff\xfev", "!m.obj: encoding is UTF-16 or UTF-32; expected ASCII or UTF-8"},
    {"\xfe\xffv", "!encoding is UTF-16 or UTF-32"},
    {"v 1 2 3\n\xef\xbb\xbfv 1 2 3",
     "!m.obj:2: keyword is '\\xef\\xbb\\xbfv'; expected v, f, l or another of OBJ's"},
    {"v\0 \0\x30\0\n\0"sv, "!m.obj:1: line is 'v\\x00 \\x000\\x00'; expected no control"},
    {"v 1 2 \\\n3\nv 0 1 \\\nx", "!m.obj:3: value is 'x'; expected a number"},
    {"v 0 0 -1.#IND", "!m.obj:1: value is '-1.#IND'; expected a finite number"},
    {"\177ELF\1\2", "!m.obj:1: line is '\\x7fELF\\x01\\x02'; expected no control characters"},
};

/// Spellings of the triangle of the first three vertices, of five.
const auto of_a_face = texts(
    "f 1 2 3|f\t1  2\t3 |f +1 +2 03|f -5 -4 -3|f 1/1 2/2 3/3|f 1/1/1 2/2/2 3/3/3|f 1//1 2//2 3//3"
    "|f 1/1/ 2/2/ 3/3/|f 1/ 2/ 3/|f 1// 2// 3//|f 1 2/ 3/7/|f 1/-1/-1 2/9 3//99|fo 1 2 3|f 1 2 "
    "3\x1a"
    "|f 1 2 \\\n3|f 1 2 3 # 4|f \\\n\\\n1 2 \\\n3 # last\ng a \\\nf 1 2 4");

/// Other elements of five vertices.
constexpr spelling of_elements[]{
    {"", ""},
    {"f 3 1 2", "f 2 0 1"},
    {"f 1 -1 3", "f 0 4 2"},
    {"f 4 4 5\nf 4 5 4\nf 5 4 4\nf 4 4 4", "f 3 3 4 f 3 4 3 f 4 3 3 f 3 3 3"},
    {"f 1 2 3\nf 1 2 3\nf 3 2 1", "f 0 1 2 f 0 1 2 f 2 1 0"},
    {"f 1 2 3 #4 \\\nf 1 2 4", "f 0 1 2 f 0 1 3"},
    {"f 1 2 3\ng a\no b\ns 1\nf 1 2 4", "f 0 1 2 f 0 1 3"},
    {"l 2 1", "e 1 0"},
    {"l 1 2 3 1", "e 0 1 e 1 2 e 2 0"},
    {"l 1/1 2/2\nl 1/ 2/", "e 0 1 e 0 1"},
    {"l 1 1\nl 1 1 2", "e 0 0 e 0 0 e 0 1"},
    {"l -1 -2", "e 4 3"},
    {"f 1 2 3\nl 4 5", "f 0 1 2 e 3 4"},
    {"l 4 5\nf 1 2 3", "f 0 1 2 e 3 4"},
    {"p 1 3 5", "e 0 0 e 2 2 e 4 4"},
    {"p -1", "e 4 4"},
    {"p 1/ 1", "e 0 0"},
    {"f 1 2 3\np 1 2 4", "f 0 1 2 e 3 3"},
    {"p 4 1\nf 1 2 3", "f 0 1 2 e 3 3"},
    {"l 1 2\np 2", "e 0 1"},
    {"f 1 2", "!m.obj:6: number of vertices of a face is 2; expected 3"},
    {"f # 1 2 3", "!number of vertices of a face is 0"},
    {"f 1 2 3 4", "!number of vertices of a face is 4; expected 3 (the option triangulate"},
    {"f 1 2 3 4 5", "!number of vertices of a face is 5; expected 3"},
    {"f 1 2 3#4", "!vertex is '3#4'; expected v, v/vt, v//vn or v/vt/vn"},
    {"f 1 2 0", "!vertex index is 0; expected 1 or more"},
    {"f 1 2 6", "!m.obj:6: face 0 (indices from 0): vertex index is 5; expected less"},
    {"f 1 2 -6", "!vertex index is -6"},
    {"f 1 2 4294967296", "!vertex index is 4294967296"},
    {"f 1 2 99999999999999999999", "!vertex is '99999999999999999999'"},
    {"f 1/1/1/1 2 3", "!vertex is '1/1/1/1'; expected at most v/vt/vn"},
    {"f 1/// 2 3", "!vertex is '1///'; expected at most v/vt/vn"},
    // "f 1 2 34" or "f 1 2 3 4", a comment of one line or of two: readers differ.
    {"f 1 2 3\\\n4", "!m.obj:6: backslash may split a word; expected a blank"},
    {"f 1 2 \\ \n3\n", "!m.obj:6: vertex is '"},
    {"l 1", "!number of vertices of a line is 1; expected 2 or more"},
    {"l 1 6", "!edge 0 (indices from 0): vertex index is 5; expected less than 5"},
    {"p", "!number of vertices of a point element is 0"},
    {"p 6", "!m.obj:6: point 0 (indices from 0): vertex index is 5"},
    {"p x", "!vertex is 'x'; expected v,"},
    {"F 1 2 3", "!keyword is 'F'"},
    {"face 1 2 3", "!keyword is 'face'"},
    {"surf 0 1 0 1 1 2 3 4", "!keyword is 'surf', which a mesh cannot hold"},
};

/// Elements of five vertices, with polygons split.
constexpr spelling of_polygons[]{
    {"f 1 2 3", "f 0 1 2"},
    {"f 2 3 4 1", "f 1 2 3 f 1 3 0"},
    {"f 1 2 3 4 5", "f 0 1 2 f 0 2 3 f 0 3 4"},
    {"f 1/1/ 2/2/ 3/3/ 4/4/", "f 0 1 2 f 0 2 3"},
    {"f -5 -4 -3 -2", "f 0 1 2 f 0 2 3"},
    {"f 1 2 1 2 1", "f 0 1 0 f 0 0 1 f 0 1 0"},
    {"f 1 2 3\nf 1 2 3 4\nl 4 5", "f 0 1 2 f 0 1 2 f 0 2 3 e 3 4"},
    {"f 1 2", "!number of vertices of a face is 2; expected 3"},
    {"f 1 2 3 6", "!m.obj:6: triangle 1 (indices from 0): vertex index is 5"},
};

const std::string five = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 5 5 5\n";
const std::string described_five = "v 0 0 0 v 1 0 0 v 0 1 0 v 0 0 1 v 5 5 5";

TEST(Spellings, Obj) {
    const auto expect = [](const std::string& text, const std::string& meaning) {
        expect_meaning(obj, five + text, meaning, described_five);
    };
    for (const auto& text : of_a_vertex) expect_meaning(obj, text, "v 1 2 3");
    for (const auto& [text, meaning] : of_vertices) expect_meaning(obj, std::string(text), meaning);
    for (const auto& text : of_a_face) expect(text, "f 0 1 2");
    for (const auto& [text, meaning] : of_elements) expect(std::string(text), meaning);
    for (const std::string word : {"3.0", "x", "/3", "//", "1/0", "1//0", "1/x", "++1", "1,2,3"})
        for (const char* element : {"f 1 2 ", "l 1 ", "p "})
            expect(element + word, "!vertex is '" + word + "'; expected v,");
    for (const auto& [text, meaning] : of_polygons)
        expect_meaning(split_obj, five + std::string(text), meaning, described_five);
}

TEST(Spellings, ObjKeywords) {
    const auto expect = [](const std::string& line, const std::string& meaning) {
        expect_meaning(obj, five + line + "\n", meaning, described_five);
    };
    for (const char* word : {"V", "F", "vv", "\xc2\xa0v", "t", "v,", "1", "face", "fn", "v:"})
        expect(word + std::string(" 0 0 0"), "!m.obj:6: keyword is '");
    for (const std::string word : {"curv", "surf", "bzp", "bsp", "cdc", "cdp", "call", "csh"})
        expect(word + " 1 2 3",
               "!m.obj:6: keyword is '" + word + "', which a mesh cannot hold; expected triangles");
    for (const char* line :
         {"vt 0 0", "vn 0 0 1", "vp 0", "g a b", "s off", "mg 0", "o", "bevel on", "lod 1",
          "usemtl a#b", "mtllib a b", "cstype bezier", "deg 3", "parm u 0 1", "end", " \t", ""})
        expect(line, "");
}

TEST(Spellings, LineEnds) {
    for (const char* end : {"\r", "\r\n", "\r\r\n", "\n\r"})
        for (const char* first : {"# all of it\n", "o one\n"})
            expect_meaning(obj, with_line_ends(first + five, end), "", described_five);
    for (const char* end : {"\f", "\v", "\x1a", "\x1c"})
        expect_meaning(obj, with_line_ends("o one\n" + five, end),
                       "!expected no control characters");
}

constexpr std::string_view ply_vertices =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\n"
    "property double z\n";

/// The text after the header's lines above; '@' stands for the three vertices' lines.
constexpr spelling of_ply[]{
    {"end_header\n@", ""},
    {"end_header\n@\x1a", ""},
    {"end_header\n@\n\x1a\r\n", ""},
    {"element face 0\nproperty list uchar int vertex_indices\nend_header\n@", ""},
    {"element face 0\nelement edge 0\nend_header\n@", ""},
    {"comment C:\\\nobj_info # \x01\nend_header\n@", ""},
    {"element face 1\nproperty list uint8 uint32 vertex_index\nend_header\n@3 0 1 2\n", "f 0 1 2"},
    {"element face 1\nproperty list int char vertex_index\nend_header\n@+3 0 01 2.0\n", "f 0 1 2"},
    {"element face 1\nproperty list uchar int vertex_indices\nend_header\n@3 2 2 2", "f 2 2 2"},
    {"element face 2\nproperty list uchar int vertex_indices\nend_header\n@3 0 1 2\n3 0 1 2",
     "f 0 1 2 f 0 1 2"},
    {"element face 1\nproperty uchar red\nproperty list uchar int vertex_indices\n"
     "end_header\n@7 3 0 1 2",
     "f 0 1 2"},
    {"element edge 1\nproperty uchar vertex2\nproperty uint vertex1\nend_header\n@0 1", "e 1 0"},
    {"element edge 1\nproperty int vertex1\nproperty int vertex2\nend_header\n@1 1", "e 1 1"},
    {"element face 1\nproperty list uchar int vertex_indices\nelement edge 1\n"
     "property int vertex1\nproperty int vertex2\nend_header\n@3 0 1 2\n2 2",
     "f 0 1 2 e 2 2"},
    {"element camera 1\nproperty float view\nend_header\n@nan", ""},
};

const std::string good_ply =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\n"
    "property double z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

/// A part of good_ply, its replacement, and part of the message that refuses the result.
struct bad_edit {
    const char *from, *to, *message;
};

constexpr bad_edit bad_edits[]{
    {"ply\n", "\xff\xfep", "m.ply: encoding is UTF-16 or UTF-32; expected ASCII or UTF-8"},
    {"ply\n", "\177ELF\n", "m.ply:1: line is '\\x7fELF'; expected 'ply'"},
    // The header.
    {"end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", "",
     "m.ply:9: file ends in the header; expected end_header"},
    {"format ascii 1.0\n", "", "m.ply:8: number of format lines is 0; expected 1"},
    {"element vertex", "format ascii 1.0\nelement vertex",
     "m.ply:3: number of format lines is 2; expected 1"},
    {"ascii", "utf8", "line is 'format utf8 1.0'; expected format ascii, binary_little"},
    {"1.0", "2.0", "expected version 1.0"},
    {"end_header", "# no comment\nend_header", "line is '# no comment'; expected format, ele"},
    {"face", "fa\vce", "m.ply:7: line is 'element fa\\x0bce"},
    {"vertex 3", "vertices 3", "m.ply: number of elements 'vertex' is 0; expected 1"},
    {"element face", "element vertex", "m.ply:7: element 'vertex' is given twice"},
    {"double y", "double x", "m.ply:5: property 'x' is given twice"},
    {"element face", "element a 1\nelement face", "number of properties of element 'a' is 0"},
    {"element vertex 3\n", "", "m.ply:3: property is before all elements"},
    {"double x", "quad x", "type is 'quad'; expected a PLY type"},
    {"list uchar", "list float", "expected an integer type for the list's count"},
    {"property double x\n", "", "m.ply: property 'x' of vertex is missing; expected x, y"},
    {"uchar int", "uchar float", "m.ply: number of lists of vertex indices in face is 0"},
    {"vertex_indices", "corners", "m.ply: number of lists of vertex indices in face is 0"},
    {"end_header", "property list int int vertex_index\nend_header",
     "m.ply: number of lists of vertex indices in face is 2"},
    {"end_header", "element edge 1\nproperty int vertex1\nend_header",
     "m.ply: property 'vertex2' of edge is missing; expected integers vertex1 and vertex2"},
    {"end_header", "element edge 1\nproperty int vertex1\nproperty float vertex2\nend_header",
     "m.ply: property 'vertex2' of edge is missing"},
    {"end_header", "element tristrips 1\nproperty list int int vertex_indices\nend_header",
     "element 'tristrips' has vertex indices; expected them in face or edge"},
    // Counts.
    {"vertex 3", "vertex 4", "m.ply:13: text after the last property is '2'; expected the end"},
    {"vertex 3", "vertex 2", "m.ply:12: number of vertices of a face is 0; expected 3"},
    {"vertex 3", "vertex -1", "m.ply:3: line is 'element vertex -1'; expected element NAME"},
    {"vertex 3", "vertex 18446744073709551615",
     "m.ply: number of vertices is 18446744073709551615; expected fewer than 2^32"},
    {"vertex 3", "vertex 4000000000", "m.ply:13: text after the last property is '2'"},
    {"0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", "",
     "m.ply:10: file ends here; expected vertex 0 (truncated, or a wrong count)"},
    {"face 1", "face 2", "m.ply:14: file ends here; expected face 1 (truncated, or a wrong count)"},
    {"face 1", "face 18446744073709551615",
     "m.ply:14: file ends here; expected face 1 (truncated, or a wrong count)"},
    {"3 0 1 2\n", "3 0 1 2\n3 0 1 2\n",
     "m.ply:14: text after the last element is '3 0 1 2'; expected the end of the file"},
    {"3 0 1 2\n", "3 0 1 2\n\x1a\x01", "text after the last element is '"},
    // Coordinates.
    {"0 0 0", "0 nan 0", "m.ply:10: value is 'nan'; expected a finite number"},
    {"0 0 0", "0 0 -1.#IND", "m.ply:10: value is '-1.#IND'; expected a finite number"},
    {"0 0 0", "0 1e999 0", "value is '1e999', which overflows; expected a finite number"},
    {"0 0 0", "0 zero 0", "m.ply:10: value is 'zero'; expected a number"},
    {"0 0 0", "0 0", "m.ply:10: line has too few values; expected one for each property"},
    // Faces and edges.
    {"3 0 1 2", "3 0 1 3", "m.ply: face 0: vertex index is 3; expected less than 3"},
    {"3 0 1 2", "3 0 -1 2", "m.ply:13: vertex index is -1; expected 0 or more"},
    {"3 0 1 2", "3 0 1 1.#INF", "value is '1.#INF'; expected an integer of the declared type"},
    {"3 0 1 2", "300 0 1 2", "value is '300'; expected an integer of the declared type"},
    {"3 0 1 2", "2 0 1", "m.ply:13: number of vertices of a face is 2; expected 3"},
    {"3 0 1 2", "4 0 1 2 0",
     "m.ply:13: number of vertices of a face is 4; expected 3 (the option triangulate "
     "splits polygons)"},
    {"3 0 1 2", "3 0 1 2 # all", "m.ply:13: text after the last property is '# all'"},
    {"face 1\nproperty list uchar int vertex_indices\nend_header",
     "edge 1\nproperty uint vertex1\nproperty uint vertex2\nproperty int w\n"
     "property int h\nend_header",
     "m.ply: edge 0: vertex index is 3; expected less than 3"},
    {"element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0",
     "element edge 1\nproperty uint vertex1\nproperty uint vertex2\nend_header\n-1 0 0\n"
     "0 0 0\n0 0 0\n-2 1",
     "m.ply:14: value is '-2'; expected an integer of the declared type"},
};

/// The last face of three vertices, split.
constexpr spelling of_ply_polygons[]{
    {"3 0 1 2", "f 0 1 2"},
    {"4 0 1 2 0", "f 0 1 2 f 0 2 0"},
    {"5 0 1 2 1 2", "f 0 1 2 f 0 2 1 f 0 1 2"},
    {"4 0 1 2 3", "!triangle 1: vertex index is 3; expected less than 3"},
    {"2 0 1", "!number of vertices of a face is 2"},
};

std::string edited(std::string text, std::string_view from, std::string_view to) {
    return text.replace(text.find(from), from.size(), to);
}

TEST(Spellings, Ply) {
    const std::string described_three = "v 0 0 0 v 1 0 0 v 0 1 0";
    const auto parse = [](const std::string& all) { return parse_mesh_ply(all, "m.ply"); };
    const auto split = [](const std::string& all) {
        return parse_mesh_ply(all, "m.ply", {.triangulate = true});
    };
    expect_meaning(parse, "", "!m.ply: file is empty; expected a PLY mesh");
    for (const auto& [text, meaning] : of_ply)
        expect_meaning(parse,
                       edited(std::string(ply_vertices).append(text), "@", "0 0 0\n1 0 0\n0 1 0\n"),
                       meaning, described_three);
    for (const auto& [from, to, message] : bad_edits)
        expect_meaning(parse, edited(good_ply, from, to), std::string("!") + message);
    for (const auto& [text, meaning] : of_ply_polygons)
        expect_meaning(split, edited(good_ply, "3 0 1 2", text), meaning, described_three);
    expect_meaning(parse, with_line_ends(good_ply, "\r"), "f 0 1 2", described_three);
    for (const std::string count :
         {"18446744073709551616", "99999999999999999999999", "1e3", "3.0", "+3"})
        for (const std::string element : {"vertex 3", "face 1"})
            expect_meaning(parse,
                           edited(good_ply, element, element.substr(0, element.size() - 1) + count),
                           "!expected element NAME COUNT");
}

}  // namespace
