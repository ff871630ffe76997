// First contacts, stage by stage: see include/ccd/contact.hpp for what they promise.
#include <ccd/contact.hpp>
#include <ccd/kind.hpp>
#include <ccd/reference.hpp>
#include <cmath>

#include "ccd/contact/integer_times.hpp"
#include "ccd/exact/finite.hpp"
#include "ccd/exact/stages.hpp"

namespace ccd {
namespace {

/// Floating point separates, or finds the part of the first contact, whose time integers then tell.
template <class Query>
detail::found_time found_before_reference(const Query& query) {
    if constexpr (kind_of<Query> == kind::vertex_face || kind_of<Query> == kind::edge_edge) {
        static_filter::contact_part part;
        switch (detail::decide_in_floating_point(query, nullptr, &part,
                                                 static_filter::halvings_for_times)
                    .outcome) {
            case outcome::separate:
                return outcome::separate;
            case outcome::collides:
                return detail::root_in_integers(query, part);
            case outcome::uncertain:
                break;
        }
    }
    return detail::first_contact_in_integers(query);
}

template <class Query>
first_time first_contact(const Query& query, double t_max) {
    if (!std::isfinite(t_max) || !detail::is_finite(query)) return {};
    const detail::found_time found = found_before_reference(query);
    switch (found.outcome) {
        case outcome::separate:
            return {outcome::separate, 0, 0};
        case outcome::collides:
            // A time between two neighbouring doubles is over when the later one is.
            if (found.time.high > t_max) return {outcome::separate, 0, 0};
            return {outcome::collides, found.time.low, found.time.high};
        default:
            return time_of_impact_reference(query, t_max);
    }
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
