// Floating-point filters for motion along curves. Internal.
//
// Preconditions: points are finite, in the order of points_of and have control points; d is a
// distance.
#pragma once

#include <ccd/curves.hpp>
#include <ccd/kind.hpp>
#include <ccd/query.hpp>
#include <errbound/tracked.hpp>
#include <span>
#include <vector>

namespace ccd::detail {

/// True if the boxes of control points are disjoint, or signs of tracked Bernstein coefficients
/// exclude each condition of ccd/contact/feature_conditions.hpp.
template <kind K>
bool certainly_separate(std::span<const curve> points);

/// Returns which conditions of distance <= d, d > 0, may hold in [0, 1], in the order of
/// visit_distance_conditions.
template <kind K>
std::vector<bool> possible_conditions(std::span<const curve> points, separation d);

/// Decides if a VF or EE query touches at a time t at which Y = 0, given by an enclosure.
template <kind K>
outcome touches_at_root(std::span<const curve> points, const errbound::tracked<double>& t);

}  // namespace ccd::detail
