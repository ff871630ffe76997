// The stages of `exact`, one query at a time, in two halves: batches have the first of their own.
// Internal. `report` may be null; if it is not, every stage is counted and timed.
#pragma once

#include <ccd/explain.hpp>
#include <ccd/query.hpp>
#include <ccd/verdict.hpp>

#include "ccd/exact/static_filter/subdivision.hpp"

namespace ccd::detail {

/// The stages from axes to subdivision: `separate` and `collides` are certain, `uncertain` leaves
/// the query to exact arithmetic (cause `range` if a coordinate is not finite or far too large).
/// The same arithmetic as that of the batch kernels. No allocation, never throws. If it is
/// `collides`, `found` says where, if it is not null; it halves parts `deepest` times at most.
verdict decide_in_floating_point(const vertex_face<double>& query, stage_report* report,
                                 static_filter::contact_part* found = nullptr,
                                 std::size_t deepest = static_filter::max_depth);
verdict decide_in_floating_point(const edge_edge<double>& query, stage_report* report,
                                 static_filter::contact_part* found = nullptr,
                                 std::size_t deepest = static_filter::max_depth);

/// The other stages: integers of fixed width, then of unbounded width.
verdict decide_exactly(const vertex_face<double>& query, stage_report* report);
verdict decide_exactly(const edge_edge<double>& query, stage_report* report);
verdict decide_exactly(const vertex_edge<double>& query, stage_report* report);
verdict decide_exactly(const vertex_vertex<double>& query, stage_report* report);

}  // namespace ccd::detail
