// The points of a query as an array, maps of positions, and the vertex/edge queries that bound a
// query.
#pragma once

#include <array>
#include <ccd/kind.hpp>
#include <ccd/query.hpp>

namespace ccd {

/// The moving points of a query, in the order of its members.
template <detail::has_kind Query>
constexpr auto points_of(const Query& q) {
    return detail::with_members(q, [](const auto&... p) { return std::array{p...}; });
}

/// The query with `f` applied to every motion, position or coordinate.
template <detail::has_kind Query, class F>
constexpr auto transformed_motions(const Query& q, const F& f) {
    return detail::with_members(q, [&f](const auto& first, const auto&... others) {
        using scalar = decltype(f(first).t0.x);
        return query_of_pair<Query, scalar>{f(first), f(others)...};
    });
}

template <class Query, class F>
constexpr auto transformed_points(const Query& q, const F& f) {
    return transformed_motions(q, [&f](const auto& p) {
        return moving_point<decltype(f(p.t0).x)>{f(p.t0), f(p.t1)};
    });
}

template <class Query, class F>
constexpr auto transformed(const Query& q, const F& f) {
    return transformed_points(q, [&f](const auto& p) {
        return point<decltype(f(p.x))>{f(p.x), f(p.y), f(p.z)};
    });
}

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
