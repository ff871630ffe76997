// Meshes: what a frame holds, faces, edges of their own and points.
#pragma once

#include <array>
#include <ccd/kind.hpp>
#include <ccd/query.hpp>
#include <cstddef>
#include <span>
#include <vector>

namespace ccd {

using face = std::array<vertex_index, 3>;  ///< vertex indices, in any order
using edge = std::array<vertex_index, 2>;  ///< vertex indices; ascending where the library makes it

/// One frame: triangles, edges that bound no triangle (rods, hair, springs), and points.
///
/// `edges` are those beside the faces' own, in any order; an edge that a face has, that is given
/// twice or that repeats a vertex adds nothing. Every vertex that is on no edge, its own or a
/// face's, is a point (a particle), also one that no element has: see pair_filter::skip_unused.
struct mesh {
    std::vector<point<double>> vertices;
    std::vector<face> faces;
    std::vector<edge> edges = {};
};

/// The unique edges of faces and of `edges`, each ascending, sorted; a vertex repeated within a
/// face or an edge makes no edge. Cost: O(faces + edges) unless very many of them share a vertex;
/// memory: 36 bytes a face, 12 an edge and 8 a vertex.
std::vector<edge> unique_edges(std::span<const face> faces, std::span<const edge> edges = {});

/// The faces, in their order, without those that have the same three vertices, in any order, as one
/// before. Cost and memory: as unique_edges.
std::vector<face> unique_faces(std::span<const face> faces);

/// The vertices that no face and no edge has, ascending. Indices must be in range.
std::vector<vertex_index> unused_vertices(std::span<const face> faces, std::span<const edge> edges,
                                          std::size_t vertices);

/// Of each vertex, the number of the connected part of the mesh that it belongs to: bodies, if they
/// share no vertex. Numbered in the order of their first vertices. Indices must be in range.
std::vector<int> connected_parts(std::span<const face> faces, std::span<const edge> edges,
                                 std::size_t vertices);

}  // namespace ccd
