// Decides a query in integers of a fixed width, on hosts and devices. Internal;
// ccd/exact/integers.hpp has its guarantees.
#pragma once

#include <ccd/methods/forms.hpp>
#include <ccd/verdict.hpp>
#include <cstddef>
#include <errbound/integers/fixed_integer.hpp>

#include "ccd/exact/axis_units.hpp"
#include "ccd/exact/features.hpp"
#include "ccd/exact/interior_contact.hpp"
#include "ccd/exact/vertex_edge_contact.hpp"

namespace ccd::detail {

/// The largest integer_units::bits for which all forms fit in Words words (widths:
/// ccd/exact/vertex_edge_contact.hpp, ccd/exact/interior_contact.hpp). Proof, for 1, 2 and 4 words:
/// proofs/integers/FixedWidths.v, vertex_edge_widths, vertex_vertex_widths, interior_widths,
/// halving_widths, bracket_widths, cut_widths.
constexpr int extent_limit(int words) {
    return 64 * words - 3;
}

/// Decides by the union in the head of ccd/exact/reference.cpp, vertex/edge contacts first. Every
/// contact has Y = 0. Proof: proofs/contact/InteriorContact.v, face_decision_right,
/// edges_decision_right.
template <int Words, effort Effort = effort::whole, template <class> class Query>
constexpr outcome decide_converted(const Query<errbound::integers::fixed_integer<Words>>& query,
                                   const Query<double>& original, const integer_units& units) {
    const auto forms = forms_of(query);
    const auto y = forms.y();
    if (certainly_rootless(y)) return outcome::separate;
    const auto edges = vertex_edge_queries(query);
    const auto original_edges = vertex_edge_queries(original);
    for (std::size_t i = 0; i < edges.size(); ++i)
        if (!separated_by_coordinates(original_edges[i]) && vertex_touches_edge(edges[i]))
            return outcome::collides;
    return interior_contact(forms, y, units, effort_constant<Effort>()).decide();
}
/// Proof: proofs/contact/InteriorContact.v, vertex_edge_decision_right.
template <int Words, effort Effort = effort::whole>
constexpr outcome decide_converted(
    const vertex_edge<errbound::integers::fixed_integer<Words>>& query,
    const vertex_edge<double>& original, const integer_units&) {
    return !separated_by_coordinates(original) && vertex_touches_edge(query) ? outcome::collides
                                                                             : outcome::separate;
}
template <int Words, effort Effort = effort::whole>
constexpr outcome decide_converted(
    const vertex_vertex<errbound::integers::fixed_integer<Words>>& query,
    const vertex_vertex<double>&, const integer_units&) {
    return vertices_touch(query) ? outcome::collides : outcome::separate;
}

/// `uncertain` is rare. Preconditions: units = integer_units(query), with at most
/// extent_limit(Words) bits.
template <int Words, effort Effort = effort::whole, template <class> class Query>
constexpr outcome decide_in_words(const Query<double>& query, const integer_units& units) {
    return decide_converted<Words, Effort>(units.converted<Words>(query), query, units);
}

}  // namespace ccd::detail
