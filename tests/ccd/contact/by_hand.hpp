// Abbreviations for queries made by hand, and for their first times.
#pragma once

#include <ccd/contact.hpp>
#include <ccd/query.hpp>
#include <cmath>
#include <limits>

namespace by_hand {

using point = ccd::point<double>;
using moving = ccd::moving_point<double>;
using vertex_face = ccd::vertex_face<double>;
using edge_edge = ccd::edge_edge<double>;
using vertex_edge = ccd::vertex_edge<double>;
using vertex_vertex = ccd::vertex_vertex<double>;

inline constexpr double infinity = std::numeric_limits<double>::infinity();
inline constexpr double least = std::numeric_limits<double>::denorm_min();

inline moving still(point p) {
    return {p, p};
}
inline moving from_to(point a, point b) {
    return {a, b};
}

/// A vertex over the resting triangle (0,0,0), (1,0,0), (0,1,0).
inline vertex_face over_triangle(point v0, point v1) {
    return {from_to(v0, v1), still({0, 0, 0}), still({1, 0, 0}), still({0, 1, 0})};
}

inline constexpr ccd::first_time never{ccd::outcome::separate, 0, 0};
inline ccd::first_time between(double low, double high) {
    return {ccd::outcome::collides, low, high};
}
inline ccd::first_time at(double t) {
    return between(t, t);
}
/// 1/3 rounded down, and the next double.
inline const ccd::first_time at_a_third = between(1.0 / 3, std::nextafter(1.0 / 3, 1));

}  // namespace by_hand
