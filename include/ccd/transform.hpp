// Queries as lists of their moving points: conversion of every coordinate by one function.
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

/// `f` applied to the three coordinates.
template <class T, class F>
constexpr auto transformed(const point<T>& p, const F& f) {
    return point<decltype(f(p.x))>{f(p.x), f(p.y), f(p.z)};
}
template <class T, class F>
constexpr auto transformed(const moving_point<T>& p, const F& f) {
    return moving_point<decltype(f(p.t0.x))>{transformed(p.t0, f), transformed(p.t1, f)};
}
template <class T, class F>
constexpr auto transformed(const vertex_face<T>& q, const F& f) {
    return vertex_face<decltype(f(q.v.t0.x))>{transformed(q.v, f), transformed(q.f0, f),
                                              transformed(q.f1, f), transformed(q.f2, f)};
}
template <class T, class F>
constexpr auto transformed(const edge_edge<T>& q, const F& f) {
    return edge_edge<decltype(f(q.a0.t0.x))>{transformed(q.a0, f), transformed(q.a1, f),
                                             transformed(q.b0, f), transformed(q.b1, f)};
}
template <class T, class F>
constexpr auto transformed(const vertex_edge<T>& q, const F& f) {
    return vertex_edge<decltype(f(q.v.t0.x))>{transformed(q.v, f), transformed(q.e0, f),
                                              transformed(q.e1, f)};
}
template <class T, class F>
constexpr auto transformed(const vertex_vertex<T>& q, const F& f) {
    return vertex_vertex<decltype(f(q.v.t0.x))>{transformed(q.v, f), transformed(q.w, f)};
}

/// `f` called with each of the query's coordinates.
template <class Query, class F>
constexpr void for_each_coordinate(const Query& q, const F& f) {
    for (const auto& p : points_of(q))
        for (const auto& x : {p.t0, p.t1}) {
            f(x.x);
            f(x.y);
            f(x.z);
        }
}

}  // namespace ccd
