// Fuzzes the mesh readers by structure: the bytes choose a mesh and one of the many legal spellings
// of OBJ or PLY for it, and what is read must be that mesh, bit for bit.
#include <ccd/io/mesh_file.hpp>
#include <cstdlib>

#include "tests/ccd/io/fuzz/same_mesh.hpp"
#include "tests/ccd/io/fuzz/spellings.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) return 0;
    const bool is_obj = data[0] % 2 == 0;
    const std::span<const std::uint8_t> bytes(data + 1, size - 1);
    const auto [meant, text] =
        is_obj ? ccd::fuzz::spelled_obj(bytes) : ccd::fuzz::spelled_ply(bytes);
    const ccd::mesh read =
        is_obj ? ccd::io::parse_mesh_obj(text, "fuzz") : ccd::io::parse_mesh_ply(text, "fuzz");
    if (!ccd::fuzz::same_mesh(meant, read)) std::abort();
    return 0;
}
