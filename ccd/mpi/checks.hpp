// Checks the input of ranks. check_... throw std::invalid_argument on all ranks if one of them
// fails; the message names `caller`.
#pragma once

#include <ccd/advance.hpp>
#include <ccd/mpi.hpp>
#include <ccd/step.hpp>
#include <cstdint>
#include <span>
#include <string>

#include "ccd/mpi/exchange.hpp"

namespace ccd::mpi::detail {

/// Lists of options with an entry for each vertex; empty if not given.
struct vertex_lists {
    std::span<const int> groups;             ///< of the filter
    std::span<const std::uint8_t> pinned;    ///< of the filter
    std::span<const double> thickness = {};  ///< of the distances
    std::span<const int> islands = {};       ///< groups that move by one fraction, in an advance

    vertex_lists(const pair_filter& filter, const pair_distances& distances,
                 std::span<const int> moving_as_one = {})
        : groups(filter.groups),
          pinned(filter.pinned),
          thickness(distances.thickness),
          islands(moving_as_one) {}
};

/// All ranks with vertices must have the same lists, with an entry for each vertex. The filter must
/// be one that can be sent.
void check_mesh(exchanger& ranks, const mesh_part& mesh, const pair_filter& filter,
                const vertex_lists& lists, const std::string& caller);

/// All ranks must have the same options.
void check_options(exchanger& ranks, const step_options& options, placement pairs,
                   std::size_t vertices, const std::string& caller);
void check_options(exchanger& ranks, const advance_options& options, std::size_t vertices,
                   const std::string& caller);

/// True if a list was given on some rank. Collective.
bool is_given_anywhere(exchanger& ranks, std::span<const int> list);

}  // namespace ccd::mpi::detail
