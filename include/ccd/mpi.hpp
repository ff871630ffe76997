// Steps of meshes that are spread over the ranks of MPI. Target: errbound::ccd_mpi.
//
// Each rank gives what it has: faces and edges, the numbers of their vertices in the whole mesh,
// and positions before and after the step. For this step alone space is cut into a box a rank, by
// recursive coordinate bisection (Berger, Bokhari 1987) of a sample of all elements, weighted by
// the work that they are expected to make. Elements go to each rank whose box the box that they
// sweep meets, so that of each pair some rank has both; the rank decides it in whose box the pair
// begins (ccd::pair_filter::part), which no message is needed for. Pairs then go where their first
// element came from, or all to rank 0.
//
// What comes out is what ccd::step finds of the whole mesh, whatever the number of ranks and who
// has what: pairs, times, the first contact, candidates.
//
// All calls are collective: every rank of the communicator makes them, with the same options. What
// one rank finds wrong is thrown on all, with that rank's message.
#pragma once

#include <mpi.h>

#include <array>
#include <ccd/advance.hpp>
#include <ccd/kind.hpp>
#include <ccd/mesh.hpp>
#include <ccd/step.hpp>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace ccd::mpi {

/// Names a vertex of the whole mesh. Any numbers will do, gaps included.
using vertex_number = std::uint64_t;

/// What one rank has of the mesh. A vertex may be on many ranks, with the same positions; so may a
/// face or an edge, and counts once.
struct mesh_part {
    std::span<const vertex_number> numbers;  ///< of the vertices that this rank has, each once
    vertex_rows positions;                   ///< of these vertices
    std::span<const face> faces = {};        ///< by place in `numbers`
    std::span<const edge> edges = {};        ///< likewise; those of faces need not be given
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

/// Where a step's pairs are wanted.
enum class placement : std::uint8_t {
    owners,  ///< on the lowest rank that has the pair's first element
    root     ///< all on rank 0
};

/// What a step took of this rank.
struct rank_work {
    std::uint64_t elements_given = 0;  ///< faces, edges and vertices without one, as given
    std::uint64_t elements_held = 0;   ///< those sent to it, by itself too
    std::uint64_t bytes_sent = 0;      ///< to other ranks
    double seconds = 0;
};

struct step_result {
    pair_lists pairs;              ///< those of this rank, sorted
    pair_lists touching_at_start;  ///< of `pairs`, if asked for
    time_lists times;              ///< of `pairs`, if asked for
    first_time first_contact;      ///< of the whole step, the same on all ranks, if asked for
    std::optional<pair_counts> candidates;  ///< of the whole step, if asked for
    std::optional<pair_counts> decided;     ///< of those, the ones that this rank decided
    rank_work work;
};

/// One step. Options mean what they mean to ccd::step; groups, pinned flags and thicknesses are
/// those of mesh.numbers; can_collide and part must not be given. options.threads counts for each
/// rank.
///
/// Throws std::invalid_argument on all ranks if one of them finds: what ccd::mesh_steps would not
/// take, a number given twice, a vertex with other positions (groups, flags, thicknesses) than
/// elsewhere, or more than 2^32 − 1 vertices in its box.
///
/// Memory of a rank: 56 bytes a vertex and 24 a face that it sends and receives, what
/// ccd::mesh_steps takes for the elements that meet its box, and 64 bytes for each of 4,096
/// samples, or of 64 a rank. Messages: to and from every rank that has elements of its box.
step_result step(MPI_Comm comm, const mesh_part& mesh, const step_options& options = {},
                 placement pairs = placement::owners);

struct advance_result {
    std::vector<point<double>> positions;  ///< of mesh.numbers
    double fraction = 1;                   ///< the least of the whole mesh, the same on all ranks
    std::vector<double> fractions;         ///< of mesh.numbers
    first_time first_contact;              ///< of the whole step, the same on all ranks
    pair_lists touching_at_start, near_at_start;  ///< of the whole mesh, sorted, on all ranks
    rank_work work;
};

/// What ccd::advance of the whole mesh returns, bit for bit, if numbers order vertices as indices
/// do there. Options mean what they mean to it: options.groups and the filter's are those of
/// mesh.numbers, the same number being the same group on every rank; can_collide and part must not
/// be given.
///
/// Throws as ccd::mpi::step, and ccd::stopped on all ranks where options.stop says so on one.
///
/// Memory: that of a step; and, on every rank, the pairs of the whole mesh that touch or are near
/// at the start, those that meet by rounding, and, where groups are given, all that meet.
advance_result advance(MPI_Comm comm, const mesh_part& mesh, const advance_options& options = {});

}  // namespace ccd::mpi
