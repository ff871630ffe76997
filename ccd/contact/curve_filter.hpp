// What floating point tells of motion along curves: that features are certainly separate. Internal.
#pragma once

#include <ccd/curves.hpp>
#include <ccd/kind.hpp>
#include <ccd/separation.hpp>
#include <span>

namespace ccd::detail {

/// Whether it is certain that the features of a query of this kind are more than d apart throughout
/// (d = 0: do not touch): the boxes of their control points are, or each condition of
/// ccd/contact/feature_conditions.hpp has a polynomial whose Bernstein coefficients, tracked, are
/// all of a sign that excludes it. Finite points of the order of points_of, with a control point or
/// more; d is a distance.
template <kind K>
bool certainly_separate(std::span<const curve> points, separation d);

}  // namespace ccd::detail
