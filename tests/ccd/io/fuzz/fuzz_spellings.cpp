// Fuzzes the mesh readers by structure. The bytes choose a mesh and a legal spelling of OBJ or PLY
// for it, and the reader must return that mesh, bit for bit.
#include <ccd/io/mesh_file.hpp>
#include <cstdlib>

#include "tests/ccd/io/fuzz/spellings.hpp"
#include "tests/ccd/io/meshes.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace ccd;
    if (size == 0) return 0;
    const bool is_obj = data[0] % 2 == 0;
    const std::span<const std::uint8_t> bytes(data + 1, size - 1);
    const auto [meant, text] = is_obj ? fuzz::spelled_obj(bytes) : fuzz::spelled_ply(bytes);
    const mesh read = is_obj ? io::parse_mesh_obj(text, "fuzz") : io::parse_mesh_ply(text, "fuzz");
    if (!test_meshes::same_mesh(meant, read)) std::abort();
    return 0;
}
