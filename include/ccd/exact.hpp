// `exact`: no false negative and no false positive on any finite input.
//
//     if (ccd::decide_exact(query).outcome == ccd::outcome::collides) ...
//
// A query collides if its two closed features share a point at some t in [0, 1]: borders and
// touching count. A degenerate triangle or edge is the segment or point that it is. A query is
// `uncertain`, with cause `range`, only if a coordinate is not finite. Requires a sound environment
// (errbound/environment.hpp): no flush-to-zero. Allocates only in its last stage
// (ccd/reference.hpp). Cost (./run bench --worst): tens to hundreds of nanoseconds; at worst some
// 50 µs for coordinates of 1e-3 to 1e3, and a tenth of a second for all magnitudes.
#pragma once

#include <ccd/explain.hpp>
#include <ccd/kind.hpp>
#include <ccd/query.hpp>
#include <ccd/verdict.hpp>

namespace ccd {

/// Runs the stages of ccd/explain.hpp until one decides; vertex/edge and vertex/vertex queries
/// start with `integers`. If coordinates
/// differ by less than 2^253 units on each axis, at each end of the step, `integers` decides: no
/// exception is known, and no proof excludes one. The unit is the largest power of two
/// that divides all coordinates of the axis.
///
/// Adds the counts and times of the stages to `report` if it is not null: some 50 ns a stage.
template <any_query Query>
verdict decide_exact(const Query& query, stage_report* report = nullptr);

/// Returns `collides` if the features touch at t = 0: initial contact, not a later impact.
template <any_query Query>
verdict touches_at_start(const Query& query);

}  // namespace ccd
