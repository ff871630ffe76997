// The BSC methods: one template; the bound rule of its scalar determines what it guarantees.
//
//   decide_bsc<none>    `float`: plain arithmetic; may be wrong either way
//   decide_bsc<safe>    `safe`:  BSC with SafeBound; `separate` and `collides` are certain
//   decide_bsc<tight>   `tight`: TightCCD; `separate` and `collides` are certain
//   decide_bsc<sharp>, <interval>, <residual>   the methods with these names: as above
//
// Source: Wang, Tang, Tong, Manocha 2015 (TightCCD), Sections 3 to 5; errbound/bsc.hpp lists the
// differences from the printed branches, with reasons.
#pragma once

#include <ccd/methods/forms.hpp>
#include <ccd/methods/tracked_query.hpp>
#include <ccd/verdict.hpp>
#include <errbound/bsc.hpp>

namespace ccd {

/// True if the signs of Y's coefficients show that the points are never coplanar, as they do for
/// most queries.
template <class Scalar, template <class> class Query>
constexpr bool never_coplanar(const Query<Scalar>& query) {
    return certainly_rootless(normalized(forms_of(query).y()));
}

/// Decides a query over tracked numbers near 1 in size (or 0).
template <class Scalar, template <class> class Query>
constexpr verdict decide_bsc_of(const Query<Scalar>& query) {
    const auto forms = forms_of(query);
    switch (errbound::root_with_nonnegative(forms.y(), [&] { return forms.inside(); })) {
        case errbound::existence::no:
            return {outcome::separate, cause::none};
        case errbound::existence::yes:
            return {outcome::collides, cause::none};
        case errbound::existence::maybe_root:
            return {outcome::uncertain, cause::coplanarity};
        default:
            return {outcome::uncertain, cause::inside};
    }
}

/// Decides a vertex_face or edge_edge query. `separate` and `collides` are certain if signs under
/// Rule are. `collides` means that all weights are strictly positive at some root of Y, so the
/// normal does not vanish there. Cost: at most a few thousand operations, no allocation, never
/// throws. Proof: proofs/bsc/Decisions.v, bsc_face_separate, bsc_face_collides, bsc_edges_separate,
/// bsc_edges_collide; with each rule: proofs/bsc/TrackedBsc.v, tracked_face_separate,
/// tracked_face_collides, tracked_edges_separate, tracked_edges_collide.
template <class Rule, class T, template <class> class Query>
constexpr verdict decide_bsc(const Query<T>& query) {
    const auto [scaled, finite] = tracked_query<Rule>(query);
    if (!finite) return {outcome::uncertain, cause::range};
    return decide_bsc_of(scaled);
}

}  // namespace ccd
