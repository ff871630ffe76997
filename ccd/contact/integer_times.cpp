#include "ccd/contact/integer_times.hpp"

#include "ccd/contact/integer_first_contact.hpp"
#include "ccd/exact/integer_decision.hpp"

namespace ccd::detail {

template <any_query Query>
found_time first_contact_in_integers(const Query& query) {
    const integer_units units(query);
    if (units.bits() <= extent_limit(1)) return first_contact_in_words<1>(query, units);
    if (units.bits() <= extent_limit(2)) return first_contact_in_words<2>(query, units);
    return outcome::uncertain;
}

template <cubic_query Query>
found_time root_in_integers(const Query& query, const static_filter::contact_interval& part) {
    if (!part.one_root) return first_contact_in_integers(query);
    const integer_units units(query);
    if (units.bits() <= extent_limit(1)) return root_in_words<1>(query, units, part);
    if (units.bits() <= extent_limit(2)) return root_in_words<2>(query, units, part);
    return outcome::uncertain;
}

template found_time first_contact_in_integers(const vertex_face<double>&);
template found_time first_contact_in_integers(const edge_edge<double>&);
template found_time first_contact_in_integers(const vertex_edge<double>&);
template found_time first_contact_in_integers(const vertex_vertex<double>&);

template found_time root_in_integers(const vertex_face<double>&,
                                     const static_filter::contact_interval&);
template found_time root_in_integers(const edge_edge<double>&,
                                     const static_filter::contact_interval&);

}  // namespace ccd::detail
