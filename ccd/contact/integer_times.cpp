// First contacts in integers of fixed width: see ccd/contact/integer_times.hpp for what they
// promise.
#include "ccd/contact/integer_times.hpp"

#include "ccd/contact/integer_first_contact.hpp"
#include "ccd/exact/integer_decision.hpp"

namespace ccd::detail {
namespace {

template <template <class> class Query>
found_time root_of_any(const Query<double>& query, const static_filter::contact_part& part) {
    if (!part.one_root) return first_contact_in_integers(query);
    const integer_units units(query);
    if (units.bits() <= extent_limit(1)) return root_in_words<1>(query, units, part);
    if (units.bits() <= extent_limit(2)) return root_in_words<2>(query, units, part);
    return outcome::uncertain;
}

template <template <class> class Query>
found_time of_any(const Query<double>& query) {
    const integer_units units(query);
    if (units.bits() <= extent_limit(1)) return first_contact_in_words<1>(query, units);
    if (units.bits() <= extent_limit(2)) return first_contact_in_words<2>(query, units);
    return outcome::uncertain;
}

}  // namespace

found_time first_contact_in_integers(const vertex_face<double>& q) {
    return of_any(q);
}
found_time first_contact_in_integers(const edge_edge<double>& q) {
    return of_any(q);
}
found_time first_contact_in_integers(const vertex_edge<double>& q) {
    return of_any(q);
}
found_time first_contact_in_integers(const vertex_vertex<double>& q) {
    return of_any(q);
}

found_time root_in_integers(const vertex_face<double>& q, const static_filter::contact_part& part) {
    return root_of_any(q, part);
}
found_time root_in_integers(const edge_edge<double>& q, const static_filter::contact_part& part) {
    return root_of_any(q, part);
}

}  // namespace ccd::detail
