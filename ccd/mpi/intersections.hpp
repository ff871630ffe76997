// Intersections in messages between ranks.
#pragma once

#include <ccd/intersections.hpp>
#include <ccd/mpi.hpp>
#include <vector>

#include "ccd/mpi/exchange.hpp"
#include "ccd/mpi/local_mesh.hpp"

namespace ccd::mpi::detail {

std::vector<numbered_intersection> numbered(const std::vector<intersection>& pairs,
                                            const local_mesh& local);

/// Sends the pairs of this rank to where they belong, and returns those that arrive, sorted.
/// Collective.
std::vector<numbered_intersection> placed(exchanger& ranks, const local_mesh& local,
                                          const std::vector<intersection>& pairs, placement where);

/// Returns the pairs of all ranks, sorted. Collective.
std::vector<numbered_intersection> of_all_ranks(exchanger& ranks, const local_mesh& local,
                                                const std::vector<intersection>& pairs);

}  // namespace ccd::mpi::detail
