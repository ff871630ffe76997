// Frames of either format, and what two frames of one mesh must share.
#include <algorithm>
#include <ccd/io/mesh_file.hpp>
#include <errbound/support/error.hpp>

#include "ccd/io/element_check.hpp"
#include "ccd/io/text.hpp"
#include "errbound/support/output_file.hpp"

namespace ccd::io {

using errbound::support::file_error;
using errbound::support::read_whole;

std::string text_of(std::span<const vertex_index> element) {
    std::string text;
    for (const vertex_index i : element) text += (text.empty() ? "" : " ") + std::to_string(i);
    return text;
}

std::optional<std::string> fault_of(std::span<const vertex_index> element, std::size_t vertices) {
    for (const vertex_index i : element) {
        if (i >= vertices) {
            return "found vertex index " + std::to_string(i) + ", expected less than " +
                   std::to_string(vertices);
        }
    }
    for (std::size_t i = 0; i < element.size(); ++i) {
        if (std::ranges::count(element, element[i]) > 1) {
            return "found a repeated vertex (" + text_of(element) + "), expected " +
                   (element.size() == 2 ? "two" : "three") + " different ones";
        }
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
    if (extension.empty() || !std::filesystem::is_regular_file(path)) {
        std::string_view rest = without_byte_order_mark(text, path.string());
        const bool is_ply = trimmed(take_line(rest).value_or("")) == "ply";
        return is_ply ? parse_mesh_ply(text, path.string()) : parse_mesh_obj(text, path.string());
    }
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
    const auto require_equal_elements = [&](const auto& found, const auto& expected,
                                            const std::string& one) {
        require_equal(found.size(), expected.size(), (one + "s").c_str());
        const auto [a, b] = std::ranges::mismatch(found, expected);
        if (a == found.end()) return;
        throw file_error(after_name + ": " + one + " " + std::to_string(a - found.begin()) +
                         ": found vertices " + text_of(*a) + ", expected " + text_of(*b) +
                         " as in " + before_name);
    };
    require_equal_elements(after.faces, before.faces, "face");
    require_equal_elements(after.edges, before.edges, "edge");
}

}  // namespace ccd::io
