// What the mesh readers ask of every face and edge.
#pragma once

#include <ccd/mesh.hpp>
#include <cstddef>
#include <optional>
#include <span>
#include <string>

namespace ccd::io {

/// The indices, for messages.
std::string text_of(std::span<const vertex_index> element);

/// Whether a face or an edge is one of a mesh of so many vertices; if not, why, as the end of a
/// message.
std::optional<std::string> fault_of(std::span<const vertex_index> element, std::size_t vertices);

}  // namespace ccd::io
