// Fuzzes the OBJ and PLY readers: any bytes are a sound mesh or a file_error, never a crash; a mesh
// survives being written as OBJ, in shortest decimals, and as PLY.
#include <ccd/io/mesh_file.hpp>
#include <cstdlib>
#include <errbound/support/error.hpp>

#include "tests/ccd/io/meshes.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace ccd::io;
    for (const auto parse : {parse_mesh_obj, parse_mesh_ply}) {
        ccd::mesh m;
        try {
            m = parse({reinterpret_cast<const char*>(data), size}, "fuzz", {});
        } catch (const errbound::support::file_error&) {
            continue;
        }
        if (!test_meshes::is_sound(m)) std::abort();
        const auto is_read_back = [&](const ccd::mesh& again) {
            return test_meshes::same_mesh(m, again);
        };
        if (!is_read_back(parse_mesh_ply(ply_of(m), "again"))) std::abort();
        if (m.vertices.empty()) continue;  // OBJ has vertices
        if (!is_read_back(parse_mesh_obj(test_meshes::obj_of(m), "again"))) std::abort();
    }
    return 0;
}
