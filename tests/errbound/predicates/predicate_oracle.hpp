// The predicates of errbound/predicates.hpp in integers, by other formulas: determinants of
// homogeneous coordinates by elimination, and parameters of intersection points.
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
inline point3 homogeneous(const point2& a) {
    return {a[0], a[1], 1};
}

/// The determinant by elimination. All divisions are exact. Source: Bareiss 1968.
inline big_integer determinant(std::vector<std::vector<big_integer>> m) {
    big_integer last = 1;
    bool swapped = false;
    for (std::size_t k = 0; k < m.size(); ++k) {
        std::size_t pivot = k;
        while (pivot < m.size() && sign(m[pivot][k]) == 0) ++pivot;
        if (pivot == m.size()) return 0;
        if (pivot != k) std::swap(m[pivot], m[k]), swapped = !swapped;
        for (std::size_t i = k + 1; i < m.size(); ++i)
            for (std::size_t j = k + 1; j < m.size(); ++j)
                m[i][j] = exact_quotient(m[i][j] * m[k][k] - m[i][k] * m[k][j], last);
        last = m[k][k];
    }
    return swapped ? -last : last;
}
/// The determinant of rows (p, 1), or (p, height(p), 1) without the coordinates that these replace.
template <std::size_t D, std::size_t N, class... Height>
big_integer homogeneous_determinant(const std::array<point<D>, N>& p, const Height&... height) {
    constexpr std::size_t space = N - 1 - sizeof...(Height);
    std::vector<std::vector<big_integer>> rows;
    for (const auto& q : p) {
        rows.emplace_back(q.begin(), q.begin() + space);
        (rows.back().push_back(height(q)), ...);
        rows.back().push_back(1);
    }
    return determinant(std::move(rows));
}
template <std::size_t D>
big_integer squared_length(const point<D>& p, std::size_t space = D) {
    big_integer sum;
    for (std::size_t k = 0; k < space; ++k) sum = sum + p[k] * p[k];
    return sum;
}
template <std::size_t D, std::size_t N>
big_integer orient(const std::array<point<D>, N>& p) {
    return homogeneous_determinant(p);
}
template <std::size_t D, std::size_t N>
big_integer insphere(const std::array<point<D>, N>& p) {
    return homogeneous_determinant(p, [](const point<D>& q) { return squared_length(q); });
}
/// `one` is 1 in the points' unit; weights, the last coordinates, have the degree 2.
template <std::size_t D, std::size_t N>
big_integer power_insphere(const std::array<point<D>, N>& p, const big_integer& one) {
    return homogeneous_determinant(
        p, [&](const point<D>& q) { return squared_length(q, D - 1) - q[D - 1] * one; });
}

/// |a|² − |b|² − 2p·(a − b).
template <std::size_t D>
big_integer compare_distances(const std::array<point<D>, 3>& x) {
    const auto& [p, a, b] = x;
    big_integer sum;
    for (std::size_t k = 0; k < D; ++k) sum = sum + (a[k] - b[k]) * (a[k] + b[k] - (p[k] + p[k]));
    return sum;
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
    const big_integer at_a = orient(std::array{x[2], x[3], x[4], a});
    const big_integer at_b = orient(std::array{x[2], x[3], x[4], b});
    const big_integer w = at_a - at_b;
    const auto m = [&](std::size_t k) { return at_a * b[k] - at_b * a[k]; };
    const auto row = [](const point3& y) { return std::vector<big_integer>{y[0], y[1], y[2], 1}; };
    return sign(determinant({{m(0), m(1), m(2), w}, row(x[5]), row(x[6]), row(x[7])})) * sign(w);
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

}  // namespace predicate_oracle
