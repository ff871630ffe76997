// The data of one query, for batches and meshes. Internal.
#pragma once

#include <ccd/kind.hpp>
#include <ccd/mesh.hpp>
#include <ccd/nearness.hpp>
#include <ccd/query.hpp>

namespace ccd::detail {

/// The data of a pair of vertices at the start: nearness_of(query_of(positions, pair)).
template <any_pair Pair>
nearness nearness_at_start(const double* positions, const Pair& pair);

}  // namespace ccd::detail
