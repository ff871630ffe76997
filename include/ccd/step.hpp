// One step of a mesh: from positions at two times to the colliding pairs.
//
// Pairs are those of two elements that share no vertex, of four kinds:
//
//   vertex/face    every vertex, every face
//   edge/edge      every two edges, of faces or not
//   vertex/edge    every point (a vertex on no edge), every edge that bounds no face
//   vertex/vertex  every two points
//
// These are enough: where two elements (faces, edges that bound no face, points) without a common
// vertex first touch, one of their pairs of these kinds does. A point touches a face or an edge of
// a face as vertex/face, another edge as vertex/edge, a point as vertex/vertex. Two edges are a
// pair themselves, their ends included, since edges are closed. An edge that meets a face for the
// first time does so at one of its ends (vertex/face), at the face's boundary (edge/edge), or
// within the face's plane, where both hold; and so for two faces. What is pierced already at t = 0
// is not found before its boundary moves on: start from a state free of intersections.
//
// In the plane a mesh is of edges and points, and pairs of two kinds are enough:
//
//   vertex/edge    every vertex, every edge
//   vertex/vertex  every two points
#pragma once

#include <array>
#include <ccd/batch.hpp>
#include <ccd/contact.hpp>
#include <ccd/first_times.hpp>
#include <ccd/kind.hpp>
#include <ccd/mesh.hpp>
#include <ccd/method.hpp>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace ccd {

/// An axis-aligned part of space, closed below and open above; by default all of it.
struct space_part {
    static constexpr double everywhere = std::numeric_limits<double>::infinity();
    std::array<double, 3> low{-everywhere, -everywhere, -everywhere};
    std::array<double, 3> high{everywhere, everywhere, everywhere};

    bool has(const std::array<double, 3>& x) const {
        for (std::size_t k = 0; k < 3; ++k)
            if (!(low[k] <= x[k] && x[k] < high[k])) return false;
        return true;
    }
};

/// Which pairs a step looks at, vertex by vertex: a pair if some vertex of one element may
/// collide with some vertex of the other. Two vertices may unless one of these says no; an empty
/// one says nothing. Not owned; groups and pinned have one entry a vertex.
struct pair_filter {
    enum class group_rule : std::uint8_t {
        between_groups,  ///< two vertices of one group may not collide
        within_groups,   ///< two vertices of different groups may not collide
    };

    /// Whether two vertices may collide. Called from several threads at once. What it
    /// throws ends the call, and the object of the steps is as before.
    std::function<bool(vertex_index, vertex_index)> can_collide = {};
    std::span<const int> groups = {};  ///< the group of each vertex: its body, its layer, ...
    group_rule rule = group_rule::between_groups;
    /// Not 0: the vertex does not move, or moves as prescribed. Two such may not collide, so pairs
    /// of which all vertices are pinned are left out.
    std::span<const std::uint8_t> pinned = {};
    /// Of what the others let through, only pairs that begin there: at the lower corner of what the
    /// boxes that their elements sweep (wider where pairs have a distance) have in common. So parts
    /// that tile space share all pairs of a step, each of one part; a part needs the elements alone
    /// whose boxes meet it.
    std::optional<space_part> part = {};
    /// Skips the vertices that no face and no edge has (unused_vertices); by default they are
    /// points. A face or an edge that repeats its vertex keeps it a point.
    bool skip_unused = false;
};

struct step_options {
    ccd::method method = ccd::method::exact;
    int threads = 0;                          ///< at most; 0: one per core
    std::optional<instruction_set> set = {};  ///< for `exact`; by default the strongest
    bool count_candidates = false;            ///< fill step_result::candidates
    bool explain = false;  ///< that, and step_result::stages, which other methods have none of
    bool initial_contact = false;  ///< fill step_result::touching_at_start
    bool first_contact = false;    ///< fill step_result::first_contact, and touching_at_start
    bool times = false;            ///< fill step_result::times, and both of these
    double t_max = 1;              ///< report pairs with a contact in [0, t_max] alone
    /// Report, in place of those in contact, pairs that come within a distance; times and what is
    /// there at the start are then of that.
    pair_distances distances = {};
    stop_query stop = {};  ///< ends the call by throwing ccd::stopped
    pair_filter filter = {};
};

namespace detail {
template <kind K>
using count_of_kind = std::size_t;
template <kind K>
using list_of_kind = std::vector<pair_of_kind<K>>;
template <kind K>
using times_of_kind = std::vector<first_time>;
template <kind K>
using block_visitor = std::function<void(std::span<const pair_of_kind<K>>)>;
}  // namespace detail

/// Numbers of pairs: `vertex_face`, `edge_edge`, `vertex_edge`, `vertex_vertex`.
using pair_counts = by_kind<detail::count_of_kind>;

/// Lists of pairs, each sorted: a vertex_face_pair is {v, f0, f1, f2}, an edge_edge_pair
/// {a0, a1, b0, b1} with both edges ascending and the lesser first, a vertex_edge_pair {v, e0, e1}
/// with the edge ascending, a vertex_vertex_pair {v, w} with v < w.
using pair_lists = by_kind<detail::list_of_kind>;

/// How many pairs there are, of all kinds.
inline std::size_t number_of(const pair_lists& pairs) {
    std::size_t number = 0;
    for_each_kind([&]<kind K>() { number += pairs.of<K>().size(); });
    return number;
}

/// The first times of such lists, in their order.
using time_lists = by_kind<detail::times_of_kind>;

/// Called with blocks of up to 2048 pairs, from several threads at once; must not throw. Kinds
/// without one are not looked for.
using candidate_visitor = by_kind<detail::block_visitor>;

struct step_result {
    /// Pairs whose swept boxes touch and that the filter lets through, if counted.
    std::optional<pair_counts> candidates;
    pair_lists pairs;  ///< those reported, the vertices of faces ascending
    /// Those of `pairs` that touch already at t = 0, by `exact` whatever the method; if asked for.
    pair_lists touching_at_start;
    time_lists times;                 ///< of `pairs`, if asked for
    first_time first_contact;         ///< the earliest of those not touching at t = 0, if asked for
    double prepare_seconds = 0;       ///< checks of the input, the mesh's edges
    double broad_phase_seconds = 0;   ///< the search for candidates, less the narrow phase
    double narrow_phase_seconds = 0;  ///< of all threads together, over their number
    double sort_seconds = 0;          ///< of the reported pairs
    double contact_seconds = 0;       ///< of first times, and of what touches at t = 0
    double total_seconds = 0;
    int threads = 0;      ///< used at most
    stage_report stages;  ///< of `exact` for vertex/face and edge/edge pairs, if asked for
};

/// Steps of one mesh: keeps its unique faces and edges, their orders and its memory from step to
/// step. One call at a time.
///
/// Candidates are the pairs (see above) whose swept boxes (closed, exact doubles) touch and that
/// the filter lets through; where pairs have a distance, boxes wider by that, rounded outwards.
/// They are found by trees over the boxes and decided block by block,
/// never stored as a whole. Where nobody asks for them, `exact` leaves out already in the search
/// what some axis separates. Results are the same for every number of threads, and whatever steps
/// went before.
///
/// A face that repeats a vertex is the segment or point that it is, and is paired as any other
/// face. Faces with the same three vertices count once, as do edges: a pair is reported once.
///
/// Vertex/edge and vertex/vertex pairs are always decided by `exact`: no other method has them.
/// Every two points at one place are a pair: n unused vertices make n²/2 pairs if they are all at
/// the origin, unless pair_filter::skip_unused skips them.
///
/// Time: that of the search, and of decide_exact at worst for each candidate; of which there are
/// n²/2 where all elements are at one place.
///
/// Memory: about ten times that of the two frames; where candidates are counted or another method
/// decides, about three times, or four where parts of the mesh are so far apart that floats do not
/// tell their elements' boxes apart; kept.
class mesh_steps {
  public:
    /// Throws std::invalid_argument if an index is not below `vertices`.
    mesh_steps(std::span<const face> faces, std::span<const edge> edges, std::size_t vertices);
    explicit mesh_steps(const mesh& mesh);
    /// Steps in the plane, of edges and points: positions must have z = 0. Throws
    /// std::invalid_argument if an index is not below `vertices`.
    static mesh_steps in_plane(std::span<const edge> edges, std::size_t vertices);
    ~mesh_steps();
    /// What was moved from may only be destroyed or assigned to.
    mesh_steps(mesh_steps&&) noexcept;
    mesh_steps& operator=(mesh_steps&&) noexcept;

    /// The pairs of one step that options.method cannot certify as separate.
    ///
    /// Throws std::invalid_argument if there are not as many positions as vertices or a coordinate
    /// is not finite, or, in the plane, a z not 0; if the method is none, the instruction set not
    /// one of instruction_sets(), or the filter of another length; if times, a t_max below 1 or
    /// distances are asked of a method other than `exact`, or are not what ccd/first_times.hpp
    /// expects.
    step_result run(const vertex_rows& positions, const step_options& options = {});

    /// All candidates of a step, the vertices of faces in the mesh's order, for narrow phases of
    /// one's own. Of the options, `threads`, `stop`, `filter` and `distances` count. Memory: up to
    /// 33 bytes a candidate. Throws as run(); the instruction set is not looked at.
    pair_lists candidates(const vertex_rows& positions, const step_options& options = {});

    /// The same in blocks as they are found, in no particular order, never stored as a whole. The
    /// visitor must not wait for other tasks of oneTBB.
    pair_counts for_each_candidate(const vertex_rows& positions, const candidate_visitor& visitor,
                                   const step_options& options = {});

  private:
    struct state;
    explicit mesh_steps(std::unique_ptr<state> state);
    std::unique_ptr<state> state_;
};

/// One step alone: mesh_steps(faces, edges, positions.vertices).run(positions, options). Throws
/// what those throw.
step_result step(std::span<const face> faces, std::span<const edge> edges,
                 const vertex_rows& positions, const step_options& options = {});
/// Of two frames of one mesh, which must have the same faces, edges and numbers of vertices; throws
/// std::invalid_argument otherwise.
step_result step(const mesh& before, const mesh& after, const step_options& options = {});

/// The candidates of one step alone.
pair_lists candidates(std::span<const face> faces, std::span<const edge> edges,
                      const vertex_rows& positions, const step_options& options = {});
pair_lists candidates(const mesh& before, const mesh& after, const step_options& options = {});

}  // namespace ccd
