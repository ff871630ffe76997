// Floating-point filters for motion along curves, of bodies and the like. Internal.
#pragma once

#include <array>
#include <ccd/kind.hpp>
#include <ccd/verdict.hpp>
#include <cstddef>
#include <span>
#include <vector>

#include "ccd/contact/feature_conditions.hpp"
#include "ccd/contact/moving_points.hpp"

namespace ccd::detail {

using tracked_polynomial = tracked_ring::element;

/// A box around a point relative to the ring's origin. Rational points are convex combinations of
/// the quotients of coefficients, if the weight's are positive; else the box is unbounded.
motion_box box_of(const homogeneous_point<tracked_ring>& p);

/// True if on some axis all boxes of one feature, the first `first` boxes, are certainly beyond
/// those of the other, by more than `distance`.
bool boxes_are_separate(std::span<const motion_box> boxes, std::size_t first, double distance);

/// True if signs of tracked Bernstein coefficients exclude each condition of
/// ccd/contact/feature_conditions.hpp.
template <kind K>
bool certainly_separate(const paths<K, tracked_polynomial>& q);

/// Returns which conditions of distance² <= D, D > 0, may hold in [0, 1], in the order of
/// visit_distance_conditions.
template <kind K>
std::vector<bool> possible_conditions(const paths<K, tracked_polynomial>& q,
                                      const tracked_polynomial& squared);

}  // namespace ccd::detail
