// `bsc-exact`: BSC in interval arithmetic, then over integers of unbounded size.
//
// No false negative and no false positive on any finite input. Cost, requirements and `uncertain`
// are as for `root-parity` (ccd/methods/root_parity.hpp). Source: Tang, Tong, Wang, Manocha 2014,
// as evaluated in Wang, Tang, Tong, Manocha 2015 (interval filter and exact arithmetic).
#pragma once

#include <ccd/kind.hpp>
#include <ccd/query.hpp>
#include <ccd/verdict.hpp>

namespace ccd {

template <cubic_query Query>
verdict decide_bsc_exact(const Query& query);

}  // namespace ccd
