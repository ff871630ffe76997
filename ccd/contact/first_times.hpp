// First times of contact and of distance in unbounded integers, for points that move along
// polynomials in t of any degree. Internal.
//
// Allocates; time and memory are bounded by the degrees and by the spread of the coordinates'
// exponents.
#pragma once

#include <ccd/contact.hpp>
#include <ccd/kind.hpp>
#include <ccd/separation.hpp>
#include <span>

#include "ccd/contact/time_polynomial.hpp"

namespace ccd::detail {

/// When the features of a query of this kind first touch, in [0, t_max]: what ccd/contact.hpp
/// promises. `points` are those of points_of, in its order, each of one control point or more.
template <kind K>
first_time first_contact_of(std::span<const control_polygon> points, double t_max);

/// When they first come within d: what ccd/separation.hpp promises.
template <kind K>
first_time first_within_of(std::span<const control_polygon> points, separation d, double t_max);

}  // namespace ccd::detail
