// First times of contact and of distance in unbounded integers, for points that move along
// polynomials in t of any degree. Internal.
//
// Allocates; time and memory are bounded by the degrees and by the spread of the coordinates'
// exponents.
#pragma once

#include <ccd/contact.hpp>
#include <ccd/curves.hpp>
#include <ccd/kind.hpp>
#include <ccd/separation.hpp>
#include <span>

namespace ccd::detail {

/// Whether d is a distance: finite and not negative.
bool is_distance(separation d);

/// Whether floating point under error bounds (ccd/contact/curve_filter.hpp) may answer what it can.
/// The answers are the same.
enum class arithmetic { integers, floating_point_first };

/// When the features of a query of this kind first come within d, in [0, t_max]; of d = 0, when
/// they first touch: what ccd/separation.hpp promises. `points` are those of points_of, in its
/// order.
template <kind K>
first_time first_within_of(std::span<const curve> points, separation d, double t_max,
                           arithmetic by);

}  // namespace ccd::detail
