// `bsc-exact`: BSC in interval arithmetic, then over integers of unbounded size.
//
// No false negative and no false positive on any finite input; `uncertain`, with cause `range`,
// only if a coordinate is not finite. Time and memory grow with the spread of the coordinates'
// exponents and are bounded. Allocates if the intervals do not decide; throws only std::bad_alloc.
// Requires a sound environment (errbound/environment.hpp) that rounds to nearest.
// Source: Tang, Tong, Wang, Manocha 2014, as evaluated in Wang, Tang, Manocha, Tong 2015 (interval
// filter and exact arithmetic).
#pragma once

#include <ccd/kind.hpp>
#include <ccd/query.hpp>
#include <ccd/verdict.hpp>

namespace ccd {

template <cubic_query Query>
verdict decide_bsc_exact(const Query& query);

}  // namespace ccd
