// What the adapters share: positions of other libraries as ours.
#pragma once

#include <ccd/query.hpp>

namespace ccd::adapters::detail {

/// A position from a vector with [] and size(), of two coordinates or three; of two in the plane
/// z = 0, where they have the contacts and distances that they have in a plane (ccd/plane.hpp).
/// Floats are exact doubles.
template <class Vector>
point<double> position(const Vector& p) {
    return {p[0], p[1], p.size() > 2 ? p[2] : 0};
}

template <class Vector>
moving_point<double> moving(const Vector& t0, const Vector& t1) {
    return {position(t0), position(t1)};
}

}  // namespace ccd::adapters::detail
