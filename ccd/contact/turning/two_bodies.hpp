// First times of two bodies' features: the stages of ccd/contact/turning/body_filter.hpp, then
// those of all curves. Crossings at the start. Internal.
#pragma once

#include <array>
#include <ccd/bodies/motion.hpp>
#include <ccd/curves.hpp>
#include <ccd/execution.hpp>
#include <ccd/kind.hpp>
#include <ccd/verdict.hpp>
#include <span>

namespace ccd::detail {

/// Same as first_within (ccd/curves.hpp), for points in the order of points_of. Polls `stop` during
/// exact computations.
template <kind K>
first_time first_within_of_bodies(std::span<const body_point> points, separation d, double t_max,
                                  answer wanted, const stop_query& stop);

/// True if the inside of the edge goes through the inside of the face at t = 0: the ends of the
/// edge are on different sides of the face's plane. Exact. Preconditions: the points of each have
/// one prepared, valid motion.
bool crosses_at_start(const std::array<body_point, 2>& edge, const std::array<body_point, 3>& face);

}  // namespace ccd::detail
