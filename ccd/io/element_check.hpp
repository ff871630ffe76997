// What the mesh readers ask of every face and edge.
#pragma once

#include <ccd/io/mesh_file.hpp>
#include <ccd/mesh.hpp>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace ccd::io {

/// The indices, for messages.
std::string text_of(std::span<const vertex_index> element);

/// The end of a message if an element has an index that is not below `vertices`.
std::optional<std::string> fault_of(std::span<const vertex_index> element, std::size_t vertices);

/// Throws errbound::support::file_error with `where` in front unless a face with that many corners
/// can be read.
void check_corners(std::uint64_t corners, const mesh_options& options, const std::string& where);

}  // namespace ccd::io
