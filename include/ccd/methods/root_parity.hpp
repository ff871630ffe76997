// `root-parity`: whether the number of contacts is odd (Brochu, Edwards, Bridson 2012).
//
// `collides` is certain: no false positive on any finite input. `separate` is not: an even number
// of contacts within the step, in and out again or a touch without crossing, is not seen, unless
// one of them is at t = 0, at t = 1, or at a vertex or edge of the face (an end of an edge). A
// coordinate that is not finite: `uncertain` with cause `range`; nothing else is uncertain.
// Time and memory grow with the spread of the coordinates' exponents and are bounded. Allocates
// where the filter cannot tell; throws only std::bad_alloc. Promised in a sound environment
// (errbound/environment.hpp) that rounds to nearest, which intervals need.
#pragma once

#include <ccd/query.hpp>
#include <ccd/verdict.hpp>

namespace ccd {

verdict decide_root_parity(const vertex_face<double>& query);
verdict decide_root_parity(const edge_edge<double>& query);

}  // namespace ccd
