// Our OBJ reader beside tinyobjloader's.
#pragma once

#include <span>
#include <string_view>

#include "tests/ccd/io/peers/difference.hpp"

namespace ccd::peers {

/// How we read a text and tinyobjloader reads `given`. Coordinates agree where they differ by less
/// than tinyobjloader, which adds up digits in doubles, may be off.
outcome compare_obj(std::string_view text, std::string_view given);

std::span<const rewriting> obj_rewritings();
std::span<const difference> obj_differences();

}  // namespace ccd::peers
