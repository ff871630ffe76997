// Exact decisions in integers without allocation: the last stage of `exact` before the reference.
//
// A certain outcome is never wrong. `uncertain` has two causes. `range`: a coordinate is not
// finite, or differences at one end of the step span more than 253 bits and no coordinate separates
// the features. `inside`: a cubic's roots need more bits than ccd/exact/close_contact.hpp uses; no
// search has found such a query. No exceptions. Cost: 0.3 µs for spans up to 61 bits with contact
// at an edge, 1 to 2 µs in general. Spans of 126 to 253 bits take 7 µs, and roots that nearly
// coincide 25 to 60 µs.
#pragma once

#include <ccd/kind.hpp>
#include <ccd/verdict.hpp>

namespace ccd::detail {

template <any_query Query>
verdict decide_in_integers(const Query& query);

}  // namespace ccd::detail
