// What floating point tells of motion along curves: that features are certainly separate, where
// they may not be, and whether they touch at a time. Internal.
//
// Points are finite, in the order of points_of, with a control point or more; d is a distance.
#pragma once

#include <ccd/curves.hpp>
#include <ccd/kind.hpp>
#include <ccd/query.hpp>
#include <errbound/tracked.hpp>
#include <span>
#include <vector>

namespace ccd::detail {

/// Whether it is certain that the features of a query of this kind do not touch: the boxes of their
/// control points do not, or each condition of ccd/contact/feature_conditions.hpp has a polynomial
/// whose Bernstein coefficients, tracked, are all of a sign that excludes it.
template <kind K>
bool certainly_separate(std::span<const curve> points);

/// Which of the conditions of distance <= d, d > 0, in the order of visit_distance_conditions, may
/// hold in [0, 1].
template <kind K>
std::vector<bool> possible_conditions(std::span<const curve> points, separation d);

/// Whether VF or EE queries touch at a time at which Y = 0, known within bounds.
template <kind K>
outcome touches_at_root(std::span<const curve> points, const errbound::tracked<double>& t);

}  // namespace ccd::detail
