// Queries as lists of their moving points, conversion of every position or coordinate, and the
// vertex/edge queries that bound a query.
#pragma once

#include <array>
#include <ccd/query.hpp>

namespace ccd {

template <class T>
constexpr std::array<moving_point<T>, 4> points_of(const vertex_face<T>& q) {
    return {q.v, q.f0, q.f1, q.f2};
}
template <class T>
constexpr std::array<moving_point<T>, 4> points_of(const edge_edge<T>& q) {
    return {q.a0, q.a1, q.b0, q.b1};
}
template <class T>
constexpr std::array<moving_point<T>, 3> points_of(const vertex_edge<T>& q) {
    return {q.v, q.e0, q.e1};
}
template <class T>
constexpr std::array<moving_point<T>, 2> points_of(const vertex_vertex<T>& q) {
    return {q.v, q.w};
}

/// The query with `f` applied to the motion of every point.
template <class T, class F>
constexpr auto transformed_motions(const vertex_face<T>& q, const F& f) {
    return vertex_face<decltype(f(q.v).t0.x)>{f(q.v), f(q.f0), f(q.f1), f(q.f2)};
}
template <class T, class F>
constexpr auto transformed_motions(const edge_edge<T>& q, const F& f) {
    return edge_edge<decltype(f(q.a0).t0.x)>{f(q.a0), f(q.a1), f(q.b0), f(q.b1)};
}
template <class T, class F>
constexpr auto transformed_motions(const vertex_edge<T>& q, const F& f) {
    return vertex_edge<decltype(f(q.v).t0.x)>{f(q.v), f(q.e0), f(q.e1)};
}
template <class T, class F>
constexpr auto transformed_motions(const vertex_vertex<T>& q, const F& f) {
    return vertex_vertex<decltype(f(q.v).t0.x)>{f(q.v), f(q.w)};
}

/// The query with `f` applied to every position.
template <class Query, class F>
constexpr auto transformed_points(const Query& q, const F& f) {
    return transformed_motions(q, [&f](const auto& p) {
        return moving_point<decltype(f(p.t0).x)>{f(p.t0), f(p.t1)};
    });
}

/// The query with `f` applied to every coordinate.
template <class Query, class F>
constexpr auto transformed(const Query& q, const F& f) {
    return transformed_points(q, [&f](const auto& p) {
        return point<decltype(f(p.x))>{f(p.x), f(p.y), f(p.z)};
    });
}

/// `f` called with each of the query's coordinates.
template <class Query, class F>
constexpr void for_each_coordinate(const Query& q, const F& f) {
    const auto at_position = [&f](const auto& x) {
        f(x.x);
        f(x.y);
        f(x.z);
    };
    for (const auto& p : points_of(q)) {
        at_position(p.t0);
        at_position(p.t1);
    }
}

/// The contacts of a vertex with an edge on the border of the face.
template <class T>
constexpr std::array<vertex_edge<T>, 3> vertex_edge_queries(const vertex_face<T>& q) {
    return {{{q.v, q.f0, q.f1}, {q.v, q.f1, q.f2}, {q.v, q.f2, q.f0}}};
}
/// The contacts of an end of one edge with the other edge.
template <class T>
constexpr std::array<vertex_edge<T>, 4> vertex_edge_queries(const edge_edge<T>& q) {
    return {{{q.a0, q.b0, q.b1}, {q.a1, q.b0, q.b1}, {q.b0, q.a0, q.a1}, {q.b1, q.a0, q.a1}}};
}

}  // namespace ccd
