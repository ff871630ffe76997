// The four kinds of query: named points, each on a straight line over one step.
#pragma once

#include <errbound/environment.hpp>  // rejects compiler options that void every promise

namespace ccd {

/// A position, in any one length unit for all points of a query.
template <class T = double>
struct point {
    T x{}, y{}, z{};
    friend bool operator==(const point&, const point&) = default;
};

/// A point that moves linearly over the step: x(t) = (1 − t)·t0 + t·t1 for t in [0, 1].
template <class T = double>
struct moving_point {
    point<T> t0{}, t1{};
    friend bool operator==(const moving_point&, const moving_point&) = default;
};

/// Vertex v and the closed triangle f0 f1 f2.
template <class T = double>
struct vertex_face {
    moving_point<T> v, f0, f1, f2;
};

/// The closed edges a0 a1 and b0 b1.
template <class T = double>
struct edge_edge {
    moving_point<T> a0, a1, b0, b1;
};

/// Vertex v and the closed edge e0 e1.
template <class T = double>
struct vertex_edge {
    moving_point<T> v, e0, e1;
};

template <class T = double>
struct vertex_vertex {
    moving_point<T> v, w;
};

/// A distance d: the exact sum of two finite numbers >= 0, such as the thicknesses of the two
/// features, in the unit of the coordinates.
struct separation {
    double first = 0, second = 0;
};

}  // namespace ccd
