// The stages of `exact` for one query, in two halves. Batches have their own first half. Internal.
// If `report` is not null, every stage is counted and timed.
#pragma once

#include <ccd/explain.hpp>
#include <ccd/kind.hpp>
#include <ccd/query.hpp>
#include <ccd/verdict.hpp>

#include "ccd/exact/static_filter/subdivision.hpp"

namespace ccd::detail {

/// Runs the stages from axes to subdivision, with the arithmetic of the batch kernels. `separate`
/// and `collides` are certain; `uncertain` has cause `range` if a coordinate is not finite or far
/// too large. If the outcome is `collides` and `found` is not null, `*found` is the interval of the
/// contact. Halves intervals at most `deepest` times. No allocation, never throws.
template <cubic_query Query>
verdict decide_in_floating_point(const Query& query, stage_report* report,
                                 static_filter::contact_interval* found = nullptr,
                                 std::size_t deepest = static_filter::max_depth);

/// Runs the other stages: integers of fixed width, then of unbounded width.
template <any_query Query>
verdict decide_with_integers(const Query& query, stage_report* report);

}  // namespace ccd::detail
