// Fuzzes the OBJ reader: any bytes are a sound mesh or a file_error, never a crash; what is read
// survives being written in shortest decimals.
#include <ccd/io/mesh_file.hpp>
#include <charconv>
#include <errbound/support/error.hpp>
#include <string>

#include "tests/ccd/io/fuzz/same_mesh.hpp"

namespace {

std::string obj(const ccd::mesh& m) {
    std::string text;
    for (const auto& p : m.vertices) {
        text += 'v';
        for (const double value : {p.x, p.y, p.z}) {
            char digits[64];
            const auto end = std::to_chars(digits, digits + sizeof digits, value).ptr;
            text += ' ' + std::string(digits, end);
        }
        text += '\n';
    }
    const auto add = [&text](char keyword, const auto& elements) {
        for (const auto& e : elements) {
            text += keyword;
            for (const ccd::vertex_index i : e) text += ' ' + std::to_string(std::uint64_t{i} + 1);
            text += '\n';
        }
    };
    add('f', m.faces);
    add('l', m.edges);
    return text;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    ccd::mesh m;
    try {
        m = ccd::io::parse_mesh_obj({reinterpret_cast<const char*>(data), size}, "fuzz");
    } catch (const errbound::support::file_error&) {
        return 0;
    }
    ccd::fuzz::require_sound(m);
    if (!ccd::fuzz::same_mesh(m, ccd::io::parse_mesh_obj(obj(m), "again"))) std::abort();
    return 0;
}
