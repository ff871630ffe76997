// Other libraries that find the faces of a mesh that intersect.
#pragma once

#include <ccd/mesh.hpp>
#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

namespace bench {

/// Two faces by index, ascending; sorted pairs.
using face_pairs = std::vector<std::pair<std::size_t, std::size_t>>;

/// Passes of CGAL's self_intersections, which writes `pairs`, and of does_self_intersect, on one
/// thread. Precondition: no edge belongs to more than two faces.
std::vector<std::function<void()>> cgal_passes(const ccd::mesh& mesh, face_pairs& pairs);

}  // namespace bench
