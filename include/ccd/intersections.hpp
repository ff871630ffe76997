// Intersections of a mesh at rest, exact on every finite input.
//
//     const ccd::intersection_result found = ccd::intersections(mesh);
//     for (const auto& [a, b, relation, segment] : found.pairs) ...
//     if (ccd::is_free_of_intersections(mesh)) ...  // stops at the first pair
//
// Elements are faces, edges of no face (rods), and vertices of neither (points). Two intersect if
// they share a point that is on no common vertex or edge. Common vertices have one index; equal
// positions do not suffice. Degenerate elements count as the segments or points that they are. For
// many frames of one mesh, use mesh_steps::intersections. Results do not depend on the number of
// threads, except which pair amount::first finds. Throws std::invalid_argument for bad input.
#pragma once

#include <algorithm>
#include <array>
#include <ccd/execution.hpp>
#include <ccd/kind.hpp>
#include <ccd/mesh.hpp>
#include <ccd/pair_filter.hpp>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <errbound/simplices/types.hpp>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace ccd {

/// A face, edge or vertex: its three, two or one vertices, ascending.
struct mesh_element {
    std::uint8_t size = 0;
    std::array<vertex_index, 3> indices{};  ///< zeros follow the vertices

    std::span<const vertex_index> vertices() const { return {indices.data(), size}; }
    friend auto operator<=>(const mesh_element&, const mesh_element&) = default;
};

/// The kinds of intersecting elements, in the order of reports. Names have the element with fewer
/// vertices first.
enum class intersection_kind : std::uint8_t {
    face_face,
    edge_face,
    vertex_face,
    edge_edge,
    vertex_edge,
    vertex_vertex,
};
inline constexpr std::array intersection_kinds{
    intersection_kind::face_face, intersection_kind::edge_face,   intersection_kind::vertex_face,
    intersection_kind::edge_edge, intersection_kind::vertex_edge, intersection_kind::vertex_vertex};
/// The relations of elements that intersect.
inline constexpr std::array intersection_relations{
    errbound::relation::touching, errbound::relation::overlapping, errbound::relation::crossing};

constexpr std::string_view short_name(intersection_kind k) {
    constexpr std::string_view names[] = {"ff", "ef", "vf", "ee", "ve", "vv"};
    return names[static_cast<std::size_t>(k)];
}
constexpr std::string_view name(intersection_kind k) {
    constexpr std::string_view names[] = {"face_face", "edge_face",   "vertex_face",
                                          "edge_edge", "vertex_edge", "vertex_vertex"};
    return names[static_cast<std::size_t>(k)];
}

/// The kind of elements of a and b vertices, a <= b.
constexpr intersection_kind kind_of_sizes(std::size_t a, std::size_t b) {
    using enum intersection_kind;
    if (a == 3) return face_face;
    if (a == 2) return b == 3 ? edge_face : edge_edge;
    return b == 3 ? vertex_face : b == 2 ? vertex_edge : vertex_vertex;
}

struct intersection {
    mesh_element a, b;  ///< a has fewer vertices; if both have the same number, a is the lesser
    errbound::relation relation = errbound::relation::disjoint;
    /// The ends of the common segment, in lexicographic order, if the pair is crossing and
    /// intersection_options::segments is set; both ends are equal if it is a point.
    std::optional<std::array<errbound::located_point<3>, 2>> segment = {};

    intersection_kind kind() const { return kind_of_sizes(a.size, b.size); }
};

/// An edge, of a face or of none, and a face, without a common vertex. Both ascend.
struct edge_face_pair {
    edge e;
    face f;
    friend auto operator<=>(const edge_face_pair&, const edge_face_pair&) = default;
};

struct intersection_options {
    enum class amount : std::uint8_t {
        all,    ///< fill pairs and counts
        count,  ///< fill counts
        first,  ///< stop at a pair; the number of threads affects which one
    };
    amount wanted = amount::all;
    bool segments = true;     ///< fill intersection::segment
    bool edge_faces = false;  ///< fill edge_faces; not with `first`
    /// Vertices with equal positions count as the first of them. Reports use its index. Costs a new
    /// mesh_steps.
    bool merge_equal_positions = false;
    int threads = 0;                          ///< at most; 0: one per core
    std::optional<instruction_set> set = {};  ///< by default the strongest
    stop_query stop = {};                     ///< ends the call by throwing ccd::stopped
    pair_filter filter = {};
};

/// Numbers of pairs by kind and relation.
class intersection_counts {
  public:
    std::size_t of(intersection_kind k, errbound::relation r) const { return counts_[at(k, r)]; }
    std::size_t of(errbound::relation r) const {
        std::size_t sum = 0;
        for (const intersection_kind k : intersection_kinds) sum += of(k, r);
        return sum;
    }
    std::size_t total() const {
        std::size_t sum = 0;
        for (const errbound::relation r : intersection_relations) sum += of(r);
        return sum;
    }
    void add(intersection_kind k, errbound::relation r, std::size_t n = 1) {
        counts_[at(k, r)] += n;
    }
    intersection_counts& operator+=(const intersection_counts& other) {
        for (std::size_t i = 0; i < counts_.size(); ++i) counts_[i] += other.counts_[i];
        return *this;
    }
    friend bool operator==(const intersection_counts&, const intersection_counts&) = default;

  private:
    static constexpr std::size_t relations = 4;
    static constexpr std::size_t at(intersection_kind k, errbound::relation r) {
        return relations * static_cast<std::size_t>(k) + static_cast<std::size_t>(r);
    }
    std::array<std::size_t, relations * intersection_kinds.size()> counts_{};
};

struct intersection_result {
    std::vector<intersection> pairs;  ///< sorted by kind, a and b
    intersection_counts counts;
    /// All edges and faces without a common vertex that share a point, sorted. The filter applies
    /// to these pairs as to others.
    std::vector<edge_face_pair> edge_faces;
    double seconds = 0;

    bool is_free() const { return counts.total() == 0; }
};

/// Returns the pairs of elements that intersect.
///
/// Faces with the same vertices are no pair and count once, as do equal edges. Elements whose
/// vertices are all vertices of the other are no pair. The filter's region refers to the boxes of
/// the elements.
///
/// Throws std::invalid_argument if an index is not below the number of vertices, or for 2^32 or
/// more vertices, faces or edges. Also throws if a coordinate is not finite, or the number of
/// groups or flags is not that of the vertices. Also throws if the group rule or instruction set
/// does not exist.
///
/// Cost: trees over the elements, and their search. Faces around a vertex are tested together, in
/// linear time, if they form a fan that projects along a coordinate axis without overlap;
/// otherwise, n faces around a vertex are n²/2 pairs. Memory: some 170 bytes an element, in
/// addition to the result.
intersection_result intersections(const mesh& mesh, const intersection_options& options = {});
intersection_result intersections(std::span<const face> faces, std::span<const edge> edges,
                                  std::span<const point<double>> positions,
                                  const intersection_options& options = {});

/// True if there is no such pair. Stops at the first pair found.
bool is_free_of_intersections(const mesh& mesh, intersection_options options = {});

}  // namespace ccd
