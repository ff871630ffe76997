// A narrow phase that keeps a part of each gap, for ipc_toolkit.hpp and the Python package.
#pragma once

#include <algorithm>
#include <ccd/adapters/first_within.hpp>
#include <ccd/adapters/start_distance.hpp>
#include <ccd/contact.hpp>
#include <ccd/verdict.hpp>
#include <cmath>
#include <limits>

namespace ccd::adapters::detail {

/// The gap to keep above min_distance: the fraction 1 - rescaling of the gap at the start, at most
/// `largest`.
struct kept_gap {
    double rescaling = 1;                                      ///< in (0, 1]
    double largest = std::numeric_limits<double>::infinity();  ///< > 0
};

/// A narrow phase's answer; `toi` is infinite if `collides` is false.
struct narrow_answer {
    bool collides;
    double toi;
};

inline narrow_answer narrow_answer_of(outcome found, double time) {
    if (found == outcome::separate) return {false, std::numeric_limits<double>::infinity()};
    return {true, time};
}

template <class Query>
narrow_answer answer_with_gap(const Query& query, const kept_gap& kept, double min_distance,
                              double tmax) {
    const double above = start_distance(query) - min_distance;
    const double gap = (std::min)((1 - kept.rescaling) * above, kept.largest);
    if (gap > 0 && std::isfinite(gap)) {
        const first_time found = first_within(query, {min_distance, gap}, (std::min)(tmax, 1.0));
        if (!found.at_start()) return narrow_answer_of(found.outcome, found.low);
    }
    // The search goes to 1, so that the rescaled time is compared with tmax: the least of many
    // answers must not depend on their order, each with the least before as its tmax.
    const double end = tmax > -std::numeric_limits<double>::infinity() ? 1 : tmax;
    const first_time found = time_within(query, {min_distance}, end);
    const double least = std::numeric_limits<double>::denorm_min();
    const double time = (std::max)(kept.rescaling * found.low, (std::min)(found.low, least));
    const bool late = found.outcome == outcome::collides && time > tmax;
    return narrow_answer_of(late ? outcome::separate : found.outcome, time);
}

/// Finds if, and when first, the features come within min_distance and the kept gap of each other,
/// for t in [0, min(tmax, 1)].
template <class Query>
narrow_answer answer(const Query& query, const kept_gap& kept, double min_distance, double tmax) {
    if (kept.rescaling < 1) return answer_with_gap(query, kept, min_distance, tmax);
    const first_time found = first_within(query, {min_distance}, (std::min)(tmax, 1.0));
    return narrow_answer_of(found.outcome, found.low);
}

}  // namespace ccd::adapters::detail
