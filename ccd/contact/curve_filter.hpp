// Floating-point filters for motion along curves. Internal.
//
// Points are finite and in the order of points_of, each with at least one control point. d is a
// distance.
#pragma once

#include <ccd/curves.hpp>
#include <ccd/kind.hpp>
#include <ccd/query.hpp>
#include <errbound/tracked.hpp>
#include <span>
#include <vector>

namespace ccd::detail {

/// True if the features of a query of this kind certainly do not touch: the boxes of their control
/// points are disjoint, or the tracked Bernstein coefficients of a polynomial exclude each
/// condition of ccd/contact/feature_conditions.hpp by their signs.
template <kind K>
bool certainly_separate(std::span<const curve> points);

/// Returns which of the conditions of distance <= d, d > 0, may hold in [0, 1], in the order of
/// visit_distance_conditions.
template <kind K>
std::vector<bool> possible_conditions(std::span<const curve> points, separation d);

/// Decides whether a VF or EE query touches at a time t at which Y = 0, given by an enclosure.
template <kind K>
outcome touches_at_root(std::span<const curve> points, const errbound::tracked<double>& t);

}  // namespace ccd::detail
