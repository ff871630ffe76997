// What the mesh readers ask of every face.
#pragma once

#include <ccd/mesh.hpp>
#include <cstddef>
#include <optional>
#include <string>

namespace ccd::io {

/// The three indices, for messages.
std::string text_of(const face& f);

/// Whether a face is one of a mesh of so many vertices; if not, why, as the end of a message.
std::optional<std::string> fault_of(const face& f, std::size_t vertices);

}  // namespace ccd::io
