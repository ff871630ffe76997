// Exact decisions in integers without allocation: the last stage of `exact` before the reference.
//
// Each axis has a power of two as its unit, so that all coordinates are integers. `uncertain` with
// cause `range`: a coordinate is not finite, or the differences of coordinates at one end of the
// step span more than 253 bits and no coordinate separates the features. With cause `inside`: the
// cases that ccd/exact/close_contact.hpp names, which no search has found. A certain outcome is
// never wrong. No allocation, no exceptions. Cost: some 0.3 µs if spans are up to 61 bits and
// contact is at an edge, 1 to 2 µs in general, 7 µs if spans are of 126 to 253 bits, and 25 to 60
// µs if roots nearly coincide.
#pragma once

#include <ccd/kind.hpp>
#include <ccd/verdict.hpp>

namespace ccd::detail {

template <any_query Query>
verdict decide_in_integers(const Query& query);

}  // namespace ccd::detail
