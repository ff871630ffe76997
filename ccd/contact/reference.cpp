// First times in unbounded integers: see include/ccd/reference.hpp for what they promise.
#include <array>
#include <ccd/curves.hpp>
#include <ccd/kind.hpp>
#include <ccd/methods/transform.hpp>
#include <ccd/reference.hpp>
#include <cstddef>

#include "ccd/contact/first_times.hpp"

namespace ccd {
namespace {

/// The query's points as curves of degree 1.
template <class Query>
struct query_curves {
    static constexpr kind query_kind = detail::kind_constant<Query>::value;
    static constexpr std::size_t count =
        kind_traits<query_kind>::first_vertices + kind_traits<query_kind>::second_vertices;
    std::array<std::array<point<double>, 2>, count> ends;
    std::array<curve, count> all;

    explicit query_curves(const Query& query) {
        const auto points = points_of(query);
        for (std::size_t i = 0; i < count; ++i) {
            ends[i] = {points[i].t0, points[i].t1};
            all[i] = ends[i];
        }
    }
    query_curves(const query_curves&) = delete;
    query_curves& operator=(const query_curves&) = delete;
};

template <class Query>
first_time first_within(const Query& query, separation d, double t_max) {
    const query_curves<Query> points(query);
    return detail::first_within_of<points.query_kind>(points.all, d, t_max,
                                                      detail::arithmetic::integers);
}
template <class Query>
verdict decide_distance(const Query& query, separation d) {
    if (d.first == 0 && d.second == 0) return decide_reference(query);
    const outcome found = first_within(query, d, 1).outcome;
    return {found, found == outcome::uncertain ? cause::range : cause::none};
}

}  // namespace

first_time time_of_impact_reference(const vertex_face<double>& q, double t_max) {
    return first_within(q, {}, t_max);
}
first_time time_of_impact_reference(const edge_edge<double>& q, double t_max) {
    return first_within(q, {}, t_max);
}
first_time time_of_impact_reference(const vertex_edge<double>& q, double t_max) {
    return first_within(q, {}, t_max);
}
first_time time_of_impact_reference(const vertex_vertex<double>& q, double t_max) {
    return first_within(q, {}, t_max);
}

verdict decide_within_reference(const vertex_face<double>& q, separation d) {
    return decide_distance(q, d);
}
verdict decide_within_reference(const edge_edge<double>& q, separation d) {
    return decide_distance(q, d);
}
verdict decide_within_reference(const vertex_edge<double>& q, separation d) {
    return decide_distance(q, d);
}
verdict decide_within_reference(const vertex_vertex<double>& q, separation d) {
    return decide_distance(q, d);
}

first_time time_within_reference(const vertex_face<double>& q, separation d, double t_max) {
    return first_within(q, d, t_max);
}
first_time time_within_reference(const edge_edge<double>& q, separation d, double t_max) {
    return first_within(q, d, t_max);
}
first_time time_within_reference(const vertex_edge<double>& q, separation d, double t_max) {
    return first_within(q, d, t_max);
}
first_time time_within_reference(const vertex_vertex<double>& q, separation d, double t_max) {
    return first_within(q, d, t_max);
}

}  // namespace ccd
