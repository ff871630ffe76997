// Conditions on times, and the first time in [0, 1] at which one of them holds. Internal.
//
// A question is a list of conditions, asked by polynomials in t. The set of times at which one of
// them holds must be closed, as that of contacts and that of distances <= d are; the set of a
// single one need not be (where the normal vanishes, a face's own condition does not hold). So
// there is a first time t*, if any. Let t* > 0, and let a condition hold there:
//  * If its `vanishing` are not all identically zero, t* is a root of their common factor.
//  * If they are, t* is a root of some `nonnegative`: what is not zero at t* is not zero near it,
//    so just before t*, where the condition does not hold, some `nonnegative` was negative.
//  * With `also_below` it holds where Z, its only `vanishing`, is <= 0. Where this first holds, Z
//    is 0: the distance is continuous in t, and the condition says that it is <= d (contact.md's
//    table, section 2); Z < 0 is distance < d, which began earlier. Proof: proofs/Separation.v,
//    vertices_first_within, vertex_edge_first_within, face_first_within, edges_first_within.
// A condition without `vanishing` is one that another condition covers where it begins to hold
// after t = 0, so it is asked at 0 only.
//
// Proof: proofs/FirstConditions.v, first_is_candidate, candidate_holds.
#pragma once

#include <ccd/methods/forms.hpp>
#include <ccd/verdict.hpp>
#include <errbound/tracked.hpp>
#include <functional>
#include <vector>

#include "ccd/contact/time_polynomial.hpp"

namespace ccd::detail {

/// A point, or a difference of points, in motion: coordinates in a ring R of polynomials in t.
template <class R>
using path = vector_form<R, 0>;

/// What is asked where a condition's polynomials vanish.
template <class R>
struct side_conditions {
    std::vector<R> nonnegative, not_all_zero;
};

/// Holds where all of `vanishing` are 0, none of `nonnegative` is negative, and not all of
/// `not_all_zero` are 0, if there are any. The latter two are made when asked for.
template <class R>
struct condition {
    std::vector<R> vanishing;
    std::function<side_conditions<R>()> sides;
    /// It also holds where its only vanishing one is negative.
    bool also_below = false;
};
using exact_conditions = std::vector<condition<time_polynomial>>;

/// The first time in [0, min(t_max, 1)]; t_max >= 0.
/// Proof: proofs/CandidateTimes.v, first_time_of_right, code_comparison.
first_time first_time_of(const exact_conditions& conditions, double t_max);

/// What is asked at a root of y: in floating point, at the root within bounds (not asked if
/// empty), and the conditions, made where that leaves it open.
struct root_questions {
    std::function<outcome(const errbound::tracked<double>&)> holds_at;
    std::function<exact_conditions()> conditions;
};
/// The same where all conditions hold at roots of y alone, which is not identically zero.
first_time first_time_at_roots(const time_polynomial& y, const root_questions& asked, double t_max);

}  // namespace ccd::detail
