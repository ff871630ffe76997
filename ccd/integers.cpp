// Decisions in integers of fixed width: see ccd/integers.hpp for what they promise.
#include "ccd/integers.hpp"

#include <ccd/forms.hpp>

#include "ccd/features.hpp"
#include "ccd/integer_coordinates.hpp"
#include "ccd/interior_contact.hpp"
#include "ccd/vertex_edge_contact.hpp"

namespace ccd {
namespace {

using errbound::fixed_integer;

/// VF and EE: the union that the head of ccd/reference.cpp states, vertex/edge contacts first.
/// Every contact has Y = 0.
template <int Words, template <class> class Query>
outcome decide(const Query<fixed_integer<Words>>& query, const Query<double>& original) {
    const auto forms = forms_of(query);
    const auto y = forms.y();
    if (certainly_rootless(y)) return outcome::separate;
    const auto edges = vertex_edge_queries(query);
    const auto original_edges = vertex_edge_queries(original);
    for (std::size_t i = 0; i < edges.size(); ++i)
        if (!parted(original_edges[i]) && contact(edges[i])) return outcome::collides;
    return interior_contact<Words>(y, forms.inside());
}
template <int Words>
outcome decide(const vertex_edge<fixed_integer<Words>>& query,
               const vertex_edge<double>& original) {
    return !parted(original) && contact(query) ? outcome::collides : outcome::separate;
}
template <int Words>
outcome decide(const vertex_vertex<fixed_integer<Words>>& query, const vertex_vertex<double>&) {
    return contact(query) ? outcome::collides : outcome::separate;
}

/// The extent that Words words carry through all forms: ccd/vertex_edge_contact.hpp and
/// ccd/interior_contact.hpp say how.
constexpr int extent_limit(int words) {
    return 64 * words - 3;
}

template <template <class> class Query>
verdict decide_any(const Query<double>& query) {
    const integer_units units(query);
    if (!units.finite() || units.bits() > extent_limit(2))
        return {outcome::uncertain, cause::range};
    const outcome found = units.bits() <= extent_limit(1)
                              ? decide<1>(units.converted<1>(query), query)
                              : decide<2>(units.converted<2>(query), query);
    return {found, found == outcome::uncertain ? cause::inside : cause::none};
}

}  // namespace

verdict decide_integers(const vertex_face<double>& q) {
    return decide_any(q);
}
verdict decide_integers(const edge_edge<double>& q) {
    return decide_any(q);
}
verdict decide_integers(const vertex_edge<double>& q) {
    return decide_any(q);
}
verdict decide_integers(const vertex_vertex<double>& q) {
    return decide_any(q);
}

}  // namespace ccd
