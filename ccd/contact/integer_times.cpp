// First contacts in integers of fixed width.
//
// The first contact of a face or two edges is the earliest of those at their borders and of those
// inside. Every contact has Y = 0. If Y ≡ 0, contact inside that does not begin at t = 0 begins at
// a border. Proof: proofs/FirstContact.v, face_contact_root, edges_contact_root, face_times,
// edges_times, face_planar_first, edges_planar_first; how brackets are put together,
// proofs/IntegerTimes.v, face_composed_right, edges_composed_right.
#include "ccd/contact/integer_times.hpp"

#include <ccd/methods/forms.hpp>
#include <ccd/methods/transform.hpp>
#include <cstddef>

#include "ccd/contact/interior_time.hpp"
#include "ccd/contact/time_bracket.hpp"
#include "ccd/exact/axis_units.hpp"
#include "ccd/exact/features.hpp"
#include "ccd/exact/integer_decision.hpp"

namespace ccd::detail {
namespace {

template <int Words, template <class> class Query>
found_time first_contact(const Query<errbound::integers::fixed_integer<Words>>& query,
                         const Query<double>& original, const integer_units& units) {
    const auto forms = forms_of(query);
    const auto y = forms.y();
    if (certainly_rootless(y)) return outcome::separate;
    constexpr time_bracket never{2, 2};
    time_bracket first = never;
    const auto edges = vertex_edge_queries(query);
    const auto original_edges = vertex_edge_queries(original);
    for (std::size_t i = 0; i < edges.size(); ++i) {
        if (separated_by_coordinates(original_edges[i])) continue;
        const found_time found = first_vertex_edge_contact(edges[i]);
        if (found.outcome == outcome::uncertain) return found;
        if (found.outcome == outcome::collides && found.time < first) first = found.time;
    }
    const found_time inside = interior_time(forms, y, units, first).find();
    if (inside.outcome != outcome::separate) return inside;
    return first == never ? found_time() : found_time(first);
}
template <int Words>
found_time first_contact(const vertex_edge<errbound::integers::fixed_integer<Words>>& query,
                         const vertex_edge<double>& original, const integer_units&) {
    return separated_by_coordinates(original) ? found_time() : first_vertex_edge_contact(query);
}
template <int Words>
found_time first_contact(const vertex_vertex<errbound::integers::fixed_integer<Words>>& query,
                         const vertex_vertex<double>&, const integer_units&) {
    return first_vertex_vertex_contact(query);
}

/// The root of Y in a part that has one only, which is a contact.
/// Proof: proofs/ContactPart.v, face_part_bracket, edges_part_bracket.
template <int Words, template <class> class Query>
found_time root_in_words(const Query<double>& query, const integer_units& units,
                         const static_filter::contact_part& part) {
    const auto y = forms_of(units.converted<Words>(query)).y();
    const auto before =
        part.y[0] > 0 ? errbound::sign_type::positive : errbound::sign_type::negative;
    const double place = estimated_root({part.y[0], 3 * part.y[1], 3 * part.y[2], part.y[3]});
    return root_search(y).between(part.low, part.high, before,
                                  part.low + place * (part.high - part.low));
}

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
    if (units.bits() <= extent_limit(1))
        return first_contact<1>(units.converted<1>(query), query, units);
    if (units.bits() <= extent_limit(2))
        return first_contact<2>(units.converted<2>(query), query, units);
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
