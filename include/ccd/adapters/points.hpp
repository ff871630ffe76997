// Converts positions of other libraries.
#pragma once

#include <ccd/query.hpp>

namespace ccd::adapters::detail {

/// Converts a vector with [] and size(). Two coordinates give a point with z = 0 (ccd/plane.hpp).
template <class Vector>
point<double> position(const Vector& p) {
    return {p[0], p[1], p.size() > 2 ? p[2] : 0};
}

template <class Vector>
moving_point<double> moving(const Vector& t0, const Vector& t1) {
    return {position(t0), position(t1)};
}

}  // namespace ccd::adapters::detail
