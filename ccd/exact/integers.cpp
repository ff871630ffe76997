#include "ccd/exact/integers.hpp"

#include "ccd/exact/axis_units.hpp"
#include "ccd/exact/close_contact.hpp"
#include "ccd/exact/features.hpp"
#include "ccd/exact/integer_decision.hpp"

namespace ccd::detail {
namespace {

/// Proof: proofs/contact/CloseContact.v, face_to_the_end_right, edges_to_the_end_right.
template <int Words, class Query>
outcome decide_to_the_end(const Query& query, const integer_units& units) {
    const outcome found = decide_in_words<Words>(query, units);
    if constexpr (requires { forms_of(query); })
        if (found == outcome::uncertain)
            return decide_close<Words>(forms_of(units.converted<Words>(query)));
    return found;
}

}  // namespace

template <any_query Query>
verdict decide_in_integers(const Query& query) {
    const integer_units units(query);
    if (!units.finite()) return {outcome::uncertain, cause::range};
    if (units.bits() > extent_limit(4)) {
        // Comparisons of coordinates are exact at every scale.
        if (separated_by_coordinates(query)) return {outcome::separate, cause::none};
        return {outcome::uncertain, cause::range};
    }
    const outcome found = units.bits() <= extent_limit(1)   ? decide_to_the_end<1>(query, units)
                          : units.bits() <= extent_limit(2) ? decide_to_the_end<2>(query, units)
                                                            : decide_to_the_end<4>(query, units);
    return {found, found == outcome::uncertain ? cause::inside : cause::none};
}

template verdict decide_in_integers(const vertex_face<double>&);
template verdict decide_in_integers(const edge_edge<double>&);
template verdict decide_in_integers(const vertex_edge<double>&);
template verdict decide_in_integers(const vertex_vertex<double>&);

}  // namespace ccd::detail
