// Queries in the plane: a vertex and an edge, or two vertices, with positions of two coordinates.
//
// What exact.hpp, contact.hpp and separation.hpp promise of space, by the same code at z = 0. That
// loses nothing: features of the plane share a point, or have a distance, in space exactly if they
// do in the plane; and an axis on which all is 0 takes no bits, and costs a few products with 0.
// (A contact of two edges begins at an end of one of them, unless they cross at the start: vertex
// and edge is all that motion in the plane needs.)
#pragma once

#include <ccd/contact.hpp>
#include <ccd/contact_data.hpp>
#include <ccd/exact.hpp>
#include <ccd/query.hpp>
#include <ccd/separation.hpp>
#include <ccd/verdict.hpp>

/// Queries of two dimensions: the same calls as in space, in namespace ccd.
namespace ccd::plane {

/// A position.
struct point {
    double x = 0, y = 0;
    friend bool operator==(const point&, const point&) = default;
};

/// A point that moves linearly over the step: x(t) = (1 − t)·t0 + t·t1 for t in [0, 1].
struct moving_point {
    point t0, t1;
    friend bool operator==(const moving_point&, const moving_point&) = default;
};

/// Vertex v and the closed edge e0 e1.
struct vertex_edge {
    moving_point v, e0, e1;
};

/// Two vertices.
struct vertex_vertex {
    moving_point v, w;
};

/// The query in space, at z = 0.
constexpr ccd::moving_point<double> in_space(const moving_point& p) {
    return {{p.t0.x, p.t0.y, 0}, {p.t1.x, p.t1.y, 0}};
}
constexpr ccd::vertex_edge<double> in_space(const vertex_edge& q) {
    return {in_space(q.v), in_space(q.e0), in_space(q.e1)};
}
constexpr ccd::vertex_vertex<double> in_space(const vertex_vertex& q) {
    return {in_space(q.v), in_space(q.w)};
}

/// Whether they touch at some t in [0, 1]: as ccd/exact.hpp says.
inline verdict decide_exact(const vertex_edge& query) {
    return ccd::decide_exact(in_space(query));
}
inline verdict decide_exact(const vertex_vertex& query) {
    return ccd::decide_exact(in_space(query));
}
/// Whether they do at t = 0.
inline verdict touches_at_start(const vertex_edge& query) {
    return ccd::touches_at_start(in_space(query));
}
inline verdict touches_at_start(const vertex_vertex& query) {
    return ccd::touches_at_start(in_space(query));
}

/// When they first touch: as ccd/contact.hpp says.
inline first_time time_of_impact(const vertex_edge& query, double t_max = 1) {
    return ccd::time_of_impact(in_space(query), t_max);
}
inline first_time time_of_impact(const vertex_vertex& query, double t_max = 1) {
    return ccd::time_of_impact(in_space(query), t_max);
}

/// The first contact and its data: as ccd/contact_data.hpp says; the normal lies in the plane.
inline first_contact find_first_contact(const vertex_edge& query, double t_max = 1) {
    return ccd::find_first_contact(in_space(query), t_max);
}
inline first_contact find_first_contact(const vertex_vertex& query, double t_max = 1) {
    return ccd::find_first_contact(in_space(query), t_max);
}

/// Whether, and when first, they come within d: as ccd/separation.hpp says.
inline verdict decide_within(const vertex_edge& query, separation d) {
    return ccd::decide_within(in_space(query), d);
}
inline verdict decide_within(const vertex_vertex& query, separation d) {
    return ccd::decide_within(in_space(query), d);
}
inline first_time time_within(const vertex_edge& query, separation d, double t_max = 1) {
    return ccd::time_within(in_space(query), d, t_max);
}
inline first_time time_within(const vertex_vertex& query, separation d, double t_max = 1) {
    return ccd::time_within(in_space(query), d, t_max);
}

}  // namespace ccd::plane
