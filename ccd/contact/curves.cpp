// Proof that a first time exists if there is a contact: proofs/Curves.v, face_curves_first,
// edges_curves_first, smooth_continuous.
#include <ccd/curves.hpp>
#include <ccd/kind.hpp>
#include <ccd/methods/transform.hpp>

#include "ccd/contact/first_times.hpp"

namespace ccd {
namespace {

verdict as_verdict(const first_time& found) {
    const bool certain = found.outcome != outcome::uncertain;
    return {found.outcome, certain ? cause::none : cause::range};
}

}  // namespace

template <curve_query Query>
verdict decide_exact(const Query& query) {
    return as_verdict(time_of_impact(query));
}
template <curve_query Query>
first_time time_of_impact(const Query& query, double t_max) {
    return time_within(query, {}, t_max);
}
template <curve_query Query>
verdict decide_within(const Query& query, separation d) {
    return as_verdict(time_within(query, d));
}
template <curve_query Query>
first_time time_within(const Query& query, separation d, double t_max) {
    return detail::first_within_of<kind_of<Query>>(points_of(query), d, t_max,
                                                   detail::arithmetic::floating_point_first);
}

template first_time time_within(const vertex_face_curves&, separation, double);
template first_time time_within(const edge_edge_curves&, separation, double);
template first_time time_within(const vertex_edge_curves&, separation, double);
template first_time time_within(const vertex_vertex_curves&, separation, double);

template verdict decide_within(const vertex_face_curves&, separation);
template verdict decide_within(const edge_edge_curves&, separation);
template verdict decide_within(const vertex_edge_curves&, separation);
template verdict decide_within(const vertex_vertex_curves&, separation);

template first_time time_of_impact(const vertex_face_curves&, double);
template first_time time_of_impact(const edge_edge_curves&, double);
template first_time time_of_impact(const vertex_edge_curves&, double);
template first_time time_of_impact(const vertex_vertex_curves&, double);

template verdict decide_exact(const vertex_face_curves&);
template verdict decide_exact(const edge_edge_curves&);
template verdict decide_exact(const vertex_edge_curves&);
template verdict decide_exact(const vertex_vertex_curves&);

}  // namespace ccd
