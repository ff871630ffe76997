// First times of two bodies' features: the stages of ccd/contact/turning/body_filter.hpp, then
// those of all curves. Internal.
#pragma once

#include <ccd/bodies/motion.hpp>
#include <ccd/curves.hpp>
#include <ccd/kind.hpp>
#include <ccd/verdict.hpp>
#include <span>

#include "ccd/contact/turning/control_maps.hpp"

namespace ccd::detail {

/// Same as first_within_of (ccd/contact/first_times.hpp), for valid points of two bodies
/// (has_two_bodies) with these maps, and a valid distance.
template <kind K>
first_time first_within_of_bodies(std::span<const body_point> points, const control_maps& a,
                                  const control_maps& b, separation d, double t_max,
                                  answer wanted = answer::time);

}  // namespace ccd::detail
