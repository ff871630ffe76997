// Queries that are degenerate exactly, or nearly.
#pragma once

#include <cmath>
#include <cstddef>
#include <utility>

#include "ccd/stress/generators/coordinates.hpp"

namespace ccd::stress::generators {

// Half of the points, at random, do not move.
inline points part_frozen(source& random, points p) {
    for (auto& m : p) {
        if (random.one_in(2)) m.t1 = m.t0;
    }
    return p;
}

inline points all_frozen(points p) {
    for (auto& m : p) m.t1 = m.t0;
    return p;
}

inline points in_plane(source& random, const points& p) {
    const auto flat = static_cast<std::size_t>(random.between(0, 2));
    return map(p, [&](double x, std::size_t, std::size_t, std::size_t axis) {
        return axis == flat ? 0 : x;
    });
}

inline points on_line(source& random, const points& p) {
    const auto line = static_cast<std::size_t>(random.between(0, 2));
    return map(p, [&](double x, std::size_t, std::size_t, std::size_t axis) {
        return axis == line ? x : 0;
    });
}

// Identical points: at one end or at both, one point takes another's place.
inline points merged(source& random, points p) {
    const auto from = static_cast<std::size_t>(random.between(0, 3));
    const auto to = static_cast<std::size_t>(random.between(0, 3));
    const int which = random.between(0, 2);
    if (which != 1) p[to].t0 = p[from].t0;
    if (which != 0) p[to].t1 = p[from].t1;
    return p;
}

inline point<double> along(const point<double>& a, const point<double>& b, const point<double>& c,
                           int k) {
    return {a.x + k * (c.x - b.x), a.y + k * (c.y - b.y), a.z + k * (c.z - b.z)};
}

// The fourth point parallel to the others: parallel edges, or a triangle collapsed to a segment;
// throughout the step, or only at its start or its end.
inline points parallel(source& random, kind which, points p) {
    const int k = random.between(-2, 2);
    const int when = random.between(0, 2);
    const std::size_t from = which == kind::vertex_face ? 1 : 0;
    const std::size_t base = which == kind::vertex_face ? 1 : 2;
    if (when != 1) p[3].t0 = along(p[base].t0, p[from].t0, p[from + 1].t0, k);
    if (when != 0) p[3].t1 = along(p[base].t1, p[from].t1, p[from + 1].t1, k);
    return p;
}

// On one axis all coordinates are at most 2^exponent: motion in a plane, nearly.
inline points nearly_in_plane(source& random, const points& p, int exponent) {
    const auto flat = static_cast<std::size_t>(random.between(0, 2));
    return map(p, [&](double x, std::size_t, std::size_t, std::size_t axis) {
        return axis == flat ? std::ldexp(random.symmetric(), exponent) : x;
    });
}

}  // namespace ccd::stress::generators
