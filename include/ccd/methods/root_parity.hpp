// `root-parity`: true if the number of contacts is odd (Brochu, Edwards, Bridson 2012).
//
// `collides` is certain. `separate` is not: an even number of contacts within the step is lost.
// Exceptions are contacts at t = 0, at t = 1 or at a border (a vertex or edge of the face, an end
// of an edge). A query is `uncertain`, with cause `range`, only if a coordinate is not finite. The
// spread of the coordinates' exponents bounds time and memory. Allocates if intervals do not
// decide; throws only std::bad_alloc. Requires a sound environment (errbound/environment.hpp) that
// rounds to nearest.
#pragma once

#include <ccd/kind.hpp>
#include <ccd/query.hpp>
#include <ccd/verdict.hpp>

namespace ccd {

template <cubic_query Query>
verdict decide_root_parity(const Query& query);

}  // namespace ccd
