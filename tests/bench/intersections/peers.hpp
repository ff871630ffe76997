// Other libraries that find the faces of a mesh that intersect.
#pragma once

#include <ccd/mesh.hpp>
#include <cstddef>
#include <utility>
#include <vector>

namespace bench {

/// Two faces by index, ascending.
using face_pairs = std::vector<std::pair<std::size_t, std::size_t>>;

struct peer_result {
    double all_seconds = 0, any_seconds = 0;  ///< least of the runs
    face_pairs pairs;                         ///< sorted
};

/// CGAL's self_intersections and does_self_intersect on one thread. Precondition: no edge belongs
/// to more than two faces.
peer_result intersections_by_cgal(const ccd::mesh& mesh, int repeats);

}  // namespace bench
