// `exact`: no false negative, no false positive, on any finite input.
//
// Closed semantics: a query collides when the two closed features share a point at some t in the
// closed interval [0, 1]; a degenerate triangle or edge is the segment or point that it is.
//
// Vertex/face and edge/edge queries pass the stages of ccd/explain.hpp and leave at the first that
// is certain: floating point under static error bounds decides nearly all, in some ten to a hundred
// nanoseconds. What remains is decided in integers of fixed width where the coordinates allow it:
// where, on each axis and at each end of the step, they differ by less than 2^253 of their last
// place. (Cloth scenes need 21 to 35 bits, the public benchmark's handcrafted queries up to 110.)
// That takes a fraction of a microsecond to a few, some tens where roots nearly coincide, without
// allocation. Else the reference decides (ccd/reference.hpp): it takes up to a thousand times as
// long, bounded in time and memory, allocates, and throws only std::bad_alloc, or
// aborts there if built with GMP.
// Coordinates must be finite: otherwise the answer is `uncertain` with cause `range`, the only case
// in which it is not certain.
// Promised in a sound environment (errbound/environment.hpp): no flush-to-zero.
#pragma once

#include <ccd/explain.hpp>
#include <ccd/query.hpp>
#include <ccd/verdict.hpp>

namespace ccd {

/// What the stages did is added to `report`, if given: that costs some 50 ns a stage. Worst known
/// (./run bench --worst): some 50 microseconds where coordinates are of 1e-3 to 1e3, a tenth of a
/// second where they are of all magnitudes.
verdict decide_exact(const vertex_face<double>& query, stage_report* report = nullptr);
verdict decide_exact(const edge_edge<double>& query, stage_report* report = nullptr);
verdict decide_exact(const vertex_edge<double>& query);
verdict decide_exact(const vertex_vertex<double>& query);

/// Whether the features touch already at t = 0: tells initial contact from a later impact.
verdict touches_at_start(const vertex_face<double>& query);
verdict touches_at_start(const edge_edge<double>& query);
verdict touches_at_start(const vertex_edge<double>& query);
verdict touches_at_start(const vertex_vertex<double>& query);

}  // namespace ccd
