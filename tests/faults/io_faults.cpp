// Readers and writers when memory runs out.
#include <ccd/io/mesh_file.hpp>
#include <ccd/io/query_file.hpp>
#include <filesystem>
#include <tuple>

#include "errbound/support/output_file.hpp"
#include "errbound/support/table.hpp"
#include "tests/faults/failing_heap.hpp"
#include "tests/support/files.hpp"

namespace {

using namespace ccd::io;
using faults::try_every_allocation;
using test_files::repeated;
using test_files::temporary_directory;
namespace fs = std::filesystem;

auto content(const ccd::mesh& m) {
    return std::tuple(m.vertices, m.faces, m.edges);
}
auto content(const query_file& q) {
    return std::tuple(q.queries.index(), q.size(), q.truth);
}

const std::string ascii_ply =
    "ply\nformat ascii 1.0\ncomment a\nelement vertex 4\nproperty double x\nproperty float y\n"
    "property double z\nelement face 2\nproperty list uchar int vertex_indices\nelement edge 1\n"
    "property int vertex1\nproperty int vertex2\nend_header\n"
    "0 0 0\n1e-400 1e-60 0x1.8p-3\n0 1 1e-310\n123456789012345678901234567890 0 0\n3 0 1 2\n3 1 2 "
    "3\n0 3\n";

std::string binary_ply() {
    std::string text =
        "ply\nformat binary_big_endian 1.0\nelement vertex 3\nproperty char x\n"
        "property char y\nproperty char z\nelement face 1\n"
        "property list uchar uchar vertex_indices\nend_header\n";
    return text + std::string("\0\0\0\1\0\0\0\1\0\3\0\1\2", 13);
}

const std::string some_obj =
    "# comment\nv 0 0 0\nv 1 0 \\\n 0\nv 0 1e-400 0x1p-1074\nf 1 2 3\nf -1/1 -2//1 1/2/3\nl 1 2 "
    "3\n";

TEST(IoFaults, Meshes) {
    try_every_allocation("parse_mesh_ply (ascii)", [] {
        return content(parse_mesh_ply(ascii_ply, "a mesh's long enough name"));
    });
    try_every_allocation("parse_mesh_ply (binary)",
                         [text = binary_ply()] { return content(parse_mesh_ply(text, "m")); });
    try_every_allocation("parse_mesh_obj", [] { return content(parse_mesh_obj(some_obj, "m")); });
    const temporary_directory directory;
    for (const auto& [name, text] :
         {std::pair("a-mesh.ply", ascii_ply), std::pair("a-mesh.obj", some_obj),
          std::pair("without-extension", some_obj)}) {
        const auto path = directory.path / name;
        test_files::write(path, text);
        try_every_allocation(std::string("read_mesh ") + name,
                             [&] { return content(read_mesh(path)); });
    }
}

/// Tests a call that must throw file_error: its result is the message.
template <class Call>
void try_refusal(const std::string& name, const Call& call) {
    try_every_allocation(name, [&] {
        try {
            call();
        } catch (const errbound::support::file_error& error) {
            return std::string(error.what());
        }
        return std::string();
    });
}

TEST(IoFaults, Refusals) {
    try_refusal("parse_mesh_ply (refuses)",
                [] { parse_mesh_ply(ascii_ply + "more", "a mesh's long enough name"); });
    try_refusal("parse_mesh_obj (refuses)", [] { parse_mesh_obj(some_obj + "f 1 2 9", "m"); });
    try_refusal("parse_queries (refuses)",
                [] { parse_queries("1,3,2,2,2,2\n", "q", ccd::kind::vertex_face, false); });
    try_refusal("parse_truth (refuses)", [] { parse_truth("[true,1]", "t"); });
    const ccd::mesh a = parse_mesh_obj(some_obj, "a");
    ccd::mesh b = a;
    b.faces[1] = {2, 1, 0};
    try_refusal("require_same_topology",
                [&] { require_same_topology(a, "a first long name", b, "another long name"); });
}

TEST(IoFaults, Queries) {
    const std::string big = "1" + std::string(60, '0'),
                      rational = repeated(big + "," + big + ",1,2,3,4,1\n", 8);
    const std::string decimal = repeated("1e-400,0x1p-1074,0x1.8p3\n", 16);
    try_every_allocation("parse_queries (rationals)", [&] {
        return content(parse_queries(rational, "q", ccd::kind::vertex_face, false));
    });
    try_every_allocation("parse_queries (decimals)", [&] {
        return content(parse_queries(decimal, "q", ccd::kind::edge_edge, true));
    });
    const temporary_directory directory;
    test_files::write(directory.path / "queries" / "1vf.csv", decimal);
    test_files::write(directory.path / "mma_bool" / "1vf_mma_bool.json", "[true, false]");
    try_every_allocation("read_queries", [&] {
        return content(read_queries(directory.path / "queries" / "1vf.csv", std::nullopt, false));
    });
    try_every_allocation("parse_truth", [] { return parse_truth("[true, false, true]", "t"); });
    try_every_allocation("kind_names", [] { return kind_names(); });
    try_every_allocation("kind_from_path", [] { return kind_from_path("a/vertex-face/1.csv"); });
}

TEST(IoFaults, Outputs) {
    const temporary_directory directory;
    const fs::path one = directory.path / "one", two = directory.path / "two";
    try_every_allocation("write_whole", [&] {
        try {
            errbound::support::write_whole({{one, "new"}, {two, "new"}});
        } catch (const std::bad_alloc&) {
            for (const auto& entry : fs::directory_iterator(directory.path))
                if (entry.path() != one && entry.path() != two) ADD_FAILURE() << entry.path();
            throw;
        }
        return true;
    });
    try_every_allocation("read_whole", [&] { return errbound::support::read_whole(one); });
    const errbound::support::table rows = {{"a", "b"}, {"a longer cell than that", "2"}};
    try_every_allocation("text_of (table)", [&] { return errbound::support::text_of(rows, 1); });
}

}  // namespace
