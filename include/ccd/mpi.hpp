// Steps of meshes that are spread over the ranks of MPI. Target: errbound::ccd_mpi.
//
//     const ccd::mpi::step_result found = ccd::mpi::step(MPI_COMM_WORLD, {numbers, positions,
//     faces});
//
// Each rank passes its faces and edges, the numbers of their vertices in the whole mesh, and
// positions before and after the step. Results are those of ccd::step for the whole mesh, for every
// number of ranks and every distribution. All calls are collective, with the same options on every
// rank. If one rank finds an error, all ranks throw, with that rank's message.
// Method: each step cuts space into a box a rank by recursive coordinate bisection (Berger, Bokhari
// 1987) of a weighted sample of elements. A rank receives the elements whose swept boxes meet its
// box, and decides the pairs that begin in it (ccd::pair_filter::region).
#pragma once

#include <mpi.h>

#include <array>
#include <ccd/advance.hpp>
#include <ccd/intersections.hpp>
#include <ccd/kind.hpp>
#include <ccd/mesh.hpp>
#include <ccd/step.hpp>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace ccd::mpi {

/// The number of a vertex in the whole mesh; numbers may have gaps.
using vertex_number = std::uint64_t;

/// One rank's part of the mesh. Several ranks may have a vertex, with the same positions, or a face
/// or an edge, which counts once.
struct mesh_part {
    std::span<const vertex_number> numbers;  ///< of this rank's vertices, each once
    vertex_rows positions;                   ///< of these vertices
    std::span<const face> faces = {};        ///< indices into `numbers`
    std::span<const edge> edges = {};  ///< indices into `numbers`; edges of faces may be omitted
};

/// The numbers of a pair's vertices, in the order of its kind; those of faces and edges ascend.
template <kind K>
using numbered_pair =
    std::array<vertex_number, kind_traits<K>::first_vertices + kind_traits<K>::second_vertices>;
namespace detail {
template <kind K>
using numbered_list = std::vector<numbered_pair<K>>;
}
using pair_lists = by_kind<detail::numbered_list>;

/// Same as ccd::mesh_element and ccd::intersection, with numbers of vertices.
struct numbered_element {
    std::uint8_t size = 0;
    std::array<vertex_number, 3> numbers{};

    std::span<const vertex_number> vertices() const { return {numbers.data(), size}; }
    friend auto operator<=>(const numbered_element&, const numbered_element&) = default;
};
struct numbered_intersection {
    numbered_element a, b;
    errbound::relation relation = errbound::relation::disjoint;
    std::optional<std::array<errbound::located_point<3>, 2>> segment = {};

    intersection_kind kind() const { return kind_of_sizes(a.size, b.size); }
};

/// The rank that receives a pair.
enum class placement : std::uint8_t {
    owners,  ///< the lowest rank that has the pair's first element
    root     ///< rank 0 receives all
};

/// The work of this rank in a step.
struct rank_work {
    std::uint64_t elements_given = 0;  ///< faces, edges and vertices without one, as passed
    std::uint64_t elements_held = 0;   ///< received, from itself too
    std::uint64_t bytes_sent = 0;      ///< of items, to other ranks
    double seconds = 0;
};

struct step_result {
    pair_lists pairs;                       ///< those of this rank, sorted
    pair_lists touching_at_start;           ///< of `pairs`, with initial_contact
    time_lists times;                       ///< of `pairs`, with step_options::times
    first_time first_contact;               ///< of the whole step, the same on all ranks
    std::optional<pair_counts> candidates;  ///< of the whole step
    std::optional<pair_counts> decided;     ///< by this rank
    /// This rank's share, sorted, with check_start.
    std::vector<numbered_intersection> intersections_at_start;
    rank_work work;
};

/// One step, with the options of ccd::step. Groups, pinned flags and thicknesses are those of
/// mesh.numbers. can_collide and region must be empty. options.threads applies to each rank.
///
/// Throws std::invalid_argument on all ranks if on one of them ccd::mesh_steps would throw it or a
/// number occurs twice. Also throws if ranks have different positions (groups, flags, thicknesses)
/// of a vertex, or if a box has more than 2^32 − 1 vertices.
///
/// Memory of a rank: 56 bytes a vertex and 24 a face that it sends and receives, and that of
/// ccd::mesh_steps for the elements that meet its box. Samples take 64 bytes each. There are up to
/// 256 a rank in all, but at least 4,096 and at most the larger of 2^19 and 64 a rank. Messages: to
/// and from every rank that has elements of its box.
step_result step(MPI_Comm comm, const mesh_part& mesh, const step_options& options = {},
                 placement pairs = placement::owners);

struct advance_result {
    std::vector<point<double>> positions;  ///< of mesh.numbers
    double fraction = 1;                   ///< the least of the whole mesh, the same on all ranks
    std::vector<double> fractions;         ///< of mesh.numbers
    first_time first_contact;              ///< of the whole step, the same on all ranks
    /// Pairs of the whole mesh, sorted, on all ranks.
    pair_lists first_pairs, touching_at_start, near_at_start;
    /// All of the mesh, sorted, on all ranks, with check_start.
    std::vector<numbered_intersection> intersections_at_start;
    rank_work work;
};

/// Returns the result of ccd::advance for the whole mesh, bit for bit, if numbers order vertices as
/// indices do there. Groups (the options' and the filter's) are those of mesh.numbers, with the
/// same index on every rank. can_collide and region must be empty, each_vertex false.
///
/// Throws as ccd::mpi::step, and ccd::stopped on all ranks if options.stop returns true on one.
///
/// Memory: that of a step, and on every rank some pairs of the whole mesh: those that touch or are
/// near at the start, those that meet by rounding, and with groups all that meet.
advance_result advance(MPI_Comm comm, const mesh_part& mesh, const advance_options& options = {});

struct intersection_result {
    std::vector<numbered_intersection> pairs;  ///< those of this rank, sorted
    intersection_counts counts;                ///< of the whole mesh, the same on all ranks
    rank_work work;
};

/// Returns the result of ccd::intersections for the whole mesh at positions.before;
/// positions.after may be null. A pair is on the lowest rank that has its first vertex, or on rank
/// 0. options.wanted must be `all` or `count`; edge_faces and merge_equal_positions must be false.
/// Throws as ccd::mpi::step.
intersection_result intersections(MPI_Comm comm, const mesh_part& mesh,
                                  const intersection_options& options = {},
                                  placement pairs = placement::owners);

}  // namespace ccd::mpi
