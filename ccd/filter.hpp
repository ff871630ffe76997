// The floating-point stages of `exact`, one query at a time. Internal.
#pragma once

#include <ccd/explain.hpp>
#include <ccd/query.hpp>
#include <ccd/verdict.hpp>

namespace ccd {

/// `separate` and `collides` are certain; `uncertain` leaves the query to exact arithmetic (cause
/// `range` if a coordinate is not finite). The same answers as those of the batch kernels, but for
/// queries that a full buffer makes them give up. `report` may be null; if it is not, every stage
/// is counted and timed. No allocation, never throws.
verdict filter(const vertex_face<double>& query, stage_report* report);
verdict filter(const edge_edge<double>& query, stage_report* report);

}  // namespace ccd
