// The faces around each vertex. If they form a fan, one test in linear time proves that no two of
// them intersect.
//
// Claim: let faces (v, w_0, w_1), (v, w_1, w_2), ..., (v, w_n-1, w_n) have different w_i, or only
// w_0 = w_n (a closed fan). Let their projections along an axis have areas of one sign, and turn
// around v by 2π at most, by less if the fan is open. Then two of the faces share only their common
// vertices and edges.
// Proof: angles of the projections at v are less than π and follow each other. So the projected
// cones do not overlap, and two of them share v, or v and the ray through one w_i. This ray does
// not pass through another w_j: it would bound two cones at w_i and two at w_j, of which two
// overlap. The projection is injective on each face: two faces share v only, or points of their
// edge v w_i.
#pragma once

#include <array>
#include <ccd/kind.hpp>
#include <ccd/mesh.hpp>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace ccd::detail {

/// Three vertices stand for a triangle, an edge or a single vertex, which repeat a vertex.
constexpr bool is_triangle(const face& f) {
    return f[0] != f[1] && f[1] != f[2] && f[2] != f[0];
}
/// Calls visit(v) for each of its vertices, once.
template <class Visit>
constexpr void for_each_vertex(const face& f, const Visit& visit) {
    visit(f[0]);
    if (f[1] != f[0]) visit(f[1]);
    if (f[2] != f[0] && f[2] != f[1]) visit(f[2]);
}

/// Memory: 12 bytes a face and 13 a vertex.
class vertex_fans {
  public:
    /// Elements of fewer than three vertices repeat one. Cost: O(n log n) in the elements of each
    /// vertex.
    vertex_fans(std::span<const face> elements, std::size_t vertices);

    /// True if it is certain that no two elements with vertex v intersect: they share only vertices
    /// and edges of both. False if that is not known. `positions` are rows x y z.
    bool certainly_free(vertex_index v, const double* positions) const {
        return kinds_[v] == around::one ||
               (kinds_[v] != around::others && is_flat_fan(v, positions));
    }

  private:
    enum class around : std::uint8_t { one, closed_fan, open_fan, others };
    struct corner {
        vertex_index from, to;
    };

    static bool are_closed(std::span<corner> corners, std::span<vertex_index> ring);
    static around kind_of_corners(std::span<corner> corners, std::span<vertex_index> ring);
    bool is_flat_fan(vertex_index v, const double* positions) const;

    std::vector<around> kinds_;
    std::vector<std::size_t> starts_;  ///< of each vertex' ring
    std::vector<vertex_index> ring_;   ///< of fans: w_0, ..., w_n
};

}  // namespace ccd::detail
