// Conditions on times, and the first time in [0, 1] at which one of them holds. Internal.
//
// The times at which some condition of a list holds must be a closed set, like the times of contact
// and those of distances <= d. (The set of one condition need not be closed.) So there is a first
// time t*, if any. If t* > 0, let a condition hold there:
//  * If its `vanishing` are not all identically zero, t* is a root of their common factor.
//  * Otherwise t* is a root of some `nonnegative`: polynomials that are not zero at t* keep their
//    sign near it, and just before t* some `nonnegative` was negative.
//  * The case of `also_below` is argued there.
// A condition without `vanishing` is tested at t = 0 only: if it begins to hold later, another
// condition holds too. Proof: proofs/times/FirstConditions.v, first_is_candidate, candidate_holds.
#pragma once

#include <ccd/execution.hpp>
#include <ccd/methods/forms.hpp>
#include <ccd/verdict.hpp>
#include <errbound/tracked.hpp>
#include <functional>
#include <vector>

#include "ccd/contact/time_polynomial.hpp"

namespace ccd::detail {

/// The motion of a point or difference, over a ring R of polynomials in t.
template <class R>
using path = vector_form<R, 0>;

template <class R>
struct side_conditions {
    std::vector<R> nonnegative, not_all_zero;
};

/// Holds if all of `vanishing` are 0, none of `nonnegative` is negative, and some `not_all_zero`,
/// if there are any, is not 0. `sides` computes `nonnegative` and `not_all_zero` on demand.
template <class R>
struct condition {
    std::vector<R> vanishing;
    std::function<side_conditions<R>()> sides;
    /// True if the condition also holds where Z, its only `vanishing`, is negative: Z <= 0 means
    /// distance <= d. The distance is continuous in t, so Z = 0 where it first holds. Proof:
    /// proofs/times/Separation.v, vertices_first_within, vertex_edge_first_within,
    /// face_first_within, edges_first_within.
    bool also_below = false;
};
using exact_conditions = std::vector<condition<time_polynomial>>;

/// The first time in [0, min(t_max, 1)] at which a condition holds. Precondition: t_max >= 0.
/// Polls `stop` during the search, as the functions below. Proof: proofs/times/CandidateTimes.v,
/// first_time_of_right, code_comparison.
first_time first_time_of(const exact_conditions& conditions, double t_max, const stop_query& stop);

/// `holds_at`, if not empty, decides in floating point from an enclosure of a root of y; if it is
/// uncertain, the `conditions` decide.
struct root_test {
    std::function<outcome(const errbound::tracked<double>&)> holds_at;
    std::function<exact_conditions()> conditions;
};
/// Same as first_time_of, for conditions that hold at roots of y only. Precondition: y is not
/// identically zero.
first_time first_time_at_roots(const time_polynomial& y, const root_test& test, double t_max,
                               const stop_query& stop);
/// The first root of y in [low, high]. Precondition: there is one.
first_time first_root_time(const time_polynomial& y, double low, double high,
                           const stop_query& stop);

}  // namespace ccd::detail
