// The reference decisions. A query collides if and only if one of these holds (algebra in
// brackets):
//  * VF, EE: Y = 0, N ≠ 0 and all G_i >= 0 at some t in [0, 1]    [roots of the cubic Y]
//  * one of three (VF) or four (EE) vertex/edge contacts
//  * VE: W × E = 0 and W·(W − E) <= 0 at some t [roots of a common factor], with W = v − e0,
//    E = e1 − e0.
//
// A contact with N ≠ 0 satisfies the first. If N = 0, the triangle is a segment that its edges
// cover, or the two edges are parallel and one has an end on the other. If Y ≡ 0, the first case is
// tested at t = 0 and 1 only, since a later contact inside begins at an edge or an end. Proof:
// proofs/contact/Contact.v, vertex_face_union, edge_edge_union, vertex_edge_contact, face_coplanar,
// edges_coplanar; of the code, proofs/contact/Reference.v, reference_face, reference_edges,
// reference_vertex_edge, reference_vertex_vertex.
#include <ccd/methods/forms.hpp>
#include <ccd/reference.hpp>
#include <cstddef>
#include <errbound/roots/real_roots.hpp>

#include "ccd/exact/features.hpp"
#include "ccd/exact/finite.hpp"
#include "ccd/exact/unbounded_integers.hpp"

namespace ccd {
namespace detail {
namespace {

using errbound::sign_type;
using form = errbound::roots::integer_form<integer>;

template <template <class> class Query>
bool regular_contact(const Query<integer>& query) {
    const auto forms = forms_of(query);
    const auto y = forms.y();
    if (errbound::certainly_rootless(y)) return false;
    const auto g = forms.inside();
    for (const auto& f : g)
        if (errbound::sign_throughout(f) == sign_type::negative) return false;
    const auto n2 = forms.normal_squared();

    const auto contact_at = [&](const auto& sign_there) {
        if (sign_there(n2) == sign_type::zero) return false;
        for (const auto& f : g)
            if (sign_there(f) == sign_type::negative) return false;
        return true;
    };
    const auto at_start = [](const auto& f) { return errbound::sign_of(f.h.front()); };
    const auto at_end = [](const auto& f) { return errbound::sign_of(f.h.back()); };
    if (y.h.front() == 0 && contact_at(at_start)) return true;
    if (y.h.back() == 0 && contact_at(at_end)) return true;

    const form inner = errbound::roots::without_end_roots(y);
    if (inner.size() < 2) return false;
    errbound::real_roots<integer> roots(inner);
    for (std::size_t k = 0; k < roots.size(); ++k) {
        const auto at_root = [&roots, k](const auto& f) {
            return roots.sign_at_root(errbound::roots::without_end_roots(f), k);
        };
        if (contact_at(at_root)) return true;
    }
    return false;
}

template <template <class> class Query>
bool touches(const Query<integer>& query, const Query<double>& original) {
    return regular_contact(query) || touches_at_border(query, original);
}
bool touches(const vertex_edge<integer>& query, const vertex_edge<double>& original) {
    return !separated_by_coordinates(original) && vertex_touches_edge(query);
}
bool touches(const vertex_vertex<integer>& query, const vertex_vertex<double>&) {
    return vertices_touch(query);
}

}  // namespace
}  // namespace detail

template <any_query Query>
verdict decide_reference(const Query& query) {
    if (!detail::is_finite(query)) return {outcome::uncertain, cause::range};
    const bool touches = detail::touches(detail::to_integers(query), query);
    return {touches ? outcome::collides : outcome::separate, cause::none};
}

template verdict decide_reference(const vertex_face<double>&);
template verdict decide_reference(const edge_edge<double>&);
template verdict decide_reference(const vertex_edge<double>&);
template verdict decide_reference(const vertex_vertex<double>&);

}  // namespace ccd
