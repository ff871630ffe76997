// First times in unbounded integers: see include/ccd/reference.hpp for what they promise.
#include <ccd/reference.hpp>

#include "ccd/contact/first_times.hpp"

namespace ccd {
namespace {

template <class Query>
first_time first_within(const Query& query, separation d, double t_max) {
    return detail::first_within_of(query, d, t_max, detail::arithmetic::integers);
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
