#include <ccd/contact.hpp>
#include <ccd/kind.hpp>
#include <ccd/reference.hpp>
#include <cmath>

#include "ccd/contact/integer_times.hpp"
#include "ccd/exact/finite.hpp"
#include "ccd/exact/stages.hpp"

namespace ccd {
namespace {

template <class Query>
detail::found_time found_before_reference(const Query& query) {
    if constexpr (cubic_query<Query>) {
        static_filter::contact_interval part;
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

}  // namespace

template <any_query Query>
first_time time_of_impact(const Query& query, double t_max) {
    if (!std::isfinite(t_max) || !detail::is_finite(query)) return {};
    const detail::found_time found = found_before_reference(query);
    switch (found.outcome) {
        case outcome::separate:
            return {outcome::separate, 0, 0};
        case outcome::collides:
            // A time between two adjacent doubles is at most t_max if the later one is.
            if (found.time.high > t_max) return {outcome::separate, 0, 0};
            return {outcome::collides, found.time.low, found.time.high};
        default:
            return time_of_impact_reference(query, t_max);
    }
}

template first_time time_of_impact(const vertex_face<double>&, double);
template first_time time_of_impact(const edge_edge<double>&, double);
template first_time time_of_impact(const vertex_edge<double>&, double);
template first_time time_of_impact(const vertex_vertex<double>&, double);

}  // namespace ccd
