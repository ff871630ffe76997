// Fuzzes the PLY reader: any bytes are a sound mesh or a file_error, never a crash; what is read
// survives being written as binary doubles.
#include <array>
#include <bit>
#include <ccd/io/mesh_file.hpp>
#include <errbound/support/error.hpp>
#include <string>

#include "tests/ccd/io/fuzz/same_mesh.hpp"

namespace {

template <class T>
void append(std::string& bytes, T value) {
    std::array<char, sizeof(T)> raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
    if (std::endian::native == std::endian::big) std::reverse(raw.begin(), raw.end());
    bytes.append(raw.data(), raw.size());
}

std::string binary_ply(const ccd::mesh& m) {
    std::string bytes = "ply\nformat binary_little_endian 1.0\nelement vertex " +
                        std::to_string(m.vertices.size()) +
                        "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
                        std::to_string(m.faces.size()) +
                        "\nproperty list uchar uint vertex_indices\nelement edge " +
                        std::to_string(m.edges.size()) +
                        "\nproperty uint vertex1\nproperty uint vertex2\nend_header\n";
    for (const auto& p : m.vertices) {
        for (const double value : {p.x, p.y, p.z}) append(bytes, value);
    }
    for (const auto& f : m.faces) {
        bytes += '\3';
        for (const ccd::vertex_index i : f) append(bytes, i);
    }
    for (const auto& e : m.edges) {
        for (const ccd::vertex_index i : e) append(bytes, i);
    }
    return bytes;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    ccd::mesh m;
    try {
        m = ccd::io::parse_mesh_ply({reinterpret_cast<const char*>(data), size}, "fuzz");
    } catch (const errbound::support::file_error&) {
        return 0;
    }
    ccd::fuzz::require_sound(m);
    if (!ccd::fuzz::same_mesh(m, ccd::io::parse_mesh_ply(binary_ply(m), "again"))) std::abort();
    return 0;
}
