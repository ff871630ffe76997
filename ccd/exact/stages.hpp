// The stages of `exact` for one query, in two halves. Batches have their own first half. Internal.
#pragma once

#include <ccd/explain.hpp>
#include <ccd/kind.hpp>
#include <ccd/query.hpp>
#include <ccd/verdict.hpp>

#include "ccd/exact/static_filter/subdivision.hpp"

namespace ccd::detail {

/// Runs the stages from axes to subdivision, as the batch kernels do. `separate` and `collides` are
/// certain; `uncertain` has cause `range` if a coordinate is not finite or far too large. Sets
/// `*found` if the query `collides`. Halves intervals at most `deepest` times. No allocation, never
/// throws.
template <cubic_query Query>
verdict decide_in_floating_point(const Query& query, stage_report* report,
                                 static_filter::contact_interval* found = nullptr,
                                 std::size_t deepest = static_filter::max_depth);

template <any_query Query>
verdict decide_with_integers(const Query& query, stage_report* report);

}  // namespace ccd::detail
