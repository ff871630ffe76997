// Frames of either format, and what two frames of one mesh must share.
#include <algorithm>
#include <ccd/io/mesh_file.hpp>
#include <errbound/support/error.hpp>

#include "ccd/io/face_check.hpp"
#include "ccd/io/text.hpp"
#include "errbound/support/output_file.hpp"

namespace ccd::io {

using errbound::support::file_error;
using errbound::support::read_whole;

std::string text_of(const face& f) {
    return std::to_string(f[0]) + " " + std::to_string(f[1]) + " " + std::to_string(f[2]);
}

std::optional<std::string> fault_of(const face& f, std::size_t vertices) {
    for (const index i : f) {
        if (i >= vertices) {
            return "found vertex index " + std::to_string(i) + ", expected less than " +
                   std::to_string(vertices);
        }
    }
    if (f[0] == f[1] || f[1] == f[2] || f[0] == f[2]) {
        return "found a repeated vertex (" + text_of(f) + "), expected three different ones";
    }
    return std::nullopt;
}

mesh read_mesh(const std::filesystem::path& path) {
    const std::string text = read_whole(path);
    std::string extension = path.extension().string();
    for (char& c : extension) {
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    }
    if (extension == ".ply") return parse_mesh_ply(text, path.string());
    if (extension == ".obj") return parse_mesh_obj(text, path.string());
    throw file_error(path.string() + ": found extension " + excerpt(extension) +
                     ", expected .ply or .obj");
}

void require_same_topology(const mesh& before, const std::string& before_name, const mesh& after,
                           const std::string& after_name) {
    const auto require_equal = [&](std::size_t found, std::size_t expected, const char* what) {
        if (found == expected) return;
        throw file_error(after_name + ": found " + std::to_string(found) + " " + what +
                         ", expected " + std::to_string(expected) + " as in " + before_name);
    };
    require_equal(after.vertices.size(), before.vertices.size(), "vertices");
    require_equal(after.faces.size(), before.faces.size(), "faces");
    const auto [a, b] = std::mismatch(after.faces.begin(), after.faces.end(), before.faces.begin());
    if (a != after.faces.end()) {
        throw file_error(after_name + ": face " + std::to_string(a - after.faces.begin()) +
                         ": found vertices " + text_of(*a) + ", expected " + text_of(*b) +
                         " as in " + before_name);
    }
}

}  // namespace ccd::io
