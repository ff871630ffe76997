// Seeded families of distances for a query, the same with every standard library.
#pragma once

#include <algorithm>
#include <array>
#include <ccd/contact.hpp>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string_view>
#include <vector>

#include "ccd/lab/queries.hpp"
#include "tests/support/nearest_points.hpp"

namespace distance_families {

using ccd::kind;
using ccd::separation;
using ccd::lab::points;
using ccd::lab::source;

struct family {
    std::string_view name;
    separation (*make)(source& random, kind which, const points& p);
    /// The relative frequency of the family.
    unsigned weight = 4;
};

namespace detail {

using number = long double;  // no product here overflows
using vector = support::vector<number>;
using support::operator-, support::dot, support::cross;

/// The differences of the two features' vertices at t, in order around their hull.
inline std::vector<vector> differences(kind which, const points& p, double t) {
    std::array<vector, 4> at;
    std::ranges::transform(p, at.begin(), [t](const ccd::moving_point<double>& m) -> vector {
        const auto between = [t](number a, number b) { return (1 - t) * a + t * b; };
        return {between(m.t0.x, m.t1.x), between(m.t0.y, m.t1.y), between(m.t0.z, m.t1.z)};
    });
    const auto [a, b, c, d] = at;
    if (which == kind::edge_edge) return {c - a, d - a, d - b, c - b};
    if (which == kind::vertex_vertex) return {b - a};
    if (which == kind::vertex_edge) return {b - a, c - a};
    return {b - a, c - a, d - a};
}

/// Approximate distance of the origin from the segment, and from the triangle if the nearest point
/// is inside it, else infinity.
inline number to_segment(const vector& a, const vector& b) {
    const vector e = b - a;
    const number square = dot(e, e);
    const number s = square > 0 ? std::clamp<number>(-dot(a, e) / square, 0, 1) : 0;
    const vector nearest{a[0] + s * e[0], a[1] + s * e[1], a[2] + s * e[2]};
    return std::sqrt(dot(nearest, nearest));
}
inline number to_inside(const vector& a, const vector& b, const vector& c) {
    const vector normal = cross(b - a, c - a);
    const number square = dot(normal, normal);
    const bool inside = square > 0 && dot(normal, cross(a, b)) >= 0 &&
                        dot(normal, cross(b, c)) >= 0 && dot(normal, cross(c, a)) >= 0;
    return inside ? std::abs(dot(normal, a)) / std::sqrt(square)
                  : std::numeric_limits<number>::infinity();
}

/// Approximate distance of the features at t.
inline number distance_at(kind which, const points& p, double t) {
    const std::vector<vector> corners = differences(which, p, t);
    number least = std::numeric_limits<number>::infinity();
    for (std::size_t i = 0; i < corners.size(); ++i)
        least = std::min(least, to_segment(corners[i], corners[(i + 1) % corners.size()]));
    for (std::size_t i = 2; i < corners.size(); ++i)
        least = std::min(least, to_inside(corners[0], corners[i - 1], corners[i]));
    return least;
}

/// Approximate minimum of the distance over time.
inline number least_distance(kind which, const points& p) {
    const auto at = [&](double t) { return distance_at(which, p, t); };
    double best = 0, step = 1 / 16.0;
    for (double t = step; t <= 1; t += step)
        if (at(t) < at(best)) best = t;
    while (step > 0x1p-50) {
        step /= 2;
        const double down = std::max(best - step, 0.0), up = std::min(best + step, 1.0);
        best = at(down) < at(best) ? down : at(up) < at(best) ? up : best;
    }
    return at(best);
}

/// The nearest finite double, moved by some last places.
inline double as_double(number d, int places = 0) {
    auto x = static_cast<double>(std::min<number>(d, std::numeric_limits<double>::max()));
    for (; places > 0; --places) x = std::nextafter(x, std::numeric_limits<double>::max());
    for (; places < 0; ++places) x = std::nextafter(x, 0);
    return x;
}

inline double some_distance(source& random, kind which, const points& p) {
    switch (random.between(0, 3)) {
        case 0:
            return as_double(least_distance(which, p));
        case 1:
            return as_double(distance_at(which, p, 0));
        case 2:
            return as_double(distance_at(which, p, 1));
        default:
            return as_double(distance_at(which, p, random.unit()));
    }
}

/// A distance as a sum of one or two doubles; the sum may not be a double.
inline separation as_sum(source& random, double d) {
    switch (random.between(0, 3)) {
        case 0:
            return {d, 0};
        case 1:
            return {0, d};
        case 2: {
            const double part = d * random.unit();
            return {part, d - part};
        }
        default:
            return {d, std::ldexp(d, -random.between(40, 120))};
    }
}

inline constexpr family list[] = {
    {"zero",
     [](source&, kind, const points&) {
         return separation{0, 0};
     }},
    {"subnormal",
     [](source& r, kind, const points&) {
         return separation{std::ldexp(r.between(0, 9), -1074), std::ldexp(r.between(0, 1), -1074)};
     },
     1},
    {"tiny",
     [](source& r, kind k, const points& p) {
         return as_sum(r, std::ldexp(some_distance(r, k, p), -r.between(20, 80)));
     }},
    {"some time's",
     [](source& r, kind k, const points& p) {
         return separation{some_distance(r, k, p), 0};
     }},
    {"some time's by ulps",
     [](source& r, kind k, const points& p) {
         return separation{as_double(some_distance(r, k, p), r.between(-2, 2)), 0};
     }},
    {"some time's, of two",
     [](source& r, kind k, const points& p) { return as_sum(r, some_distance(r, k, p)); }},
    {"least by ulps",
     [](source& r, kind k, const points& p) {
         return separation{as_double(least_distance(k, p), r.between(-2, 2)), 0};
     }},
    {"least, of two",
     [](source& r, kind k, const points& p) {
         return as_sum(r, as_double(least_distance(k, p), r.between(-1, 1)));
     }},
    {"less than at the start",
     [](source& r, kind k, const points& p) {
         return as_sum(r, as_double(distance_at(k, p, 0)) * r.unit());
     }},
    {"whole",
     [](source& r, kind, const points&) {
         return separation{double(r.between(0, 4)), double(r.between(0, 1))};
     }},
    {"large",
     [](source& r, kind k, const points& p) {
         return as_sum(r, as_double(std::ldexp(distance_at(k, p, 0), r.between(-3, 60))));
     },
     2},
    {"huge",
     [](source& r, kind, const points&) {
         const double largest = std::numeric_limits<double>::max();
         return separation{std::ldexp(largest, -r.between(0, 20)), r.one_in(2) ? largest : 0};
     },
     1},
};

}  // namespace detail

inline constexpr auto& families = detail::list;

inline const family& draw(source& random) {
    unsigned all = 0;
    for (const family& f : families) all += f.weight;
    auto rest = static_cast<unsigned>(random.between(1, static_cast<int>(all)));
    for (const family& f : families) {
        if (rest <= f.weight) return f;
        rest -= f.weight;
    }
    return families[0];
}

}  // namespace distance_families
