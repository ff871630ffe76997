// Queries in the plane: a vertex and an edge, or two vertices, with positions x, y.
//
// The calls of ccd/exact.hpp, ccd/contact.hpp and ccd/nearness.hpp at z = 0, with the same
// guarantees and almost the same cost. A contact of two edges begins at an end of one of them,
// unless they cross at t = 0. So the kinds vertex/edge and vertex/vertex suffice.
#pragma once

#include <ccd/contact.hpp>
#include <ccd/exact.hpp>
#include <ccd/nearness.hpp>
#include <ccd/query.hpp>
#include <ccd/verdict.hpp>

/// Queries of two dimensions, by the calls of namespace ccd.
namespace ccd::plane {

struct point {
    double x = 0, y = 0;
    friend bool operator==(const point&, const point&) = default;
};

/// Linear motion, as ccd::moving_point.
struct moving_point {
    point t0, t1;
    friend bool operator==(const moving_point&, const moving_point&) = default;
};

/// Vertex v and the closed edge e0 e1.
struct vertex_edge {
    moving_point v, e0, e1;
};

struct vertex_vertex {
    moving_point v, w;
};

constexpr ccd::moving_point<double> in_space(const moving_point& p) {
    return {{p.t0.x, p.t0.y, 0}, {p.t1.x, p.t1.y, 0}};
}
constexpr ccd::vertex_edge<double> in_space(const vertex_edge& q) {
    return {in_space(q.v), in_space(q.e0), in_space(q.e1)};
}
constexpr ccd::vertex_vertex<double> in_space(const vertex_vertex& q) {
    return {in_space(q.v), in_space(q.w)};
}

template <class T>
concept any_query = std::same_as<T, vertex_edge> || std::same_as<T, vertex_vertex>;

/// Same as in ccd/exact.hpp.
template <any_query Query>
verdict decide_exact(const Query& query) {
    return ccd::decide_exact(in_space(query));
}
template <any_query Query>
verdict touches_at_start(const Query& query) {
    return ccd::touches_at_start(in_space(query));
}

/// Same as in ccd/contact.hpp. The normal lies in the plane.
template <any_query Query>
first_time time_of_impact(const Query& query, double t_max = 1) {
    return ccd::time_of_impact(in_space(query), t_max);
}
template <any_query Query>
first_contact find_first_contact(const Query& query, double t_max = 1) {
    return ccd::find_first_contact(in_space(query), t_max);
}
template <any_query Query>
time_derivative derivative_of(const Query& query, const first_contact& contact) {
    return ccd::derivative_of(in_space(query), contact);
}
template <any_query Query>
verdict decide_within(const Query& query, separation d) {
    return ccd::decide_within(in_space(query), d);
}
template <any_query Query>
first_time time_within(const Query& query, separation d, double t_max = 1) {
    return ccd::time_within(in_space(query), d, t_max);
}

/// Same as in ccd/nearness.hpp. The normal lies in the plane.
template <any_query Query>
nearness nearness_of(const Query& query, double t = 0) {
    return ccd::nearness_of(in_space(query), t);
}

}  // namespace ccd::plane
