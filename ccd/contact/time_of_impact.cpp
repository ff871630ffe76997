// First contacts: see include/ccd/contact.hpp for what they promise.
#include <ccd/contact.hpp>
#include <ccd/exact.hpp>
#include <ccd/reference.hpp>
#include <cmath>

namespace ccd {
namespace {

template <class Query>
first_time first_contact(const Query& query, double t_max) {
    // No contact in [0, 1], none in a part of it; without a finite end there is no answer.
    if (std::isfinite(t_max) && decide_exact(query).outcome == outcome::separate)
        return {outcome::separate, 0, 0};
    return time_of_impact_reference(query, t_max);
}

}  // namespace

first_time time_of_impact(const vertex_face<double>& q, double t_max) {
    return first_contact(q, t_max);
}
first_time time_of_impact(const edge_edge<double>& q, double t_max) {
    return first_contact(q, t_max);
}
first_time time_of_impact(const vertex_edge<double>& q, double t_max) {
    return first_contact(q, t_max);
}
first_time time_of_impact(const vertex_vertex<double>& q, double t_max) {
    return first_contact(q, t_max);
}

}  // namespace ccd
