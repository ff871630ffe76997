// Geometric predicates, written with errbound/predicate.hpp. Orientation (y up, z towards the
// reader):
//
//            c                orient2d(a, b, c) > 0: a, b, c turn left, counterclockwise.
//           / \               orient3d(a, b, c, d) > 0: seen from d, a, b, c turn right, clockwise.
//          a---b              With a, b, c as in the picture, d is below (away from the reader).
//
// Signs are Shewchuk's (1997); CGAL's orientation of four points is the opposite of orient3d. Worst
// known cost (./run bench --worst) for coordinates of 1e-3 to 1e3, then of all magnitudes: orient2d
// 0.1 and 1 µs, orient3d and incircle 0.2 and 10 µs, insphere 1 and 30 µs; others in
// docs/measured.md. No allocation; insphere takes 40 KiB of stack.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <errbound/predicate.hpp>
#include <utility>

namespace errbound {

/// Building blocks for custom expressions.
namespace forms {

/// Twice the area of the triangle a, b, c in the plane of axes i and j, signed as orient2d.
constexpr auto area(const auto& a, const auto& b, const auto& c, int i = 0, int j = 1) {
    return (a[i] - c[i]) * (b[j] - c[j]) - (a[j] - c[j]) * (b[i] - c[i]);
}
/// Six times the volume of the tetrahedron a, b, c, d, signed as orient3d.
constexpr auto volume(const auto& a, const auto& b, const auto& c, const auto& d) {
    const auto ax = a[0] - d[0], ay = a[1] - d[1], az = a[2] - d[2];
    const auto bx = b[0] - d[0], by = b[1] - d[1], bz = b[2] - d[2];
    const auto cx = c[0] - d[0], cy = c[1] - d[1], cz = c[2] - d[2];
    return az * (bx * cy - cx * by) + bz * (cx * ay - ax * cy) + cz * (ax * by - bx * ay);
}

constexpr auto squared_distance2d(const auto& a, const auto& b) {
    const auto x = a[0] - b[0], y = a[1] - b[1];
    return x * x + y * y;
}
constexpr auto squared_distance3d(const auto& a, const auto& b) {
    const auto x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
    return x * x + y * y + z * z;
}

/// The determinant with a row (x, y, height) for each of a − d, b − d and c − d. The height is
/// height(a, x² + y²) for a's row: x² + y² for plain points, x² + y² − (w_a − w_d) for weights w.
constexpr auto lifted_area(const auto& a, const auto& b, const auto& c, const auto& d,
                           const auto& height) {
    const auto ax = a[0] - d[0], ay = a[1] - d[1];
    const auto bx = b[0] - d[0], by = b[1] - d[1];
    const auto cx = c[0] - d[0], cy = c[1] - d[1];
    return height(a, ax * ax + ay * ay) * (bx * cy - cx * by) +
           height(b, bx * bx + by * by) * (cx * ay - ax * cy) +
           height(c, cx * cx + cy * cy) * (ax * by - bx * ay);
}
/// Like lifted_area, with a row (x, y, z, height) for each of a − e, b − e, c − e and d − e.
constexpr auto lifted_volume(const auto& a, const auto& b, const auto& c, const auto& d,
                             const auto& e, const auto& height) {
    const auto ax = a[0] - e[0], ay = a[1] - e[1], az = a[2] - e[2];
    const auto bx = b[0] - e[0], by = b[1] - e[1], bz = b[2] - e[2];
    const auto cx = c[0] - e[0], cy = c[1] - e[1], cz = c[2] - e[2];
    const auto dx = d[0] - e[0], dy = d[1] - e[1], dz = d[2] - e[2];
    const auto ab = ax * by - bx * ay, bc = bx * cy - cx * by, cd = cx * dy - dx * cy,
               da = dx * ay - ax * dy, ac = ax * cy - cx * ay, bd = bx * dy - dx * by;
    const auto abc = az * bc - bz * ac + cz * ab, bcd = bz * cd - cz * bd + dz * bc,
               cda = cz * da + dz * ac + az * cd, dab = dz * ab + az * bd + bz * da;
    return (height(d, dx * dx + dy * dy + dz * dz) * abc -
            height(c, cx * cx + cy * cy + cz * cz) * dab) +
           (height(b, bx * bx + by * by + bz * bz) * cda -
            height(a, ax * ax + ay * ay + az * az) * bcd);
}
/// All sets of K of the N rows, numbered by i. rows_and_others.first[i][j] is the j-th row of set
/// i; second[i][j] is the index of set i without that row among the sets of K − 1 rows.
template <std::size_t N, std::size_t K>
struct row_sets {
    static constexpr auto all = []() {
        std::array<unsigned, 1U << N> sets{};
        std::size_t count = 0;
        for (unsigned set = 0; set < 1U << N; ++set)
            if (std::popcount(set) == static_cast<int>(K)) sets[count++] = set;
        return std::pair(sets, count);
    }();
    static constexpr std::size_t count = all.second;
    using table = std::array<std::array<unsigned char, K>, count>;
    static constexpr std::size_t index(unsigned set) {
        std::size_t i = 0;
        while (all.first[i] != set) ++i;
        return i;
    }
    static constexpr std::pair<table, table> rows_and_others = []() {
        std::pair<table, table> t{};
        for (std::size_t i = 0; i < count; ++i)
            for (std::size_t row = 0, j = 0; row < N; ++row) {
                const unsigned set = all.first[i], bit = 1U << row;
                if ((set & bit) == 0) continue;
                t.first[i][j] = static_cast<unsigned char>(row);
                t.second[i][j++] = static_cast<unsigned char>(row_sets<N, K - 1>::index(set ^ bit));
            }
        return t;
    }();
};
/// The sum with alternating signs, + for the last term: x − y + z, but y − x for two terms.
constexpr auto alternating_sum(const auto& x, const auto&... rest) {
    if constexpr (sizeof...(rest) == 0)
        return x;
    else if constexpr (sizeof...(rest) % 2 == 1)
        return alternating_sum(rest...) - x;
    else
        return alternating_sum(rest...) + x;
}
/// The minor of the first K columns and a set of rows, expanded along the last of these columns.
/// `minors` are those of the columns before. `rows` are arguments, so that one function
/// serves all sets, except in filters, which inline it.
template <std::size_t K, std::size_t... J>
constexpr auto minor_of(const auto& minors, const auto& column, std::array<unsigned char, K> rows,
                        std::array<unsigned char, K> others, std::index_sequence<J...>) {
    return alternating_sum(column[rows[J]] * minors[others[J]]...);
}
template <std::size_t N, std::size_t K>
constexpr auto expanded(const auto& minors, const auto& column, const auto&... rest) {
    const auto next = [&]<std::size_t... I>(std::index_sequence<I...>) {
        constexpr auto sets = row_sets<N, K>::rows_and_others;
        return std::array{minor_of(minors, column, sets.first[I], sets.second[I],
                                   std::make_index_sequence<K>())...};
    }
    (std::make_index_sequence<row_sets<N, K>::count>());
    if constexpr (sizeof...(rest) == 0)
        return next[0];
    else
        return expanded<N, K + 1>(next, rest...);
}
/// The determinant of these columns, each an array of numbers of one type.
constexpr auto determinant(const auto& first, const auto&... columns) {
    return expanded<sizeof...(columns) + 1, 2>(first, columns...);
}
/// D! times the volume of the simplex of the points p and o in D dimensions: the determinant of the
/// rows p − o.
constexpr auto simplex_volume(const auto& o, const auto&... p) {
    const auto column = [&](int k) { return std::array{(p[k] - o[k])...}; };
    return [&]<std::size_t... K>(std::index_sequence<K...>) {
        return determinant(column(static_cast<int>(K))...);
    }
    (std::make_index_sequence<sizeof...(p)>());
}
constexpr auto sum_of_squares(const auto& x, const auto&... rest) {
    if constexpr (sizeof...(rest) == 0)
        return x * x;
    else
        return x * x + sum_of_squares(rest...);
}
/// The determinant of simplex_volume with |p − o|² as the last column.
constexpr auto lifted_simplex_volume(const auto& o, const auto&... p) {
    const auto column = [&](int k) { return std::array{(p[k] - o[k])...}; };
    return [&]<std::size_t... K>(std::index_sequence<K...>) {
        const auto squared = [&](const auto& q) {
            return sum_of_squares((q[static_cast<int>(K)] - o[static_cast<int>(K)])...);
        };
        return determinant(column(static_cast<int>(K))..., std::array{squared(p)...});
    }
    (std::make_index_sequence<sizeof...(p) - 1>());
}
inline constexpr auto unweighted = [](const auto&, const auto& squared) { return squared; };

/// An implicit point: a point computed from others, its parents, as anchor + (x, y[, z])/w. w may
/// be negative. If an expression was multiplied by an odd power of w, to avoid the division,
/// multiply its sign by sign_of(w).
template <class Anchor, class X, class W>
struct implicit_point2d {
    const Anchor& anchor;
    X x, y;
    W w;
};
template <class Anchor, class X, class W>
struct implicit_point3d {
    const Anchor& anchor;
    X x, y, z;
    W w;
};
template <class Anchor, class X, class W>
implicit_point2d(const Anchor&, X, X, W) -> implicit_point2d<Anchor, X, W>;
template <class Anchor, class X, class W>
implicit_point3d(const Anchor&, X, X, X, W) -> implicit_point3d<Anchor, X, W>;
/// The intersection of the lines ab and cd; w = 0 if there is none or infinitely many.
constexpr auto line_line(const auto& a, const auto& b, const auto& c, const auto& d) {
    const auto x = b[0] - a[0], y = b[1] - a[1];
    const auto u = d[0] - c[0], v = d[1] - c[1];
    const auto along = (c[0] - a[0]) * v - (c[1] - a[1]) * u;
    return implicit_point2d{a, x * along, y * along, x * v - y * u};
}
/// The intersection of line ab and plane pqr; w = 0 if there is none or infinitely many.
constexpr auto line_plane(const auto& a, const auto& b, const auto& p, const auto& q,
                          const auto& r) {
    const auto x = b[0] - a[0], y = b[1] - a[1], z = b[2] - a[2];
    const auto qx = q[0] - p[0], qy = q[1] - p[1], qz = q[2] - p[2];
    const auto rx = r[0] - p[0], ry = r[1] - p[1], rz = r[2] - p[2];
    const auto nx = qy * rz - qz * ry, ny = qz * rx - qx * rz, nz = qx * ry - qy * rx;
    const auto along = nx * (p[0] - a[0]) + ny * (p[1] - a[1]) + nz * (p[2] - a[2]);
    return implicit_point3d{a, x * along, y * along, z * along, nx * x + ny * y + nz * z};
}
/// The common point of the planes abc, def and ghi; w = 0 if there is none or infinitely many.
constexpr auto three_planes(const auto& a, const auto& b, const auto& c, const auto& d,
                            const auto& e, const auto& f, const auto& g, const auto& h,
                            const auto& i) {
    const auto difference = [](const auto& p, const auto& q) {
        return std::array{p[0] - q[0], p[1] - q[1], p[2] - q[2]};
    };
    const auto cross = [](const auto& u, const auto& v) {
        return std::array{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                          u[0] * v[1] - u[1] * v[0]};
    };
    const auto dot = [](const auto& u, const auto& v) {
        return u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
    };
    const auto n = cross(difference(b, a), difference(c, a));
    const auto m = cross(difference(e, d), difference(f, d));
    const auto k = cross(difference(h, g), difference(i, g));
    const auto along_m = dot(m, difference(d, a)), along_k = dot(k, difference(g, a));
    const auto kn = cross(k, n), nm = cross(n, m);
    return implicit_point3d{a, kn[0] * along_m + nm[0] * along_k, kn[1] * along_m + nm[1] * along_k,
                            kn[2] * along_m + nm[2] * along_k, dot(m, kn)};
}
/// The point (m·a + n·b)/(m + n); w = 0 if there is none.
template <int Dimension>
constexpr auto weighted_midpoint(const auto& a, const auto& b, const auto& m, const auto& n) {
    if constexpr (Dimension == 2)
        return implicit_point2d{a, n * (b[0] - a[0]), n * (b[1] - a[1]), m + n};
    else
        return implicit_point3d{a, n * (b[0] - a[0]), n * (b[1] - a[1]), n * (b[2] - a[2]), m + n};
}

template <int Dimension = 3>
constexpr sign_type segments_intersect(const auto& a, const auto& b, const auto& c, const auto& d) {
    if constexpr (Dimension == 3) {
        const sign_type coplanar = sign_of(volume(a, b, c, d));
        if (!certain(coplanar)) return coplanar;
        if (coplanar != sign_type::zero) return sign_type::negative;
    }
    // Project along an axis. If it is parallel to the plane, all areas are zero: take the next one.
    for (int axis = Dimension == 3 ? 0 : 2; axis < 3; ++axis) {
        const int i = (axis + 1) % 3, j = (axis + 2) % 3;
        const sign_type abc = sign_of(area(a, b, c, i, j)), abd = sign_of(area(a, b, d, i, j));
        if (!certain(abc) || !certain(abd)) return sign_type::uncertain;
        const sign_type of_ab = -(abc * abd);
        if (of_ab == sign_type::negative) return of_ab;
        const sign_type cda = sign_of(area(c, d, a, i, j)), cdb = sign_of(area(c, d, b, i, j));
        if (!certain(cda) || !certain(cdb)) return sign_type::uncertain;
        if (abc == sign_type::zero && abd == sign_type::zero && cda == sign_type::zero &&
            cdb == sign_type::zero)
            continue;
        const sign_type of_cd = -(cda * cdb);
        if (of_cd == sign_type::negative) return of_cd;
        return of_ab * of_cd;
    }
    // All on one line: disjoint if disjoint along some axis.
    for (int i = 0; i < Dimension; ++i) {
        const sign_type ca = sign_of(c[i] - a[i]), cb = sign_of(c[i] - b[i]);
        const sign_type da = sign_of(d[i] - a[i]), db = sign_of(d[i] - b[i]);
        for (const sign_type s : {ca, cb, da, db})
            if (!certain(s)) return s;
        if (ca != sign_type::zero && ca == cb && ca == da && ca == db) return sign_type::negative;
    }
    return sign_type::zero;
}
constexpr sign_type segment_triangle(const auto& p, const auto& q, const auto& a, const auto& b,
                                     const auto& c) {
    const sign_type side_p = sign_of(volume(a, b, c, p)), side_q = sign_of(volume(a, b, c, q));
    if (!certain(side_p) || !certain(side_q)) return sign_type::uncertain;
    if (side_p != sign_type::zero || side_q != sign_type::zero) {
        if (side_p == side_q) return sign_type::negative;
        const sign_type ab = sign_of(volume(p, q, a, b)), bc = sign_of(volume(p, q, b, c)),
                        ca = sign_of(volume(p, q, c, a));
        const sign_type first = ab * bc, second = bc * ca, third = ca * ab;
        for (const sign_type s : {first, second, third})
            if (s == sign_type::negative || !certain(s)) return s;
        return -(side_p * side_q) * ab * bc * ca == sign_type::zero ? sign_type::zero
                                                                    : sign_type::positive;
    }
    // Coplanar, or the triangle is a segment.
    const auto at = [&](const auto& x, const auto& y) { return segments_intersect(p, q, x, y); };
    sign_type edge = at(a, b);
    if (edge == sign_type::negative) edge = at(b, c);
    if (edge == sign_type::negative) edge = at(c, a);
    if (edge != sign_type::negative) return certain(edge) ? sign_type::zero : edge;
    for (int axis = 0; axis < 3; ++axis) {
        const int i = (axis + 1) % 3, j = (axis + 2) % 3;
        const sign_type ab = sign_of(area(a, b, p, i, j)), bc = sign_of(area(b, c, p, i, j)),
                        ca = sign_of(area(c, a, p, i, j));
        for (const sign_type s : {ab, bc, ca})
            if (!certain(s)) return s;
        if (ab != sign_type::zero && ab == bc && bc == ca) return sign_type::zero;
    }
    return sign_type::negative;
}

/// Negative if two of the signs are opposite, else positive if all are nonzero, else zero.
constexpr sign_type common_side(const auto&... signs) {
    sign_type all = sign_type::positive, first = sign_type::zero;
    for (const sign_type s : {signs...}) {
        if (!certain(s)) return s;
        if (s == sign_type::zero) all = s;
        if (s == sign_type::zero || s == first) continue;
        if (first != sign_type::zero) return sign_type::negative;
        first = s;
    }
    return all;
}
constexpr sign_type point_in_triangle(const auto& p, const auto& a, const auto& b, const auto& c) {
    const sign_type ab = sign_of(area(a, b, p)), bc = sign_of(area(b, c, p)),
                    ca = sign_of(area(c, a, p));
    const sign_type inside = common_side(ab, bc, ca);
    if (!certain(inside)) return inside;
    if (ab != sign_type::zero || bc != sign_type::zero || ca != sign_type::zero) return inside;
    // All are on one line: p is outside if it is on one side of all along some axis.
    for (int i = 0; i < 2; ++i) {
        const sign_type at_a = sign_of(p[i] - a[i]), at_b = sign_of(p[i] - b[i]),
                        at_c = sign_of(p[i] - c[i]);
        for (const sign_type s : {at_a, at_b, at_c})
            if (!certain(s)) return s;
        if (at_a != sign_type::zero && at_a == at_b && at_a == at_c) return sign_type::negative;
    }
    return sign_type::zero;
}
constexpr sign_type point_in_tetrahedron(const auto& p, const auto& a, const auto& b, const auto& c,
                                         const auto& d) {
    const sign_type of_a = sign_of(volume(p, b, c, d)), of_b = sign_of(volume(a, p, c, d)),
                    of_c = sign_of(volume(a, b, p, d)), of_d = sign_of(volume(a, b, c, p));
    const sign_type inside = common_side(of_a, of_b, of_c, of_d);
    if (!certain(inside)) return inside;
    for (const sign_type s : {of_a, of_b, of_c, of_d})
        if (s != sign_type::zero) return inside;
    // All five are coplanar.
    const auto in = [&](const auto& x, const auto& y, const auto& z) {
        return segment_triangle(p, p, x, y, z);
    };
    sign_type s = in(a, b, c);
    if (s == sign_type::negative) s = in(a, b, d);
    if (s == sign_type::negative) s = in(a, c, d);
    if (s == sign_type::negative) s = in(b, c, d);
    return s;
}
/// The Minkowski sum of the box between corners a and b and the reflected segment is a polytope.
/// The two meet if it contains the origin. Each of its faces is normal to an axis, or parallel to
/// an axis and to the segment.
template <int Dimension>
constexpr sign_type segment_box(const auto& p, const auto& q, const auto& a, const auto& b) {
    bool touches = false;
    std::array<sign_type, 3> along{}, size{};
    for (int i = 0; i < Dimension; ++i) {
        const sign_type p_a = sign_of(p[i] - a[i]), q_a = sign_of(q[i] - a[i]),
                        p_b = sign_of(p[i] - b[i]), q_b = sign_of(q[i] - b[i]);
        const sign_type d = sign_of(q[i] - p[i]), e = sign_of(b[i] - a[i]);
        int positive = 0, negative = 0;
        for (const sign_type s : {p_a, q_a, p_b, q_b}) {
            if (!certain(s)) return s;
            positive += s == sign_type::positive;
            negative += s == sign_type::negative;
        }
        if (!certain(d) || !certain(e)) return sign_type::uncertain;
        if (positive == 4 || negative == 4) return sign_type::negative;
        touches = touches || positive == 0 || negative == 0;
        along[static_cast<std::size_t>(i)] = d;
        size[static_cast<std::size_t>(i)] = e;
    }
    const auto magnitude = [](const auto& from, const auto& to, int i, sign_type s) {
        return s == sign_type::negative ? from[i] - to[i] : to[i] - from[i];
    };
    for (int i = Dimension == 3 ? 0 : 2; i < 3; ++i) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        const auto at_j = static_cast<std::size_t>(j), at_k = static_cast<std::size_t>(k);
        if (along[at_j] == sign_type::zero && along[at_k] == sign_type::zero) continue;
        const auto x = q[j] - p[j], y = q[k] - p[k];
        const auto radius = magnitude(a, b, j, size[at_j]) * magnitude(p, q, k, along[at_k]) +
                            magnitude(a, b, k, size[at_k]) * magnitude(p, q, j, along[at_j]);
        const auto offset =
            ((a[j] - p[j]) + (b[j] - q[j])) * y - ((a[k] - p[k]) + (b[k] - q[k])) * x;
        const sign_type above = sign_of(radius - offset), below = sign_of(radius + offset);
        for (const sign_type s : {above, below})
            if (s == sign_type::negative || !certain(s)) return s;
        touches = touches || above == sign_type::zero || below == sign_type::zero;
    }
    return touches ? sign_type::zero : sign_type::positive;
}
constexpr sign_type compare_slopes(const auto& a, const auto& b, const auto& c, const auto& d) {
    const auto x = b[0] - a[0], y = b[1] - a[1], u = d[0] - c[0], v = d[1] - c[1];
    const sign_type of_x = sign_of(x), of_u = sign_of(u);
    if (!certain(of_x) || !certain(of_u)) return sign_type::uncertain;
    if (of_x == sign_type::zero)
        return of_u == sign_type::zero ? sign_type::zero : sign_type::positive;
    if (of_u == sign_type::zero) return sign_type::negative;
    return sign_of(y * u - v * x) * of_x * of_u;
}
constexpr sign_type compare_directions(const auto& a, const auto& b, const auto& c, const auto& d) {
    const auto x = b[0] - a[0], y = b[1] - a[1], u = d[0] - c[0], v = d[1] - c[1];
    /// Positive for angles in [0, π), negative for others.
    const auto half = [](const auto& along, const auto& up) {
        const sign_type s = sign_of(up);
        if (s != sign_type::zero) return s;
        const sign_type t = sign_of(along);
        return t == sign_type::zero ? sign_type::positive : t;
    };
    const sign_type first = half(x, y), second = half(u, v);
    if (!certain(first) || !certain(second)) return sign_type::uncertain;
    return first != second ? second : sign_of(u * y - v * x);
}
constexpr sign_type compare_angles(const auto& dot1, const auto& squares1, const auto& dot2,
                                   const auto& squares2) {
    const sign_type first = sign_of(dot1), second = sign_of(dot2);
    if (!certain(first) || !certain(second)) return sign_type::uncertain;
    if (first == sign_type::zero) return second;
    if (first != second) return -first;
    return sign_of(dot2 * dot2 * squares1 - dot1 * dot1 * squares2) * first;
}
/// The scalar product of a − o and b − o, in Dimension dimensions.
template <int Dimension>
constexpr auto dot_product(const auto& a, const auto& o, const auto& b) {
    const auto plane = (a[0] - o[0]) * (b[0] - o[0]) + (a[1] - o[1]) * (b[1] - o[1]);
    if constexpr (Dimension == 2)
        return plane;
    else
        return plane + (a[2] - o[2]) * (b[2] - o[2]);
}

}  // namespace forms

/// Positive if a, b, c turn left; zero if collinear. Proof of its static filter:
/// proofs/filters/Predicates.v, orient2d_sign_certain.
inline constexpr auto orient2d = predicate<points<2, 2, 2>>(
    [](const auto& a, const auto& b, const auto& c) { return forms::area(a, b, c); });

/// Positive if a, b, c turn right seen from d; zero if all four are coplanar. Proof:
/// proofs/filters/Predicates.v, orient3d_sign_certain.
inline constexpr auto orient3d =
    predicate<points<3, 3, 3, 3>>([](const auto& a, const auto& b, const auto& c, const auto& d) {
        return forms::volume(a, b, c, d);
    });

/// If a, b, c turn left: positive if d is inside the circle through them. If they turn right: the
/// opposite. Zero if all four are on one circle or line. Proof of its static filter:
/// proofs/filters/Predicates.v, incircle_sign_certain.
inline constexpr auto incircle =
    predicate<points<2, 2, 2, 2>>([](const auto& a, const auto& b, const auto& c, const auto& d) {
        return forms::lifted_area(a, b, c, d, forms::unweighted);
    });

/// If orient3d(a, b, c, d) is positive: positive if e is inside the sphere through them. If it is
/// negative: the opposite. Zero if all five are on one sphere or plane. Proof of its filters:
/// proofs/filters/Predicates.v, insphere_sign_certain, insphere_semi_static_certain.
inline constexpr auto insphere = predicate<points<3, 3, 3, 3, 3>>(
    [](const auto& a, const auto& b, const auto& c, const auto& d, const auto& e) {
        return forms::lifted_volume(a, b, c, d, e, forms::unweighted);
    });

/// The orientation of points in four and five dimensions: the sign of the determinant of the rows
/// a − e, b − e, c − e, d − e (a − f, ..., e − f).
inline constexpr auto orient4d = predicate<points<4, 4, 4, 4, 4>>(
    [](const auto& a, const auto& b, const auto& c, const auto& d, const auto& e) {
        return forms::simplex_volume(e, a, b, c, d);
    });
inline constexpr auto orient5d = predicate<points<5, 5, 5, 5, 5, 5>>(
    [](const auto& a, const auto& b, const auto& c, const auto& d, const auto& e, const auto& f) {
        return forms::simplex_volume(f, a, b, c, d, e);
    });
/// If the other points' orientation is positive: positive if the last is inside the sphere through
/// them. If it is negative: the opposite. Zero if all are on one sphere or hyperplane.
inline constexpr auto insphere4d = predicate<points<4, 4, 4, 4, 4, 4>>(
    [](const auto& a, const auto& b, const auto& c, const auto& d, const auto& e, const auto& f) {
        return forms::lifted_simplex_volume(f, a, b, c, d, e);
    });
inline constexpr auto insphere5d = predicate<points<5, 5, 5, 5, 5, 5, 5>>(
    [](const auto& a, const auto& b, const auto& c, const auto& d, const auto& e, const auto& f,
       const auto& g) { return forms::lifted_simplex_volume(g, a, b, c, d, e, f); });

/// Options for Count weighted points. The last of a point's `Dimension` coordinates is a squared
/// radius, of degree 2. Proof: proofs/filters/Predicates.v, power_incircle_scales,
/// power_insphere_scales.
template <std::size_t Count, std::size_t Dimension>
struct weighted_options : predicate_options {
    static constexpr std::array<int, Count* Dimension> degrees = [] {
        std::array<int, Count * Dimension> d{};
        for (std::size_t i = 0; i < d.size(); ++i) d[i] = i % Dimension == Dimension - 1 ? 2 : 1;
        return d;
    }();
};

/// incircle for weighted points x, y, w: circles of squared radius w. If a, b, c turn left:
/// positive if |d − z|² − w_d < R² for the circle (z, R) that is orthogonal to all three; R² may be
/// negative. Proof of its static filter: proofs/filters/Predicates.v, power_incircle_sign_certain.
inline constexpr auto power_incircle = predicate<points<3, 3, 3, 3>, weighted_options<4, 3>>(
    [](const auto& a, const auto& b, const auto& c, const auto& d) {
        return forms::lifted_area(a, b, c, d, [&d](const auto& p, const auto& squared) {
            return squared - (p[2] - d[2]);
        });
    });

/// insphere for weighted points x, y, z, w: spheres of squared radius w. Proof of its static
/// filter: proofs/filters/Predicates.v, power_insphere_sign_certain.
inline constexpr auto power_insphere = predicate<points<4, 4, 4, 4, 4>, weighted_options<5, 4>>(
    [](const auto& a, const auto& b, const auto& c, const auto& d, const auto& e) {
        return forms::lifted_volume(a, b, c, d, e, [&e](const auto& p, const auto& squared) {
            return squared - (p[3] - e[3]);
        });
    });

/// Negative if p is nearer to a than to b, zero if equally far. Proof of its static filter:
/// proofs/filters/Predicates.v, compare_distances2d_sign_certain, compare_distances3d_sign_certain.
inline constexpr auto compare_distances2d =
    predicate<points<2, 2, 2>>([](const auto& p, const auto& a, const auto& b) {
        return forms::squared_distance2d(p, a) - forms::squared_distance2d(p, b);
    });
inline constexpr auto compare_distances3d =
    predicate<points<3, 3, 3>>([](const auto& p, const auto& a, const auto& b) {
        return forms::squared_distance3d(p, a) - forms::squared_distance3d(p, b);
    });

/// Negative if the segment ab is shorter than cd, zero if they are equally long.
inline constexpr auto compare_lengths2d =
    predicate<points<2, 2, 2, 2>>([](const auto& a, const auto& b, const auto& c, const auto& d) {
        return forms::squared_distance2d(a, b) - forms::squared_distance2d(c, d);
    });
inline constexpr auto compare_lengths3d =
    predicate<points<3, 3, 3, 3>>([](const auto& a, const auto& b, const auto& c, const auto& d) {
        return forms::squared_distance3d(a, b) - forms::squared_distance3d(c, d);
    });
/// Negative if the slope of the line ab is less than that of cd; slopes are signed, and a vertical
/// line has +∞. Precondition: a != b, c != d.
inline constexpr auto compare_slopes =
    predicate<points<2, 2, 2, 2>>([](const auto& a, const auto& b, const auto& c, const auto& d) {
        return forms::compare_slopes(a, b, c, d);
    });
/// Negative if the direction from a to b comes before that from c to d, counterclockwise from the x
/// axis, from 0 to 2π. A zero vector compares as equal to every direction below π, and comes
/// before the others.
inline constexpr auto compare_directions =
    predicate<points<2, 2, 2, 2>>([](const auto& a, const auto& b, const auto& c, const auto& d) {
        return forms::compare_directions(a, b, c, d);
    });
/// Negative if the angle abc (at b, at most π) is less than the angle def. Angles of a zero vector
/// count as right angles.
inline constexpr auto compare_angles2d = predicate<points<2, 2, 2, 2, 2, 2>>(
    [](const auto& a, const auto& b, const auto& c, const auto& d, const auto& e, const auto& f) {
        using namespace forms;
        return forms::compare_angles(
            dot_product<2>(a, b, c), squared_distance2d(a, b) * squared_distance2d(c, b),
            dot_product<2>(d, e, f), squared_distance2d(d, e) * squared_distance2d(f, e));
    });
inline constexpr auto compare_angles3d = predicate<points<3, 3, 3, 3, 3, 3>>(
    [](const auto& a, const auto& b, const auto& c, const auto& d, const auto& e, const auto& f) {
        using namespace forms;
        return forms::compare_angles(
            dot_product<3>(a, b, c), squared_distance3d(a, b) * squared_distance3d(c, b),
            dot_product<3>(d, e, f), squared_distance3d(d, e) * squared_distance3d(f, e));
    });

/// Options for homogeneous expressions with too many branches to analyse at compile time.
struct homogeneous_options : predicate_options {
    static constexpr bool homogeneous = true;
};

/// For closed segments ab and cd: positive if they cross in one point inside both, zero if they
/// touch otherwise or overlap, negative if disjoint. A degenerate segment counts as a point.
inline constexpr auto segments_intersect2d = predicate<points<2, 2, 2, 2>, homogeneous_options>(
    [](const auto& a, const auto& b, const auto& c, const auto& d) {
        return forms::segments_intersect<2>(a, b, c, d);
    });
inline constexpr auto segments_intersect3d = predicate<points<3, 3, 3, 3>, homogeneous_options>(
    [](const auto& a, const auto& b, const auto& c, const auto& d) {
        return forms::segments_intersect(a, b, c, d);
    });

/// Like segments_intersect3d, for a closed segment pq and triangle abc. Degenerate ones count as
/// segments or points.
inline constexpr auto segment_intersects_triangle =
    predicate<points<3, 3, 3, 3, 3>, homogeneous_options>(
        [](const auto& p, const auto& q, const auto& a, const auto& b, const auto& c) {
            return forms::segment_triangle(p, q, a, b, c);
        });

/// Positive if p is inside the triangle or tetrahedron, zero on its border, negative outside.
/// Degenerate ones have no inside.
inline constexpr auto point_in_triangle2d = predicate<points<2, 2, 2, 2>, homogeneous_options>(
    [](const auto& p, const auto& a, const auto& b, const auto& c) {
        return forms::point_in_triangle(p, a, b, c);
    });
inline constexpr auto point_in_tetrahedron = predicate<points<3, 3, 3, 3, 3>, homogeneous_options>(
    [](const auto& p, const auto& a, const auto& b, const auto& c, const auto& d) {
        return forms::point_in_tetrahedron(p, a, b, c, d);
    });

/// For a closed segment pq and the closed box with opposite corners a and b: positive if small
/// motions do not separate them, zero if they touch otherwise, negative if they are disjoint.
inline constexpr auto segment_intersects_box2d = predicate<points<2, 2, 2, 2>, homogeneous_options>(
    [](const auto& p, const auto& q, const auto& a, const auto& b) {
        return forms::segment_box<2>(p, q, a, b);
    });
inline constexpr auto segment_intersects_box3d = predicate<points<3, 3, 3, 3>, homogeneous_options>(
    [](const auto& p, const auto& q, const auto& a, const auto& b) {
        return forms::segment_box<3>(p, q, a, b);
    });

/// orient2d(p, q, r) for p, the intersection of lines ab and cd; zero if they are parallel. Proof:
/// proofs/filters/ImplicitPoints.v, orient2d_line_line_right, orient2d_line_line_sign_certain.
inline constexpr auto orient2d_line_line = predicate<points<2, 2, 2, 2, 2, 2>>(
    [](const auto& a, const auto& b, const auto& c, const auto& d, const auto& q, const auto& r) {
        const auto p = forms::line_line(a, b, c, d);
        const auto x = (a[0] - r[0]) * p.w + p.x, y = (a[1] - r[1]) * p.w + p.y;
        return sign_of(x * (q[1] - r[1]) - y * (q[0] - r[0])) * sign_of(p.w);
    });

/// orient3d(i, s, t, u) for i, where line ab meets plane pqr; zero if they are parallel.
/// Proof: proofs/filters/ImplicitPoints.v, orient3d_line_plane_right,
/// orient3d_line_plane_sign_certain.
inline constexpr auto orient3d_line_plane = predicate<points<3, 3, 3, 3, 3, 3, 3, 3>>(
    [](const auto& a, const auto& b, const auto& p, const auto& q, const auto& r, const auto& s,
       const auto& t, const auto& u) {
        const auto i = forms::line_plane(a, b, p, q, r);
        const auto x = (a[0] - u[0]) * i.w + i.x, y = (a[1] - u[1]) * i.w + i.y,
                   z = (a[2] - u[2]) * i.w + i.z;
        const auto sx = s[0] - u[0], sy = s[1] - u[1], sz = s[2] - u[2];
        const auto tx = t[0] - u[0], ty = t[1] - u[1], tz = t[2] - u[2];
        return sign_of(x * (sy * tz - sz * ty) + y * (sz * tx - sx * tz) +
                       z * (sx * ty - sy * tx)) *
               sign_of(i.w);
    });

/// Compares the x coordinates of p, the intersection of lines ab and cd, and q, that of ef and gh:
/// positive if p's is larger, zero if p or q does not exist. Proof:
/// proofs/filters/ImplicitPoints.v, compare_x_line_line_right, compare_x_line_line_sign_certain.
inline constexpr auto compare_x_line_line = predicate<points<2, 2, 2, 2, 2, 2, 2, 2>>(
    [](const auto& a, const auto& b, const auto& c, const auto& d, const auto& e, const auto& f,
       const auto& g, const auto& h) {
        const auto p = forms::line_line(a, b, c, d);
        const auto q = forms::line_line(e, f, g, h);
        return sign_of((a[0] - e[0]) * (p.w * q.w) + (p.x * q.w - q.x * p.w)) * sign_of(p.w) *
               sign_of(q.w);
    });

}  // namespace errbound
