// Exact decisions in integers of fixed width: the last stage of `exact` before the reference.
//
// Each axis gets a power of two as its unit, so that all coordinates are whole. Where differences
// of coordinates at one end of the step span at most 125 bits of it, the answer is exact but for a
// case that is rare and told apart: then the outcome is `uncertain` with cause `inside` (roots that
// nearly coincide, or an N that vanishes inside the step where Y does, without contact at an edge).
// A larger span, or a coordinate that is not finite: `uncertain` with cause `range`. A certain
// outcome is never wrong.
//
// No allocation, no exceptions. Cost: a fraction of a microsecond where spans are up to 61 bits, a
// few times that above; at most some 20 microseconds.
#pragma once

#include <ccd/query.hpp>
#include <ccd/verdict.hpp>

namespace ccd {

verdict decide_integers(const vertex_face<double>& query);
verdict decide_integers(const edge_edge<double>& query);
verdict decide_integers(const vertex_edge<double>& query);
verdict decide_integers(const vertex_vertex<double>& query);

}  // namespace ccd
