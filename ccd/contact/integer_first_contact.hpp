// The first contact of a query in integers of a fixed width, for hosts and devices. Internal;
// ccd/contact/integer_times.hpp has its guarantees.
//
// The first contact of a face or two edges is the earliest of those at their borders and of those
// inside. Every contact has Y = 0. If Y ≡ 0, contact inside that does not begin at t = 0 begins at
// a border. Proof: proofs/times/FirstContact.v, face_contact_root, edges_contact_root, face_times,
// edges_times, face_planar_first, edges_planar_first; of the code, proofs/times/InteriorTime.v,
// face_time_right, edges_time_right.
#pragma once

#include <ccd/methods/forms.hpp>
#include <ccd/methods/transform.hpp>
#include <cstddef>
#include <errbound/integers/fixed_integer.hpp>

#include "ccd/contact/interior_time.hpp"
#include "ccd/contact/time_bracket.hpp"
#include "ccd/contact/vertex_edge_time.hpp"
#include "ccd/exact/axis_units.hpp"
#include "ccd/exact/cubic_roots.hpp"
#include "ccd/exact/features.hpp"
#include "ccd/exact/static_filter/subdivision.hpp"

namespace ccd::detail {

template <int Words, effort Effort = effort::whole, template <class> class Query>
constexpr found_time first_contact_converted(
    const Query<errbound::integers::fixed_integer<Words>>& query, const Query<double>& original,
    const integer_units& units) {
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
    const found_time inside =
        interior_time(forms, y, units, first, effort_constant<Effort>()).find();
    if (inside.outcome != outcome::separate) return inside;
    return first == never ? found_time() : found_time(first);
}
template <int Words, effort Effort = effort::whole>
constexpr found_time first_contact_converted(
    const vertex_edge<errbound::integers::fixed_integer<Words>>& query,
    const vertex_edge<double>& original, const integer_units&) {
    return separated_by_coordinates(original) ? found_time() : first_vertex_edge_contact(query);
}
template <int Words, effort Effort = effort::whole>
constexpr found_time first_contact_converted(
    const vertex_vertex<errbound::integers::fixed_integer<Words>>& query,
    const vertex_vertex<double>&, const integer_units&) {
    return first_vertex_vertex_contact(query);
}

/// `uncertain` is rare. Preconditions: units = integer_units(query), with at most
/// extent_limit(Words) bits (ccd/exact/integer_decision.hpp).
template <int Words, effort Effort = effort::whole, template <class> class Query>
constexpr found_time first_contact_in_words(const Query<double>& query,
                                            const integer_units& units) {
    return first_contact_converted<Words, Effort>(units.converted<Words>(query), query, units);
}

/// Same as first_contact_in_words, if floating point has found the interval `part` of the first
/// contact, with exactly one root of Y. Proof: proofs/times/ContactPart.v, face_part_bracket,
/// edges_part_bracket.
template <int Words, template <class> class Query>
constexpr found_time root_in_words(const Query<double>& query, const integer_units& units,
                                   const static_filter::contact_interval& part) {
    const auto y = forms_of(units.converted<Words>(query)).y();
    const auto before =
        part.y[0] > 0 ? errbound::sign_type::positive : errbound::sign_type::negative;
    const double place = estimated_root({part.y[0], 3 * part.y[1], 3 * part.y[2], part.y[3]});
    return root_search(y).between(part.low, part.high, before,
                                  part.low + place * (part.high - part.low));
}

}  // namespace ccd::detail
