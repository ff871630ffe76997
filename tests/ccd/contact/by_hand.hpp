// Abbreviations for queries made by hand.
#pragma once

#include <ccd/query.hpp>
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

}  // namespace by_hand
