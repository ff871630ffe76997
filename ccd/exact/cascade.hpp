// The stages of `exact`, one query at a time. Internal.
//
// `report` may be null; if it is not, every stage is counted and timed.
#pragma once

#include <ccd/explain.hpp>
#include <ccd/query.hpp>
#include <ccd/verdict.hpp>

namespace ccd {

/// The floating-point stages: `separate` and `collides` are certain, `uncertain` leaves the query
/// to exact arithmetic (cause `range` if a coordinate is not finite or far too large). The same
/// arithmetic as that of the batch kernels. No allocation, never throws.
verdict filter(const vertex_face<double>& query, stage_report* report);
verdict filter(const edge_edge<double>& query, stage_report* report);

/// The exact stages: integers of fixed size, then of unbounded size.
verdict settle(const vertex_face<double>& query, stage_report* report);
verdict settle(const edge_edge<double>& query, stage_report* report);

}  // namespace ccd
