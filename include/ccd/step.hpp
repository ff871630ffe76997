// One step of a mesh: from positions at two times to the colliding pairs.
//
//     const ccd::step_result found = ccd::step(before, after);  // two frames of a ccd::mesh
//     for (const auto& [v, f0, f1, f2] : found.pairs.vertex_face) ...
//
// For many steps of one mesh, use mesh_steps. A pair is two elements without a common vertex:
// vertex/face, edge/edge and, in meshes with rods or points, vertex/edge and vertex/vertex. When
// two elements first touch, such a pair touches (docs/collision-detection.md, Steps of a mesh).
// Elements that intersect at t = 0 are among the pairs only if a vertex touches a face, or edges
// touch. An edge that goes through the inside of a face throughout is in no pair;
// step_options::check_start reports it. Results do not depend on the number of threads. Throws
// std::invalid_argument for bad input.
#pragma once

#include <ccd/batch.hpp>
#include <ccd/contact.hpp>
#include <ccd/intersections.hpp>
#include <ccd/kind.hpp>
#include <ccd/mesh.hpp>
#include <ccd/method.hpp>
#include <ccd/pair_filter.hpp>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace ccd {

struct step_options {
    ccd::method method = ccd::method::exact;
    int threads = 0;                          ///< at most; 0: one per core
    std::optional<instruction_set> set = {};  ///< for `exact`; by default the strongest
    bool count_candidates = false;            ///< fill step_result::candidates
    bool explain = false;          ///< fill candidates, and for `exact` step_result::stages
    bool initial_contact = false;  ///< fill step_result::touching_at_start
    bool first_contact = false;    ///< fill step_result::first_contact, and touching_at_start
    bool times = false;            ///< fill times, first_contact and touching_at_start
    bool check_start = false;      ///< fill step_result::intersections_at_start
    /// Also test rods with a common vertex: the other end of each against the other rod. Not with
    /// distances: run() then throws. An end that meets the common vertex is in contact. Without
    /// effect in the plane, where all these pairs are tested. Cost: n rods at a vertex make n²
    /// pairs.
    bool adjacent_rods = false;
    double t_max = 1;  ///< report only pairs with a contact in [0, t_max]
    /// Report pairs within a distance instead of pairs in contact, also in times and
    /// touching_at_start.
    pair_distances distances = {};
    stop_query stop = {};  ///< ends the call by throwing ccd::stopped
    pair_filter filter = {};
};

namespace detail {
class short_steps;

template <kind K>
using count_of_kind = std::size_t;
template <kind K>
using list_of_kind = std::vector<pair_of_kind<K>>;
template <kind K>
using times_of_kind = std::vector<first_time>;
template <kind K>
using block_visitor = std::function<void(std::span<const pair_of_kind<K>>)>;
}  // namespace detail

using pair_counts = by_kind<detail::count_of_kind>;

/// Lists of pairs, each sorted. A vertex_face_pair is {v, f0, f1, f2}. An edge_edge_pair is
/// {a0, a1, b0, b1} with both edges ascending and the lesser first. A vertex_edge_pair is
/// {v, e0, e1} with the edge ascending, a vertex_vertex_pair {v, w} with v < w.
using pair_lists = by_kind<detail::list_of_kind>;

inline std::size_t number_of(const pair_lists& pairs) {
    std::size_t number = 0;
    for_each_kind([&]<kind K>() { number += pairs.of<K>().size(); });
    return number;
}

using time_lists = by_kind<detail::times_of_kind>;

/// Callbacks for blocks of up to 2048 pairs, called from several threads at once; they must not
/// throw. Kinds without a callback are not searched.
using candidate_visitor = by_kind<detail::block_visitor>;

struct step_result {
    /// With count_candidates or explain; mesh_steps defines candidates.
    std::optional<pair_counts> candidates;
    pair_lists pairs;  ///< the reported pairs, vertices of faces ascending
    /// The members of `pairs` that touch at t = 0 (with distances: are within their distance), by
    /// `exact` for every method; a pair that the method loses is missing. Filled only if
    /// initial_contact, first_contact, times or t_max < 1 is given.
    pair_lists touching_at_start;
    time_lists times;  ///< of `pairs`, with step_options::times
    /// The earliest not at t = 0; `separate` if there is none. `uncertain` unless first_contact,
    /// times or t_max < 1 is given.
    first_time first_contact;
    pair_lists first_pairs;  ///< the members of `pairs` with that time
    /// With check_start: the mesh's intersections at t = 0, as mesh_steps::intersections reports
    /// them, but without segments.
    std::vector<intersection> intersections_at_start;
    double prepare_seconds = 0;       ///< input checks, the mesh's edges
    double broad_phase_seconds = 0;   ///< the search for candidates, without the narrow phase
    double narrow_phase_seconds = 0;  ///< the sum over threads, divided by their number
    double sort_seconds = 0;          ///< sorting the reported pairs
    double contact_seconds = 0;       ///< first times, and pairs that touch at t = 0
    double start_seconds = 0;         ///< intersections at t = 0
    double total_seconds = 0;
    int threads = 0;      ///< the most threads that the call could use
    stage_report stages;  ///< of `exact` for vertex/face and edge/edge pairs, with explain
};

/// Same as mesh_steps(faces, edges, positions.vertices).run(positions, options). For two frames of
/// one mesh, throws std::invalid_argument also if they differ in faces, edges or number of
/// vertices.
step_result step(std::span<const face> faces, std::span<const edge> edges,
                 const vertex_rows& positions, const step_options& options = {});
step_result step(const mesh& before, const mesh& after, const step_options& options = {});

/// Steps of one mesh. Keeps the unique faces and edges, their order in the search, and allocated
/// memory from step to step. One call at a time. Results do not depend on earlier steps.
///
/// After a step by `exact` without distances and filter, in which some vertices rest, it also keeps
/// the positions at the end and the pairs. If most vertices then rest at these positions, bit for
/// bit, a step searches only the vertex/face and edge/edge pairs with a moving vertex.
///
/// An element's swept box is the least box along the axes that contains it at every t. Candidates
/// are the pairs that the filter keeps and whose swept boxes touch, borders included. With
/// distances, boxes are first widened by each element's thickness, or by half of `all`, rounded
/// outwards. Trees over the boxes, rounded to floats, find pairs, whose exact
/// boxes are then compared. Candidates are decided in blocks and not all
/// stored. Without distances, count_candidates and explain, `exact` discards most candidates, those
/// that an axis separates, during the search of the trees.
///
/// A face that repeats a vertex counts as a segment or point, and is paired as any other face.
/// Faces with the same vertices count once, as do equal edges. All methods decide vertex/edge and
/// vertex/vertex pairs by `exact`.
///
/// Cost: the search, and decide_exact for each candidate. Elements at one position are all
/// candidates: n unused vertices at the origin make n²/2 pairs, unless skip_unused skips them.
/// Memory, kept between steps, in addition to two `mesh` frames and the result: up to nine times
/// these frames. With count_candidates, explain or a method other than `exact`, it is up to three
/// times these frames. Vertices at rest add 24 bytes a vertex and a copy of the pairs, and during a
/// step up to 40 bytes a face. Trees hold doubles instead of floats with distances, and for a mesh
/// so far from the origin that floats cannot separate its boxes.
class mesh_steps {
  public:
    /// Throws std::invalid_argument if an index is not below `vertices`, or for 2^32 or more
    /// vertices, faces or edges.
    mesh_steps(std::span<const face> faces, std::span<const edge> edges, std::size_t vertices);
    explicit mesh_steps(const mesh& mesh);
    /// Steps in the plane: positions must have z = 0. Pairs are vertex/edge (every vertex, every
    /// edge) and vertex/vertex (every two points). Throws as the constructor.
    static mesh_steps in_plane(std::span<const edge> edges, std::size_t vertices);
    ~mesh_steps();
    /// A moved-from object may only be destroyed or assigned to.
    mesh_steps(mesh_steps&&) noexcept;
    mesh_steps& operator=(mesh_steps&&) noexcept;

    /// Returns the pairs of one step that options.method does not certify as separate.
    ///
    /// Throws std::invalid_argument if positions are null or a coordinate is not finite. Also
    /// throws if the number of positions, groups or pinned flags is not that of the vertices. Also
    /// throws if t_max is not finite, distances are not valid, or z is not 0 in the plane. Also
    /// throws if the method, group rule or instruction set does not exist. Also throws if a method
    /// other than `exact` has times, first_contact, t_max < 1 or distances, or adjacent_rods has
    /// distances.
    step_result run(const vertex_rows& positions, const step_options& options = {});

    /// Returns all candidates of a step, for custom narrow phases; vertices of faces keep the
    /// mesh's order. Uses `threads`, `stop`, `filter` and `distances` of the options. Memory: up to
    /// 33 bytes a candidate. Throws as run(), but ignores the instruction set.
    pair_lists candidates(const vertex_rows& positions, const step_options& options = {});

    /// Visits the candidates, unordered, and returns their numbers. The visitor must not wait for
    /// other tasks of oneTBB.
    pair_counts for_each_candidate(const vertex_rows& positions, const candidate_visitor& visitor,
                                   const step_options& options = {});

    /// Same as ccd::intersections for the mesh of these steps at positions.before; positions.after
    /// may be null. In the plane, pairs are of edges and points.
    intersection_result intersections(const vertex_rows& positions,
                                      const intersection_options& options = {});

  private:
    friend class detail::short_steps;
    struct state;
    explicit mesh_steps(std::unique_ptr<state> state);
    std::unique_ptr<state> state_;
};

/// Same as mesh_steps::candidates.
pair_lists candidates(std::span<const face> faces, std::span<const edge> edges,
                      const vertex_rows& positions, const step_options& options = {});
pair_lists candidates(const mesh& before, const mesh& after, const step_options& options = {});

}  // namespace ccd
