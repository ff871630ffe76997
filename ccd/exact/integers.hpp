// Exact decisions in integers without allocation: the last stage of `exact` before the reference.
//
// Each axis gets a power of two as its unit, so that all coordinates are whole. Where differences
// of coordinates at one end of the step span at most 253 bits of it, vertex/edge and vertex/vertex
// queries are always decided, and all others but what ccd/exact/close_contact.hpp names, which no
// search has found yet: that is `uncertain` with cause `inside`. A larger span, unless a
// coordinate separates the features, or a coordinate that is not finite: `uncertain` with cause
// `range`. A certain outcome is never wrong.
//
// No allocation, no exceptions. Cost: some 0.3 microseconds where spans are up to 61 bits and
// contact is at an edge, 1 to 2 in general, 7 where they are of 126 to 253 bits, and 25 to 60 where
// roots nearly coincide.
#pragma once

#include <ccd/query.hpp>
#include <ccd/verdict.hpp>

namespace ccd::detail {

verdict decide_in_integers(const vertex_face<double>& query);
verdict decide_in_integers(const edge_edge<double>& query);
verdict decide_in_integers(const vertex_edge<double>& query);
verdict decide_in_integers(const vertex_vertex<double>& query);

}  // namespace ccd::detail
