// `bsc-exact`: the BSC template over two scalars, and the contacts that settle what it leaves open.
//
// Over intervals BSC says "no" and "yes" only where that is certain (errbound/bsc.hpp). Over
// integers every sign is certain, and then so is nearly every answer of root_with_nonnegative():
//  * Curvature and slopes are known, so that no part is halved, and the cubics whose roots are
//    asked for are strict at both ends (a root there is split off). The reductions then have
//    factors that are not zero, and M and R of the decomposition tell the sign of each G_i at each
//    root: an exact zero where it is one.
//  * So "no" means that at every root of Y some G_i is negative, or that there is no root: no
//    contact. "yes" means a root with all G_i > 0; their sum is |N|² (VF) or twice that (EE), so
//    that N ≠ 0 there: contact.
//  * "maybe_inside" means a root with all G_i >= 0, one of them zero. If N ≠ 0 there, that is a
//    contact at the triangle's border, or at an end of an edge; if N = 0, then so is every contact
//    at that time (reference.cpp). The vertex/edge contacts decide either way. Contacts with all
//    G_i > 0 there are none, or the answer had been "yes".
//    Proof: proofs/BscExact.v, bsc_exact_inside.
//  * "maybe_root" means Y ≡ 0. Take a contact, and follow it back in time to the first at which it
//    holds without a break. If that is not t = 0, then N = 0 or some G_i = 0 there, for else the
//    contact would hold shortly before: a vertex/edge contact again. If it is t = 0, the same, or
//    all G_i(0) > 0. Proof: proofs/BscExact.v, bsc_exact_root; proofs/Contact.v, face_coplanar,
//    edges_coplanar.
// So collides() is right. Proof: proofs/BscExact.v, bsc_exact_face, bsc_exact_edges.
#include <algorithm>
#include <ccd/methods/bsc.hpp>
#include <ccd/methods/bsc_exact.hpp>
#include <errbound/rules/interval.hpp>

#include "ccd/exact/finite.hpp"
#include "ccd/exact/unbounded_integers.hpp"

namespace ccd {
namespace {

template <template <class> class Query>
bool collides(const Query<double>& original) {
    const auto query = detail::to_integers(original);
    const auto forms = forms_of(query);
    switch (errbound::root_with_nonnegative(forms.y(), [&] { return forms.inside(); })) {
        case errbound::existence::no:
            return false;
        case errbound::existence::yes:
            return true;
        case errbound::existence::maybe_root:
            if (std::ranges::all_of(forms.inside(), [](const auto& g) { return g[0] > 0; }))
                return true;
            break;
        case errbound::existence::maybe_inside:
            break;
    }
    return detail::touches_at_border(query, original);
}

template <class Query>
verdict decide_any(const Query& query) {
    if (!detail::is_finite(query)) return {outcome::uncertain, cause::range};
    const verdict filtered = decide_bsc<errbound::interval>(query);
    if (filtered.outcome != outcome::uncertain) return filtered;
    return {collides(query) ? outcome::collides : outcome::separate, cause::none};
}

}  // namespace

verdict decide_bsc_exact(const vertex_face<double>& query) {
    return decide_any(query);
}
verdict decide_bsc_exact(const edge_edge<double>& query) {
    return decide_any(query);
}

}  // namespace ccd
