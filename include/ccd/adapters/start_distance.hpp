// An estimate, without guarantee, of the distance of a query's features at the start: a length to
// choose gaps by. It is far too large for some slivers and nearly parallel edges. It may be 0,
// infinite or NaN if products of the coordinates' differences underflow or overflow.
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

inline point<double> along(const point<double>& p, const point<double>& direction, double s) {
    return {p.x + s * direction.x, p.y + s * direction.y, p.z + s * direction.z};
}

inline double distance(const point<double>& p, const point<double>& e0, const point<double>& e1) {
    const point<double> e = difference(e1, e0), to_p = difference(p, e0);
    const double square = dot(e, e);
    const double s = square > 0 ? std::clamp(dot(to_p, e) / square, 0.0, 1.0) : 0;
    const point<double> rest = along(to_p, e, -s);
    return std::sqrt(dot(rest, rest));
}

inline double start_distance(const vertex_vertex<double>& q) {
    return distance(q.v.t0, q.w.t0, q.w.t0);
}
inline double start_distance(const vertex_edge<double>& q) {
    return distance(q.v.t0, q.e0.t0, q.e1.t0);
}

/// The vertex's least distance from an edge, or from its foot on the plane if that is inside. (The
/// rounded foot is a point of the face: a distance along the normal of a sliver might be far too
/// small.)
inline double start_distance(const vertex_face<double>& q) {
    const point<double> v = q.v.t0, f[] = {q.f0.t0, q.f1.t0, q.f2.t0};
    const point<double> n = cross(difference(f[1], f[0]), difference(f[2], f[0]));
    double least = std::numeric_limits<double>::infinity(), weights[3];
    for (int i = 0; i < 3; ++i) {
        const point<double> a = f[i], b = f[(i + 1) % 3];
        least = (std::min)(least, distance(v, a, b));
        weights[(i + 2) % 3] = dot(n, cross(difference(b, a), difference(v, a)));
    }
    if (!(weights[0] >= 0 && weights[1] >= 0 && weights[2] >= 0)) return least;
    const double sum = weights[0] + weights[1] + weights[2];
    const point<double> towards_f1 = along(f[0], difference(f[1], f[0]), weights[1] / sum);
    const point<double> foot = along(towards_f1, difference(f[2], f[0]), weights[2] / sum);
    return (std::min)(least, distance(v, foot, foot));
}

/// The least distance of an end from the other edge, or of the lines' nearest points if these are
/// inside.
inline double start_distance(const edge_edge<double>& q) {
    const point<double> a0 = q.a0.t0, a1 = q.a1.t0, b0 = q.b0.t0, b1 = q.b1.t0;
    const point<double> a = difference(a1, a0), b = difference(b1, b0), w = difference(b0, a0);
    const double ends = (std::min)(
        {distance(b1, a0, a1), distance(b0, a0, a1), distance(a1, b0, b1), distance(a0, b0, b1)});
    const point<double> n = cross(a, b);
    const double s = dot(cross(w, b), n) / dot(n, n), t = dot(cross(w, a), n) / dot(n, n);
    if (!(0 <= s && s <= 1 && 0 <= t && t <= 1)) return ends;
    const point<double> on_b = along(b0, b, t);
    return (std::min)(ends, distance(along(a0, a, s), on_b, on_b));
}

}  // namespace ccd::adapters::detail
