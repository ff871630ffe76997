// Input of the oracle in integers: a query's points as polynomials, and the interval.
#pragma once

#include <algorithm>
#include <array>
#include <ccd/curves.hpp>
#include <ccd/query.hpp>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "tests/support/instants.hpp"
#include "tests/support/oracle.hpp"

namespace oracle::detail {

inline constexpr std::array axes{&ccd::point<double>::x, &ccd::point<double>::y,
                                 &ccd::point<double>::z};

/// The largest exponent for which all control points' coordinates on an axis are whole multiples of
/// its power of two.
inline int unit_of(std::span<const ccd::curve> points, std::size_t axis) {
    int unit = std::numeric_limits<int>::max();
    for (const ccd::curve& control : points)
        for (const ccd::point<double>& c : control)
            unit = std::min(unit, scaled(c.*axes[axis]).exponent);
    return unit;
}

/// p(t) from its control values, by de Casteljau's rule with a symbolic t.
inline polynomial from_control_values(const std::vector<integer>& values) {
    std::vector<polynomial> p;
    for (const integer& value : values) {
        p.push_back({value});
        trim(p.back());
    }
    for (; p.size() > 1; p.pop_back()) {
        for (std::size_t i = 0; i + 1 < p.size(); ++i) {
            polynomial slope = p[i + 1] - p[i];
            if (!slope.empty()) slope.insert(slope.begin(), integer(0));
            p[i] = p[i] + slope;
        }
    }
    return p[0];
}

/// The points, in units of 2^units[axis].
template <std::size_t count>
std::array<vector, count> in_units(const std::array<ccd::curve, count>& points,
                                   const std::array<int, 3>& units) {
    std::array<vector, count> out;
    for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            std::vector<integer> values;
            for (const ccd::point<double>& c : points[i])
                values.push_back(scaled(c.*axes[axis]).in_units_of(units[axis]));
            out[i][axis] = from_control_values(values);
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

// ---- Decisions about polynomials ----
//
// The points may have one positive polynomial as a common factor: contact does not depend on it.

bool collides_of(const ccd::vertex_face_of<vector>&, const stretch& when);
bool collides_of(const ccd::edge_edge_of<vector>&, const stretch& when);
bool collides_of(const ccd::vertex_edge_of<vector>&, const stretch& when);
bool collides_of(const ccd::vertex_vertex_of<vector>&, const stretch& when);

/// `square` is the square of the distance, times that of the common factor.
template <template <class> class Query>
bool within_of(const Query<vector>&, const polynomial& square, shortcuts use, const stretch& when);

}  // namespace oracle::detail
