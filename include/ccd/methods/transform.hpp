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

/// The query with `f` applied to every position.
template <class T, class F>
constexpr auto transformed_points(const moving_point<T>& p, const F& f) {
    return moving_point<decltype(f(p.t0).x)>{f(p.t0), f(p.t1)};
}
template <class T, class F>
constexpr auto transformed_points(const vertex_face<T>& q, const F& f) {
    const auto g = [&f](const moving_point<T>& p) { return transformed_points(p, f); };
    return vertex_face<decltype(f(q.v.t0).x)>{g(q.v), g(q.f0), g(q.f1), g(q.f2)};
}
template <class T, class F>
constexpr auto transformed_points(const edge_edge<T>& q, const F& f) {
    const auto g = [&f](const moving_point<T>& p) { return transformed_points(p, f); };
    return edge_edge<decltype(f(q.a0.t0).x)>{g(q.a0), g(q.a1), g(q.b0), g(q.b1)};
}
template <class T, class F>
constexpr auto transformed_points(const vertex_edge<T>& q, const F& f) {
    const auto g = [&f](const moving_point<T>& p) { return transformed_points(p, f); };
    return vertex_edge<decltype(f(q.v.t0).x)>{g(q.v), g(q.e0), g(q.e1)};
}
template <class T, class F>
constexpr auto transformed_points(const vertex_vertex<T>& q, const F& f) {
    const auto g = [&f](const moving_point<T>& p) { return transformed_points(p, f); };
    return vertex_vertex<decltype(f(q.v.t0).x)>{g(q.v), g(q.w)};
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
