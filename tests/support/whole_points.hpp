// What is asked of the oracle, in whole numbers: a query's points as polynomials, and when.
#pragma once

#include <algorithm>
#include <array>
#include <ccd/query.hpp>
#include <cstddef>
#include <limits>
#include <span>

#include "tests/support/instants.hpp"
#include "tests/support/oracle.hpp"

namespace oracle::detail {

using moving = ccd::moving_point<double>;

inline constexpr std::array axes{&ccd::point<double>::x, &ccd::point<double>::y,
                                 &ccd::point<double>::z};

/// The largest exponent of which all the points' coordinates on an axis are whole multiples.
inline int unit_of(std::span<const moving> points, std::size_t axis) {
    int unit = std::numeric_limits<int>::max();
    for (const moving& m : points)
        unit =
            std::min({unit, scaled(m.t0.*axes[axis]).exponent, scaled(m.t1.*axes[axis]).exponent});
    return unit;
}

/// The points, in units of 2^units[axis].
template <std::size_t count>
std::array<vector, count> in_units(const std::array<moving, count>& points,
                                   const std::array<int, 3>& units) {
    std::array<vector, count> out;
    for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const integer t0 = scaled(points[i].t0.*axes[axis]).in_units_of(units[axis]);
            const integer t1 = scaled(points[i].t1.*axes[axis]).in_units_of(units[axis]);
            out[i][axis] = {t0, t1 - t0};
            trim(out[i][axis]);
        }
    }
    return out;
}

inline bool is_empty(const interval& when) {
    return when.low > when.high || (when.low == when.high && !(when.with_low && when.with_high));
}

inline stretch stretch_of(const interval& when) {
    return {dyadic_of(when.low), dyadic_of(when.high), when.with_low, when.with_high};
}

}  // namespace oracle::detail
