// First times of two bodies' features: the stages of ccd/contact/turning/body_filter.hpp, then
// those of all curves. Internal.
#pragma once

#include <ccd/bodies/motion.hpp>
#include <ccd/curves.hpp>
#include <ccd/kind.hpp>
#include <ccd/verdict.hpp>
#include <span>

namespace ccd::detail {

/// Same as first_within (ccd/curves.hpp), for points in the order of points_of.
template <kind K>
first_time first_within_of_bodies(std::span<const body_point> points, separation d, double t_max,
                                  answer wanted);

}  // namespace ccd::detail
