#include <algorithm>
#include <boost/interprocess/file_mapping.hpp>
#include <boost/interprocess/mapped_region.hpp>
#include <ccd/io/mesh_file.hpp>
#include <errbound/support/error.hpp>
#include <stdexcept>
#include <system_error>

#include "ccd/io/mesh_reading.hpp"
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
    const auto bad = std::ranges::find_if(element, [=](vertex_index i) { return i >= vertices; });
    if (bad == element.end()) return std::nullopt;
    return "vertex index is " + std::to_string(*bad) + "; expected less than " +
           std::to_string(vertices);
}

std::optional<std::string> fault_of_corners(std::uint64_t corners, const mesh_options& options) {
    if (corners == 3 || (corners > 3 && options.triangulate)) return std::nullopt;
    return "number of vertices of a face is " + std::to_string(corners) + "; expected 3" +
           (corners > 3 ? " (the option triangulate splits polygons)" : "");
}

namespace {

enum class format { ply, obj };

format format_of(const std::filesystem::path& path, std::string_view text) {
    std::string extension = path.extension().string();
    for (char& c : extension)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    if (extension == ".ply") return format::ply;
    if (extension == ".obj") return format::obj;
    if (extension.empty() || !std::filesystem::is_regular_file(path)) {
        std::string_view rest = without_byte_order_mark(text, path.string());
        return trimmed(take_line(rest).value_or("")) == "ply" ? format::ply : format::obj;
    }
    throw file_error(path.string() + ": extension is " + excerpt(extension) +
                     "; expected .ply or .obj");
}

mesh_share share_of(const mesh& frame, share_of_file share) {
    const auto cut = [share](const auto& all) {
        const auto at = [&](std::uint64_t i) {
            return all.begin() + static_cast<std::ptrdiff_t>(i);
        };
        return std::vector(at(share.first_of(all.size())), at(share.last_of(all.size())));
    };
    const auto place = [share](const auto& all) {
        return mesh_share::place{static_cast<std::size_t>(share.first_of(all.size())), all.size()};
    };
    return {{cut(frame.vertices), cut(frame.faces), cut(frame.edges)},
            place(frame.vertices),
            place(frame.faces),
            place(frame.edges)};
}

}  // namespace

mesh read_mesh(const std::filesystem::path& path, const mesh_options& options) {
    const std::string text = read_whole(path);
    return format_of(path, text) == format::ply ? parse_mesh_ply(text, path.string(), options)
                                                : parse_mesh_obj(text, path.string(), options);
}

mesh_share read_mesh_share(const std::filesystem::path& path, std::size_t share,
                           std::size_t shares) {
    if (share >= shares)
        throw std::invalid_argument("ccd::io::read_mesh_share: share is " + std::to_string(share) +
                                    "; expected less than " + std::to_string(shares));
    const std::string name = path.string();
    std::error_code failed;
    if (!std::filesystem::is_regular_file(path, failed)) {
        if (!std::filesystem::exists(path, failed)) read_whole(path);  // throws
        throw file_error(name + ": path is not a regular file; expected one, to read shares");
    }
    if (std::filesystem::file_size(path) == 0) return share_of(read_mesh(path), {share, shares});
    namespace shm = boost::interprocess;
    try {
        const shm::file_mapping file(path.string().c_str(), shm::read_only);
        const shm::mapped_region region(file, shm::read_only);
        const std::string_view text(static_cast<const char*>(region.get_address()),
                                    region.get_size());
        if (format_of(path, text) == format::ply)
            return parse_share_ply(text, name, {share, shares});
        return share_of(parse_mesh_obj(text, name), {share, shares});
    } catch (const shm::interprocess_exception& error) {
        throw file_error(name + ": cannot be read: " + error.what());
    }
}

namespace {

struct topology {
    const std::string& name;
    const mesh& elements;
    mesh_share::place vertices, faces, edges;
};

void require_same(const topology& before, const topology& after) {
    const auto require_equal = [&](std::size_t found, std::size_t expected, const char* what) {
        if (found == expected) return;
        throw file_error(after.name + ": number of " + what + " is " + std::to_string(found) +
                         "; expected " + std::to_string(expected) + " as in " + before.name);
    };
    const auto require_equal_elements = [&](const auto& found, const auto& expected,
                                            const std::string& one, std::size_t first) {
        const auto [a, b] = std::ranges::mismatch(found, expected);
        if (a == found.end()) return;
        throw file_error(after.name + ": vertices of " + one + " " +
                         std::to_string(first + static_cast<std::size_t>(a - found.begin())) +
                         " are " + text_of(*a) + "; expected " + text_of(*b) + " as in " +
                         before.name);
    };
    require_equal(after.vertices.all, before.vertices.all, "vertices");
    require_equal(after.faces.all, before.faces.all, "faces");
    require_equal_elements(after.elements.faces, before.elements.faces, "face", before.faces.first);
    require_equal(after.edges.all, before.edges.all, "edges");
    require_equal_elements(after.elements.edges, before.elements.edges, "edge", before.edges.first);
}

topology topology_of(const mesh& frame, const std::string& name) {
    return {
        name, frame, {0, frame.vertices.size()}, {0, frame.faces.size()}, {0, frame.edges.size()}};
}

topology topology_of(const mesh_share& share, const std::string& name) {
    return {name, share.elements, share.vertices, share.faces, share.edges};
}

}  // namespace

void require_same_topology(const mesh& before, const std::string& before_name, const mesh& after,
                           const std::string& after_name) {
    require_same(topology_of(before, before_name), topology_of(after, after_name));
}

void require_same_topology(const mesh_share& before, const std::string& before_name,
                           const mesh_share& after, const std::string& after_name) {
    require_same(topology_of(before, before_name), topology_of(after, after_name));
}

}  // namespace ccd::io
