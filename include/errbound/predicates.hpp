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
#include <cstddef>
#include <errbound/predicate.hpp>

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
        const sign_type cda = sign_of(area(c, d, a, i, j)), cdb = sign_of(area(c, d, b, i, j));
        for (const sign_type s : {abc, abd, cda, cdb})
            if (!certain(s)) return s;
        if (abc == sign_type::zero && abd == sign_type::zero && cda == sign_type::zero &&
            cdb == sign_type::zero)
            continue;
        const sign_type of_ab = -(abc * abd), of_cd = -(cda * cdb);
        if (of_ab == sign_type::negative || of_cd == sign_type::negative)
            return sign_type::negative;
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
    const sign_type at_ab = segments_intersect(p, q, a, b), at_bc = segments_intersect(p, q, b, c),
                    at_ca = segments_intersect(p, q, c, a);
    for (const sign_type s : {at_ab, at_bc, at_ca})
        if (!certain(s)) return s;
    for (const sign_type s : {at_ab, at_bc, at_ca})
        if (s != sign_type::negative) return sign_type::zero;
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

}  // namespace forms

/// Positive if a, b, c turn left; zero if collinear. Proof of its static filter:
/// proofs/Predicates.v, orient2d_sign_certain.
inline constexpr auto orient2d = predicate<points<2, 2, 2>>(
    [](const auto& a, const auto& b, const auto& c) { return forms::area(a, b, c); });

/// Positive if a, b, c turn right seen from d; zero if all four are coplanar. Proof:
/// proofs/Predicates.v, orient3d_sign_certain.
inline constexpr auto orient3d =
    predicate<points<3, 3, 3, 3>>([](const auto& a, const auto& b, const auto& c, const auto& d) {
        return forms::volume(a, b, c, d);
    });

/// If a, b, c turn left: positive if d is inside the circle through them. If they turn right: the
/// opposite. Zero if all four are on one circle or line. Proof of its static filter:
/// proofs/Predicates.v, incircle_sign_certain.
inline constexpr auto incircle =
    predicate<points<2, 2, 2, 2>>([](const auto& a, const auto& b, const auto& c, const auto& d) {
        return forms::lifted_area(a, b, c, d, forms::unweighted);
    });

/// If orient3d(a, b, c, d) is positive: positive if e is inside the sphere through them. If it is
/// negative: the opposite. Zero if all five are on one sphere or plane. Proof of its filters:
/// proofs/Predicates.v, insphere_sign_certain, insphere_semi_static_certain.
inline constexpr auto insphere = predicate<points<3, 3, 3, 3, 3>>(
    [](const auto& a, const auto& b, const auto& c, const auto& d, const auto& e) {
        return forms::lifted_volume(a, b, c, d, e, forms::unweighted);
    });

/// Options for Count weighted points. The last of a point's `Dimension` coordinates is a squared
/// radius, of degree 2. Proof: proofs/Predicates.v, power_incircle_scales, power_insphere_scales.
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
/// negative. Proof of its static filter: proofs/Predicates.v, power_incircle_sign_certain.
inline constexpr auto power_incircle = predicate<points<3, 3, 3, 3>, weighted_options<4, 3>>(
    [](const auto& a, const auto& b, const auto& c, const auto& d) {
        return forms::lifted_area(a, b, c, d, [&d](const auto& p, const auto& squared) {
            return squared - (p[2] - d[2]);
        });
    });

/// insphere for weighted points x, y, z, w: spheres of squared radius w. Proof of its static
/// filter: proofs/Predicates.v, power_insphere_sign_certain.
inline constexpr auto power_insphere = predicate<points<4, 4, 4, 4, 4>, weighted_options<5, 4>>(
    [](const auto& a, const auto& b, const auto& c, const auto& d, const auto& e) {
        return forms::lifted_volume(a, b, c, d, e, [&e](const auto& p, const auto& squared) {
            return squared - (p[3] - e[3]);
        });
    });

/// Negative if p is nearer to a than to b, zero if equally far. Proof of its static filter:
/// proofs/Predicates.v, compare_distances2d_sign_certain, compare_distances3d_sign_certain.
inline constexpr auto compare_distances2d =
    predicate<points<2, 2, 2>>([](const auto& p, const auto& a, const auto& b) {
        return forms::squared_distance2d(p, a) - forms::squared_distance2d(p, b);
    });
inline constexpr auto compare_distances3d =
    predicate<points<3, 3, 3>>([](const auto& p, const auto& a, const auto& b) {
        return forms::squared_distance3d(p, a) - forms::squared_distance3d(p, b);
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

/// orient2d(p, q, r) for p, the intersection of lines ab and cd; zero if they are parallel. Proof:
/// proofs/ImplicitPoints.v, orient2d_line_line_right, orient2d_line_line_sign_certain.
inline constexpr auto orient2d_line_line = predicate<points<2, 2, 2, 2, 2, 2>>(
    [](const auto& a, const auto& b, const auto& c, const auto& d, const auto& q, const auto& r) {
        const auto p = forms::line_line(a, b, c, d);
        const auto x = (a[0] - r[0]) * p.w + p.x, y = (a[1] - r[1]) * p.w + p.y;
        return sign_of(x * (q[1] - r[1]) - y * (q[0] - r[0])) * sign_of(p.w);
    });

/// orient3d(i, s, t, u) for i, where line ab meets plane pqr; zero if they are parallel.
/// Proof: proofs/ImplicitPoints.v, orient3d_line_plane_right, orient3d_line_plane_sign_certain.
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
/// positive if p's is larger, zero if p or q does not exist. Proof: proofs/ImplicitPoints.v,
/// compare_x_line_line_right, compare_x_line_line_sign_certain.
inline constexpr auto compare_x_line_line = predicate<points<2, 2, 2, 2, 2, 2, 2, 2>>(
    [](const auto& a, const auto& b, const auto& c, const auto& d, const auto& e, const auto& f,
       const auto& g, const auto& h) {
        const auto p = forms::line_line(a, b, c, d);
        const auto q = forms::line_line(e, f, g, h);
        return sign_of((a[0] - e[0]) * (p.w * q.w) + (p.x * q.w - q.x * p.w)) * sign_of(p.w) *
               sign_of(q.w);
    });

}  // namespace errbound
