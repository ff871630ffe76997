// Triangle meshes: what a frame holds, and what one step of a mesh asks.
#pragma once

#include <array>
#include <ccd/kind.hpp>
#include <ccd/query.hpp>
#include <vector>

namespace ccd {

using face = std::array<index, 3>;  ///< vertex indices in the file's order
using edge = std::array<index, 2>;  ///< vertex indices, ascending

/// One frame. `faces` index `vertices`; the reader checks that they are in range.
struct mesh {
    std::vector<point<double>> vertices;
    std::vector<face> faces;
};

/// The mesh's unique edges, each ascending, sorted; a vertex repeated within a face makes no edge.
/// Cost: O(faces) unless very many of them share a vertex; memory: 36 bytes a face and 8 a vertex.
std::vector<edge> unique_edges(const std::vector<face>& faces);

}  // namespace ccd
