// BSC over intervals, then over integers. Contacts of vertices and edges decide the queries that
// remain. Derivation: docs/other-methods.md, "bsc-exact". Proof: proofs/bsc/BscExact.v,
// bsc_exact_face, bsc_exact_edges.
#include <algorithm>
#include <ccd/methods/bsc.hpp>
#include <ccd/methods/bsc_exact.hpp>
#include <errbound/rules/interval.hpp>

#include "ccd/exact/finite.hpp"
#include "ccd/exact/unbounded_integers.hpp"

namespace ccd {
namespace {

/// Proof: proofs/bsc/BscExact.v, bsc_exact_inside, bsc_exact_root; proofs/contact/Contact.v,
/// face_coplanar, edges_coplanar.
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

}  // namespace

template <cubic_query Query>
verdict decide_bsc_exact(const Query& query) {
    if (!detail::is_finite(query)) return {outcome::uncertain, cause::range};
    const verdict filtered = decide_bsc<errbound::interval>(query);
    if (filtered.outcome != outcome::uncertain) return filtered;
    return {collides(query) ? outcome::collides : outcome::separate, cause::none};
}

template verdict decide_bsc_exact(const vertex_face<double>&);
template verdict decide_bsc_exact(const edge_edge<double>&);

}  // namespace ccd
