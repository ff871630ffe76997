#include <ccd/reference.hpp>

#include "ccd/contact/first_times.hpp"

namespace ccd {

template <any_query Query>
first_time time_within_reference(const Query& query, separation d, double t_max) {
    return detail::first_within_of(query, d, t_max, detail::arithmetic::integers);
}
template <any_query Query>
first_time time_of_impact_reference(const Query& query, double t_max) {
    return time_within_reference(query, {}, t_max);
}
template <any_query Query>
verdict decide_within_reference(const Query& query, separation d) {
    if (d.first == 0 && d.second == 0) return decide_reference(query);
    const outcome found = time_within_reference(query, d).outcome;
    return {found, found == outcome::uncertain ? cause::range : cause::none};
}

template first_time time_within_reference(const vertex_face<double>&, separation, double);
template first_time time_within_reference(const edge_edge<double>&, separation, double);
template first_time time_within_reference(const vertex_edge<double>&, separation, double);
template first_time time_within_reference(const vertex_vertex<double>&, separation, double);

template first_time time_of_impact_reference(const vertex_face<double>&, double);
template first_time time_of_impact_reference(const edge_edge<double>&, double);
template first_time time_of_impact_reference(const vertex_edge<double>&, double);
template first_time time_of_impact_reference(const vertex_vertex<double>&, double);

template verdict decide_within_reference(const vertex_face<double>&, separation);
template verdict decide_within_reference(const edge_edge<double>&, separation);
template verdict decide_within_reference(const vertex_edge<double>&, separation);
template verdict decide_within_reference(const vertex_vertex<double>&, separation);

}  // namespace ccd
