// The predicates of errbound/predicates.hpp in integers, by other formulas: determinants of
// homogeneous coordinates, and parameters of intersection points.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <climits>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <errbound/sign.hpp>
#include <utility>
#include <vector>

#include "tests/support/big_integer.hpp"

namespace predicate_oracle {

template <std::size_t D>
using point = std::array<big_integer, D>;
using point2 = point<2>;
using point3 = point<3>;

/// The exponent of the last bit of any coordinate; 0 if all are zero.
template <class T, std::size_t D, std::size_t N>
int common_unit(const std::array<std::array<T, D>, N>& p) {
    int unit = INT_MAX;
    for (const auto& q : p)
        for (const T x : q) {
            if (x == 0) continue;
            int exponent;
            const double fraction = std::frexp(double(x), &exponent);
            const auto digits = static_cast<std::uint64_t>(std::ldexp(std::abs(fraction), 53));
            unit = std::min(unit, exponent - 53 + std::countr_zero(digits));
        }
    return unit == INT_MAX ? 0 : unit;
}

/// Points in units of 2^unit.
template <class T, std::size_t D, std::size_t N>
std::array<point<D>, N> scaled_points(const std::array<std::array<T, D>, N>& p, int unit) {
    std::array<point<D>, N> scaled;
    for (std::size_t i = 0; i < N; ++i)
        for (std::size_t k = 0; k < D; ++k) scaled[i][k] = big_integer(p[i][k], unit);
    return scaled;
}

inline big_integer dot(const point3& a, const point3& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline point3 cross(const point3& a, const point3& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline point3 difference(const point3& a, const point3& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline point3 homogeneous(const point2& a) {
    return {a[0], a[1], 1};
}

/// The determinant of the rows (x, y, z, w), by the minors of two columns.
inline big_integer determinant(const point<4>& a, const point<4>& b, const point<4>& c,
                               const point<4>& d) {
    const auto left = [](const auto& p, const auto& q) { return p[0] * q[1] - p[1] * q[0]; };
    const auto right = [](const auto& p, const auto& q) { return p[2] * q[3] - p[3] * q[2]; };
    return left(a, b) * right(c, d) - left(a, c) * right(b, d) + left(a, d) * right(b, c) +
           left(b, c) * right(a, d) - left(b, d) * right(a, c) + left(c, d) * right(a, b);
}

inline big_integer orient2d(const std::array<point2, 3>& p) {
    return dot(homogeneous(p[0]), cross(homogeneous(p[1]), homogeneous(p[2])));
}
inline big_integer orient3d(const std::array<point3, 4>& p) {
    const auto row = [&](std::size_t i) { return point<4>{p[i][0], p[i][1], p[i][2], 1}; };
    return determinant(row(0), row(1), row(2), row(3));
}

/// The determinant of points in the plane at these heights.
inline big_integer lifted_area(const std::array<point2, 4>& p,
                               const std::array<big_integer, 4>& height) {
    const auto row = [&](std::size_t i) { return point<4>{p[i][0], p[i][1], height[i], 1}; };
    return determinant(row(0), row(1), row(2), row(3));
}
/// The same for points in space, by the column of heights, the fourth of five.
inline big_integer lifted_volume(const std::array<point3, 5>& p,
                                 const std::array<big_integer, 5>& height) {
    big_integer sum;
    for (std::size_t i = 0; i < 5; ++i) {
        std::array<point3, 4> others;
        for (std::size_t k = 0; k < 4; ++k) others[k] = p[k < i ? k : k + 1];
        const big_integer term = height[i] * orient3d(others);
        sum = i % 2 == 0 ? sum - term : sum + term;
    }
    return sum;
}

inline big_integer incircle(const std::array<point2, 4>& p) {
    std::array<big_integer, 4> height;
    for (std::size_t i = 0; i < 4; ++i) height[i] = p[i][0] * p[i][0] + p[i][1] * p[i][1];
    return lifted_area(p, height);
}
inline big_integer insphere(const std::array<point3, 5>& p) {
    std::array<big_integer, 5> height;
    for (std::size_t i = 0; i < 5; ++i) height[i] = dot(p[i], p[i]);
    return lifted_volume(p, height);
}
/// `one` is 1 in the points' unit; weights have the degree 2.
inline big_integer power_incircle(const std::array<point3, 4>& p, const big_integer& one) {
    std::array<point2, 4> flat;
    std::array<big_integer, 4> height;
    for (std::size_t i = 0; i < 4; ++i) {
        flat[i] = {p[i][0], p[i][1]};
        height[i] = p[i][0] * p[i][0] + p[i][1] * p[i][1] - p[i][2] * one;
    }
    return lifted_area(flat, height);
}
inline big_integer power_insphere(const std::array<point<4>, 5>& p, const big_integer& one) {
    std::array<point3, 5> solid;
    std::array<big_integer, 5> height;
    for (std::size_t i = 0; i < 5; ++i) {
        solid[i] = {p[i][0], p[i][1], p[i][2]};
        height[i] = dot(solid[i], solid[i]) - p[i][3] * one;
    }
    return lifted_volume(solid, height);
}

/// |a|² − |b|² − 2p·(a − b).
template <std::size_t D>
big_integer compare_distances(const std::array<point<D>, 3>& x) {
    const auto& [p, a, b] = x;
    big_integer sum;
    for (std::size_t k = 0; k < D; ++k) sum = sum + (a[k] - b[k]) * (a[k] + b[k] - (p[k] + p[k]));
    return sum;
}

inline bool is_zero(const point3& a) {
    return sign(a[0]) == 0 && sign(a[1]) == 0 && sign(a[2]) == 0;
}

/// a + s(b − a) and c + t(d − c), for s and t in [0, 1].
inline int segments_intersect3d(const std::array<point3, 4>& p) {
    const point3 u = difference(p[1], p[0]), v = difference(p[3], p[2]), w = difference(p[2], p[0]);
    const point3 n = cross(u, v);
    if (!is_zero(n)) {
        if (sign(dot(w, n)) != 0) return -1;
        // s and t times |n|².
        const big_integer most = dot(n, n), s = dot(cross(w, v), n), t = dot(cross(w, u), n);
        return std::min({sign(s), sign(t), sign(most - s), sign(most - t)});
    }
    const point3 along = is_zero(u) ? v : u;
    if (!is_zero(cross(w, along))) return -1;
    if (is_zero(along)) return is_zero(w) ? 0 : -1;
    // Positions on the common line.
    const big_integer b = dot(u, along), c = dot(w, along), d = c + dot(v, along);
    const big_integer low = b < 0 ? b : 0, high = b < 0 ? 0 : b;
    const bool below = c < low && d < low, above = high < c && high < d;
    return below || above ? -1 : 0;
}

inline int segments_intersect2d(const std::array<point2, 4>& p) {
    const auto raised = [](const point2& a) { return point3{a[0], a[1], 0}; };
    return segments_intersect3d({raised(p[0]), raised(p[1]), raised(p[2]), raised(p[3])});
}

/// p + t(q − p), for t in [0, 1], in the triangle's barycentric coordinates.
inline int segment_intersects_triangle(const std::array<point3, 5>& x) {
    const point3 &p = x[0], &q = x[1], &a = x[2], &b = x[3], &c = x[4];
    const point3 ab = difference(b, a), ac = difference(c, a), n = cross(ab, ac);
    if (is_zero(n)) {
        // The triangle is its longest edge.
        const point3 bc = difference(c, b);
        const big_integer l_ab = dot(ab, ab), l_ac = dot(ac, ac), l_bc = dot(bc, bc);
        const bool is_ab = !(l_ab < l_ac) && !(l_ab < l_bc), is_ac = !(l_ac < l_bc);
        return std::min(0, segments_intersect3d(is_ab   ? std::array<point3, 4>{p, q, a, b}
                                                : is_ac ? std::array<point3, 4>{p, q, a, c}
                                                        : std::array<point3, 4>{p, q, b, c}));
    }
    // Three functions of a point, not negative in the triangle, which sum up to |n|² in its plane.
    const auto inside = [&](const point3& at) {
        const point3 r = difference(at, a);
        const big_integer of_b = dot(cross(r, ac), n), of_c = dot(cross(ab, r), n);
        return point3{dot(n, n) - of_b - of_c, of_b, of_c};
    };
    const point3 at_p = inside(p), at_q = inside(q);
    const big_integer above_p = dot(difference(p, a), n), above_q = dot(difference(q, a), n);
    const big_integer fall = above_p - above_q;  // t = above_p/fall
    if (sign(fall) != 0) {
        int least = std::min(sign(fall) * sign(above_p), -sign(fall) * sign(above_q));
        for (std::size_t k = 0; k < 3; ++k)
            least = std::min(least, sign(fall) * sign(at_q[k] * above_p - at_p[k] * above_q));
        return least;
    }
    if (sign(above_p) != 0) return -1;
    // In the plane, each edge shortens the interval of t from `low` to `high`, both fractions.
    std::array<big_integer, 2> low{0, 1}, high{1, 1};
    for (std::size_t k = 0; k < 3; ++k) {
        if (sign(at_p[k]) < 0 && sign(at_q[k]) < 0) return -1;
        const std::array<big_integer, 2> t{abs(at_p[k]), abs(at_p[k] - at_q[k])};
        if (sign(at_p[k]) < 0 && low[0] * t[1] < t[0] * low[1]) low = t;
        if (sign(at_q[k]) < 0 && t[0] * high[1] < high[0] * t[1]) high = t;
    }
    return high[0] * low[1] < low[0] * high[1] ? -1 : 0;
}

/// Homogeneous; the last coordinate is zero where lines are parallel.
inline point3 meeting_point(const point2& a, const point2& b, const point2& c, const point2& d) {
    return cross(cross(homogeneous(a), homogeneous(b)), cross(homogeneous(c), homogeneous(d)));
}
inline int orient2d_line_line(const std::array<point2, 6>& p) {
    const point3 m = meeting_point(p[0], p[1], p[2], p[3]);
    return sign(dot(m, cross(homogeneous(p[4]), homogeneous(p[5])))) * sign(m[2]);
}
inline int compare_x_line_line(const std::array<point2, 8>& p) {
    const point3 m = meeting_point(p[0], p[1], p[2], p[3]),
                 n = meeting_point(p[4], p[5], p[6], p[7]);
    return sign(m[0] * n[2] - n[0] * m[2]) * sign(m[2]) * sign(n[2]);
}
/// Points a, b of the line, three of its plane, three more: the plane's function f of a point gives
/// f(a)·b − f(b)·a, over f(a) − f(b).
inline int orient3d_line_plane(const std::array<point3, 8>& x) {
    const point3 &a = x[0], &b = x[1];
    const big_integer at_a = orient3d({x[2], x[3], x[4], a});
    const big_integer at_b = orient3d({x[2], x[3], x[4], b});
    const big_integer w = at_a - at_b;
    const auto m = [&](std::size_t k) { return at_a * b[k] - at_b * a[k]; };
    const auto row = [](const point3& y) { return point<4>{y[0], y[1], y[2], 1}; };
    return sign(determinant({m(0), m(1), m(2), w}, row(x[5]), row(x[6]), row(x[7]))) * sign(w);
}

/// The sign of a determinant by elimination. All divisions are exact. Source: Bareiss 1968.
inline int sign_of_determinant(std::vector<std::vector<big_integer>> m) {
    big_integer last = 1;
    int swaps = 1;
    for (std::size_t k = 0; k < m.size(); ++k) {
        std::size_t pivot = k;
        while (pivot < m.size() && sign(m[pivot][k]) == 0) ++pivot;
        if (pivot == m.size()) return 0;
        if (pivot != k) {
            std::swap(m[pivot], m[k]);
            swaps = -swaps;
        }
        for (std::size_t i = k + 1; i < m.size(); ++i)
            for (std::size_t j = k + 1; j < m.size(); ++j)
                m[i][j] = exact_quotient(m[i][j] * m[k][k] - m[i][k] * m[k][j], last);
        last = m[k][k];
    }
    return swaps * sign(last);
}
/// The determinant of homogeneous rows (p, 1), or (p, |p|², 1).
template <std::size_t D, std::size_t N>
int homogeneous_sign(const std::array<point<D>, N>& p) {
    std::vector<std::vector<big_integer>> rows;
    for (const auto& q : p) {
        std::vector<big_integer> row(q.begin(), q.end());
        if (N == D + 2) {
            big_integer squared;
            for (const big_integer& x : q) squared = squared + x * x;
            row.push_back(squared);
        }
        row.push_back(1);
        rows.push_back(row);
    }
    return sign_of_determinant(std::move(rows));
}

template <std::size_t D>
big_integer product_at(const point<D>& a, const point<D>& o, const point<D>& b) {
    big_integer sum;
    for (std::size_t k = 0; k < D; ++k) sum = sum + (a[k] - o[k]) * (b[k] - o[k]);
    return sum;
}
template <std::size_t D>
big_integer compare_lengths(const std::array<point<D>, 4>& p) {
    return product_at(p[1], p[0], p[1]) - product_at(p[3], p[2], p[3]);
}
inline int compare_slopes(const std::array<point2, 4>& p) {
    big_integer x = p[1][0] - p[0][0], y = p[1][1] - p[0][1], u = p[3][0] - p[2][0],
                v = p[3][1] - p[2][1];
    if (sign(x) == 0 || sign(u) == 0) return (sign(x) == 0) - (sign(u) == 0);
    // Both vectors point to the right.
    if (x < 0) x = -x, y = -y;
    if (u < 0) u = -u, v = -v;
    return sign(y * u - v * x);
}
/// Compares quadrants first: 0 to 3, each with its first axis. Zero vectors equal all directions
/// below π.
inline int compare_directions(const std::array<point2, 4>& p) {
    struct turned {
        int quadrant;
        big_integer x, y;
    };
    const auto turned_of = [](const point2& from, const point2& to) {
        big_integer x = to[0] - from[0], y = to[1] - from[1];
        int quadrant = 0;
        for (; !(sign(x) > 0 && sign(y) >= 0) && quadrant < 4; ++quadrant) {
            const big_integer old = x;
            x = y;
            y = -old;
        }
        return turned{quadrant, x, y};
    };
    const turned a = turned_of(p[0], p[1]), b = turned_of(p[2], p[3]);
    if (a.quadrant == 4 || b.quadrant == 4) {
        const int half_a = a.quadrant / 2 % 2, half_b = b.quadrant / 2 % 2;
        return half_a - half_b;
    }
    if (a.quadrant != b.quadrant) return a.quadrant < b.quadrant ? -1 : 1;
    return sign(a.y * b.x - b.y * a.x);
}
/// Compares cos·|cos|, which falls with the angle.
template <std::size_t D>
int compare_angles(const std::array<point<D>, 6>& p) {
    const auto parts = [](const point<D>& a, const point<D>& o, const point<D>& b) {
        const big_integer dot = product_at(a, o, b);
        return std::array<big_integer, 2>{dot * abs(dot),
                                          product_at(a, o, a) * product_at(b, o, b)};
    };
    const auto [m, n] = parts(p[0], p[1], p[2]);
    const auto [s, t] = parts(p[3], p[4], p[5]);
    if (sign(n) == 0 || sign(t) == 0) return sign(s) - sign(m);
    return sign(s * n - m * t);
}

/// Compares the line's parameters at which it enters and leaves each slab, as fractions. Positive
/// if the open segment meets the box without its border, and both together span the space. (A flat
/// box has only a border normal to its plane.)
template <std::size_t D>
int segment_intersects_box(const std::array<point<D>, 4>& x) {
    const auto& [p, q, a, b] = x;
    using fraction = std::array<big_integer, 2>;  // with a positive denominator
    const auto less = [](const fraction& s, const fraction& t) {
        return s[0] * t[1] < t[0] * s[1];
    };
    std::vector<fraction> lower{{0, 1}}, upper{{1, 1}}, at;
    bool inner = true;
    for (std::size_t k = 0; k < D; ++k) {
        const big_integer low = a[k] < b[k] ? a[k] : b[k], high = a[k] < b[k] ? b[k] : a[k];
        const big_integer d = q[k] - p[k];
        const bool flat = !(low < high);
        if (sign(d) == 0) {
            if (p[k] < low || high < p[k]) return -1;
            inner = inner && low < p[k] && p[k] < high;
            continue;
        }
        fraction enter{low - p[k], d}, leave{high - p[k], d};
        if (d < 0) {
            enter = {p[k] - high, -d};
            leave = {p[k] - low, -d};
        }
        (flat ? at : lower).push_back(enter);
        (flat ? at : upper).push_back(leave);
    }
    // Empty or not, closed and then open. A flat axis has one parameter, twice in `at`.
    for (const auto& s : lower)
        for (const auto& t : upper) {
            if (less(t, s)) return -1;
            inner = inner && less(s, t);
        }
    for (const auto& s : at) {
        for (const auto& t : at)
            if (less(s, t)) return -1;
        for (const auto& t : lower) {
            if (less(s, t)) return -1;
            inner = inner && less(t, s);
        }
        for (const auto& t : upper) {
            if (less(t, s)) return -1;
            inner = inner && less(s, t);
        }
    }
    return inner && at.size() <= 2 ? 1 : 0;
}
/// Coordinates p of the point with area·p = u·a + v·b + w·c. Flat: the border of its convex hull.
inline int point_in_triangle(const std::array<point2, 4>& x) {
    const auto& [p, a, b, c] = x;
    const big_integer whole = orient2d({a, b, c});
    if (sign(whole) != 0) {
        const int s = sign(whole);
        return std::min({s * sign(orient2d({p, b, c})), s * sign(orient2d({a, p, c})),
                         s * sign(orient2d({a, b, p}))});
    }
    const int ab = segments_intersect2d({p, p, a, b}), bc = segments_intersect2d({p, p, b, c}),
              ca = segments_intersect2d({p, p, c, a});
    return std::max({ab, bc, ca}) < 0 ? -1 : 0;
}
inline int point_in_tetrahedron(const std::array<point3, 5>& x) {
    const auto& [p, a, b, c, d] = x;
    const int s = sign(orient3d({a, b, c, d}));
    if (s != 0)
        return std::min({s * sign(orient3d({p, b, c, d})), s * sign(orient3d({a, p, c, d})),
                         s * sign(orient3d({a, b, p, d})), s * sign(orient3d({a, b, c, p}))});
    const int most = std::max({segment_intersects_triangle({p, p, a, b, c}),
                               segment_intersects_triangle({p, p, a, b, d}),
                               segment_intersects_triangle({p, p, a, c, d}),
                               segment_intersects_triangle({p, p, b, c, d})});
    return most < 0 ? -1 : 0;
}

}  // namespace predicate_oracle
