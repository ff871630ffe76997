// `bsc-exact`: BSC in interval arithmetic first, then over integers of unbounded size.
//
// No false negative and no false positive on any finite input. A coordinate that is not finite:
// `uncertain` with cause `range`, the only case in which the answer is not certain. Time and memory
// grow with the spread of the coordinates' exponents and are bounded. Allocates where the filter
// cannot tell; throws only std::bad_alloc. Promised in a sound environment
// (errbound/environment.hpp) that rounds to nearest, which intervals need.
// Source: Tang, Tong, Wang, Manocha 2014, as the evaluation of Wang, Tang, Manocha, Tong 2015 uses
// it (interval filter and exact arithmetic).
#pragma once

#include <ccd/query.hpp>
#include <ccd/verdict.hpp>

namespace ccd {

verdict decide_bsc_exact(const vertex_face<double>& query);
verdict decide_bsc_exact(const edge_edge<double>& query);

}  // namespace ccd
