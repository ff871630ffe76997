// Our PLY reader beside CGAL's.
#pragma once

#include <span>
#include <string_view>

#include "tests/ccd/io/peers/difference.hpp"

namespace ccd::peers {

/// How we read a text and CGAL reads `given`: vertices bit for bit and faces, for CGAL skips edges.
outcome compare_ply(std::string_view text, std::string_view given);

std::span<const rewriting> ply_rewritings();
std::span<const difference> ply_differences();

}  // namespace ccd::peers
