// The readers of meshes: binary files, whole files, shares, topology. fuzz_spellings tests all
// formats and types of numbers, fuzz_mesh_files what the writer writes; spellings_test.cpp tests
// texts.
#include <gtest/gtest.h>

#include <bit>
#include <ccd/io/mesh_file.hpp>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/ccd/io/fuzz/spellings.hpp"
#include "tests/ccd/io/meshes.hpp"
#include "tests/support/files.hpp"

namespace {

using namespace ccd;
using namespace ccd::io;
using test_files::message_of;
using test_files::temporary_directory;
using test_files::write;
using test_meshes::same_mesh;
namespace fs = std::filesystem;

mesh some_mesh() {
    return {{{0, 0.5, -0.0}, {0.1, 1, 0x1p-149}, {-3, 0x1.fffffep127, 7}, {1e10, 2, 3}},
            {{0, 1, 2}, {3, 2, 1}},
            {{3, 0}}};
}

std::size_t header_size(const std::string& text) {
    return text.find("end_header\n") + 11;
}

void expect_ply(const std::string& text, const mesh& expected) {
    EXPECT_TRUE(same_mesh(parse_mesh_ply(text, "m"), expected)) << text;
}

std::string ply_error(const std::string& text) {
    return message_of([&] { parse_mesh_ply(text, "m.ply"); });
}

// The first bytes of x, LF, LF, CR and LF, are not part of the header.
TEST(Ply, BodiesThatBeginWithLineEnds) {
    mesh m = some_mesh();
    m.vertices[0].x = std::bit_cast<double>(0x0a0d0a0a0a0d0a0aU);
    const std::string text = ply_of(m);
    const std::size_t header = header_size(text);
    for (const char* end : {"\n", "\r\n", "\r"})
        expect_ply(test_meshes::with_line_ends(text.substr(0, header), end) + text.substr(header),
                   m);
}

TEST(Ply, BadBinary) {
    const std::string good = ply_of(some_mesh());
    const std::size_t header = header_size(good);
    const std::string truncated =
        "file ends here; expected more data (truncated, or a wrong count)";
    EXPECT_EQ(ply_error(good.substr(0, header + 30)), "m.ply: vertex 1: " + truncated);
    for (std::size_t size = 0; size < good.size(); ++size)
        EXPECT_NE(ply_error(good.substr(0, size)), "no error") << size;
    EXPECT_EQ(ply_error(good + "x"),
              "m.ply: number of bytes after the last element is 1; expected 0");
    mesh m = some_mesh();
    m.vertices[2].y = std::numeric_limits<double>::infinity();
    EXPECT_EQ(ply_error(ply_of(m)), "m.ply: vertex 2: y is an infinity; expected a finite number");
    m.vertices[2].y = std::nan("");
    EXPECT_EQ(ply_error(ply_of(m)), "m.ply: vertex 2: y is NaN; expected a finite number");
    // A list that claims 4 GiB.
    std::string list = good.substr(0, header) + "\xff\xff\xff\xff";
    list.insert(list.find("element"), "element a 1\nproperty list uint double b\n");
    EXPECT_EQ(ply_error(list), "m.ply: a 0: " + truncated);
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
    EXPECT_EQ(error(b), "b.ply: vertices of edge 0 are 0 3; expected 3 0 as in a.ply");
    b.faces[1] = {3, 1, 2};
    EXPECT_EQ(error(b), "b.ply: vertices of face 1 are 3 1 2; expected 3 2 1 as in a.ply");
    b.faces.pop_back();
    EXPECT_EQ(error(b), "b.ply: number of faces is 1; expected 2 as in a.ply");
    b.vertices.emplace_back();
    EXPECT_EQ(error(b), "b.ply: number of vertices is 5; expected 4 as in a.ply");
}

TEST(Meshes, Files) {
    const temporary_directory directory;
    const std::string text = ply_of(some_mesh());
    write(directory.path / "m.PLY", text);
    EXPECT_TRUE(same_mesh(read_mesh(directory.path / "m.PLY"), some_mesh()));
    write(directory.path / "m.stl", text);
    fs::create_directory(directory.path / "d.ply");
    for (const auto& [name, message] :
         {std::pair("m.stl", "extension is '.stl'; expected .ply or .obj"),
          {"none.ply", "file does not exist"},
          {"d.ply", "is a directory"}}) {
        const fs::path file = directory.path / name;
        const std::string found = message_of([&] { read_mesh(file); });
        EXPECT_NE(found.find(message), std::string::npos) << found;
    }
}

mesh larger_mesh() {
    mesh m;
    for (int i = 0; i < 23; ++i) m.vertices.push_back({i * 0.25, i * 3.0, -i * 0.5});
    for (vertex_index i = 0; i + 2 < 23; ++i) m.faces.push_back({i + 2, i, i + 1});
    for (vertex_index i = 0; i < 5; ++i) m.edges.push_back({i, 22 - i});
    return m;
}

/// Checks that the shares of a file together are the mesh.
void expect_shared(const fs::path& path, const std::string& text, const mesh& whole) {
    write(path, text);
    for (const std::size_t shares : {1, 2, 3, 5, 9, 29}) {
        mesh together;
        for (std::size_t i = 0; i < shares; ++i) {
            const mesh_share share = read_mesh_share(path, i, shares);
            EXPECT_EQ(share.vertices.first, together.vertices.size());
            EXPECT_EQ(share.faces.first, together.faces.size());
            EXPECT_EQ(share.edges.first, together.edges.size());
            EXPECT_EQ(share.vertices.all, whole.vertices.size());
            const auto append = [&](auto& all, const auto& more, const auto& expected) {
                EXPECT_LE(more.size(), (expected.size() + shares - 1) / shares);
                all.insert(all.end(), more.begin(), more.end());
            };
            append(together.vertices, share.elements.vertices, whole.vertices);
            append(together.faces, share.elements.faces, whole.faces);
            append(together.edges, share.elements.edges, whole.edges);
        }
        EXPECT_TRUE(same_mesh(together, whole)) << text;
    }
}

TEST(Shares, TogetherAreTheWholeOfEverySpelling) {
    const temporary_directory directory;
    const fs::path path = directory.path / "m.ply";
    expect_shared(path, ply_of(larger_mesh()), larger_mesh());
    std::minstd_rand random(1);
    for (int i = 0; i < 100; ++i) {
        std::vector<std::uint8_t> bytes(300);
        for (std::uint8_t& b : bytes) b = static_cast<std::uint8_t>(random() >> 8);
        const auto [in_ply, ply] = fuzz::spelled_ply(bytes);
        const auto [in_obj, obj] = fuzz::spelled_obj(bytes);
        expect_shared(path, ply, in_ply);
        expect_shared(directory.path / "m.obj", obj, in_obj);
    }
    // Other elements and properties are skipped.
    expect_shared(path,
                  "ply\r\nformat ascii 1.0\r\nobj_info none\r\nelement face 1\r\n"
                  "property uchar colour\r\nproperty list uchar int vertex_indices\r\n"
                  "property list int float extra\r\nelement camera 1\r\nproperty double view\r\n"
                  "element vertex 3\r\nproperty short x\r\nproperty list uchar uchar more\r\n"
                  "property double y\r\nproperty float z\r\nend_header\r\n"
                  "9 3 2 1 0 2 1.5 2.5\r\n0.5\r\n-7 2 1 1 0.1 0.5\r\n1 0 0 0\r\n2 0 0 0\r\n\r\n",
                  {{{-7, 0.1, 0.5}, {1, 0, 0}, {2, 0, 0}}, {{2, 1, 0}}, {}});
}

TEST(Shares, OneShareReportsABadFile) {
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
    const std::string good = ply_of(larger_mesh());
    EXPECT_EQ(first_error(good), "no error");
    EXPECT_EQ(first_error(""), "file is empty; expected a PLY mesh");
    for (std::size_t size = 1; size < good.size(); size += 7)
        EXPECT_NE(first_error(good.substr(0, size)), "no error") << size;
    EXPECT_EQ(first_error(good + '0'), "number of bytes after the last element is 1; expected 0");
    std::string quad = good;
    quad[quad.size() - 5 * 8 - 13 * 10] = 4;  // the eleventh face's count
    EXPECT_EQ(first_error(quad),
              "face 11: number of vertices of a face is 4; expected 3 (the option "
              "triangulate splits polygons)");
    mesh beyond = larger_mesh();
    beyond.faces[20][1] = 23;
    EXPECT_EQ(first_error(ply_of(beyond)), "face 20: vertex index is 23; expected less than 23");
    EXPECT_THROW(read_mesh_share(path, 3, 3), std::invalid_argument);
    if (fs::exists("/dev/null")) {  // not on Windows
        const std::string error = message_of([&] { read_mesh_share("/dev/null", 0, 3); });
        EXPECT_NE(error.find("expected one, to read shares"), std::string::npos) << error;
    }
    EXPECT_NE(
        message_of([&] { read_mesh_share(directory.path / "none", 0, 3); }).find("does not exist"),
        std::string::npos);
}

}  // namespace
