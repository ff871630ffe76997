// About how far the features of a query are apart at the start, in doubles: a length to choose gaps
// by, of which nothing is promised. Where products of the coordinates' differences underflow or
// overflow it may be 0, infinite or NaN.
#pragma once

#include <algorithm>
#include <ccd/query.hpp>
#include <cmath>
#include <limits>

namespace ccd::adapters::detail {

inline point<double> difference(const point<double>& a, const point<double>& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline double dot(const point<double>& a, const point<double>& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline point<double> cross(const point<double>& a, const point<double>& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Of p and the segment e0 e1.
inline double distance(const point<double>& p, const point<double>& e0, const point<double>& e1) {
    const point<double> e = difference(e1, e0), to_p = difference(p, e0);
    const double square = dot(e, e);
    const double s = square > 0 ? std::clamp(dot(to_p, e) / square, 0.0, 1.0) : 0;
    const point<double> rest = difference(to_p, {s * e.x, s * e.y, s * e.z});
    return std::sqrt(dot(rest, rest));
}

/// Of two planes with the normal n and the difference w of a point of each; infinite if n is 0.
inline double between_planes(const point<double>& n, const point<double>& w) {
    const double square = dot(n, n);
    return square > 0 ? std::abs(dot(n, w)) / std::sqrt(square)
                      : std::numeric_limits<double>::infinity();
}

inline double start_distance(const vertex_vertex<double>& q) {
    return distance(q.v.t0, q.w.t0, q.w.t0);
}
inline double start_distance(const vertex_edge<double>& q) {
    return distance(q.v.t0, q.e0.t0, q.e1.t0);
}

/// The least distance to an edge, or that to the plane if the foot is inside.
inline double start_distance(const vertex_face<double>& q) {
    const point<double> v = q.v.t0, f[] = {q.f0.t0, q.f1.t0, q.f2.t0};
    const point<double> n = cross(difference(f[1], f[0]), difference(f[2], f[0]));
    double least = std::numeric_limits<double>::infinity();
    bool inside = true;
    for (int i = 0; i < 3; ++i) {
        const point<double> a = f[i], b = f[(i + 1) % 3];
        least = std::min(least, distance(v, a, b));
        inside &= dot(n, cross(difference(b, a), difference(v, a))) >= 0;
    }
    return inside ? std::min(least, between_planes(n, difference(v, f[0]))) : least;
}

/// The least distance of an end to the other edge, or that of the lines if it is at inner points.
inline double start_distance(const edge_edge<double>& q) {
    const point<double> a0 = q.a0.t0, a1 = q.a1.t0, b0 = q.b0.t0, b1 = q.b1.t0;
    const point<double> a = difference(a1, a0), b = difference(b1, b0), w = difference(b0, a0);
    const double ends = std::min(
        {distance(b1, a0, a1), distance(b0, a0, a1), distance(a1, b0, b1), distance(a0, b0, b1)});
    const point<double> n = cross(a, b);
    const double square = dot(n, n), s = dot(cross(w, b), n), t = dot(cross(w, a), n);
    const bool inside = 0 <= s && s <= square && 0 <= t && t <= square;
    return inside ? std::min(ends, between_planes(n, w)) : ends;
}

}  // namespace ccd::adapters::detail
