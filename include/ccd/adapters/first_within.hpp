// time_within (ccd/contact.hpp) for callers that pass the least time found so far as t_max: most
// pairs stay apart until then, and proving that is cheaper than computing their times.
#pragma once

#include <algorithm>
#include <ccd/contact.hpp>
#include <ccd/methods/transform.hpp>
#include <ccd/query.hpp>
#include <ccd/verdict.hpp>
#include <cmath>
#include <limits>

namespace ccd::adapters::detail {

/// True if the features certainly stay more than d apart in [0, t_max], for 0 <= t_max <= 1.
///
/// Tests the motion to the rounded positions at t_max. With coordinates of at most M and u = 2^-53,
/// the rounded x0 + t_max·(x1 - x0) has an error of at most 6u·M + 2^-1074, fused or not. It rounds
/// a difference of at most 2M, its product, and a sum of at most M. Points at earlier times have a
/// fraction of that error, and distances less than 2·sqrt(3) times that. So twice 2^-48·M + 2^-1072
/// is added to d. Values that overflow are not finite, and then nothing is certain.
template <class Query>
bool stays_apart(const Query& query, separation d, double t_max) {
    double largest = 0;
    const auto then = [&](double t0, double t1) {
        largest = (std::max)({largest, std::abs(t0), std::abs(t1)});
        return t0 + t_max * (t1 - t0);
    };
    const Query cut_short = transformed_motions(query, [&](const moving_point<double>& p) {
        return moving_point<double>{
            p.t0, {then(p.t0.x, p.t1.x), then(p.t0.y, p.t1.y), then(p.t0.z, p.t1.z)}};
    });
    const double more = d.second + (0x1p-47 * largest + 0x1p-1071);
    d.second = std::nextafter(more, std::numeric_limits<double>::infinity());
    return decide_within(cut_short, d).outcome == outcome::separate;
}

template <class Query>
first_time first_within(const Query& query, separation d, double t_max) {
    const bool is_distance = d.first > 0 || d.second > 0;
    if (is_distance && 0 <= t_max && t_max < 1 && stays_apart(query, d, t_max))
        return {outcome::separate, 0, 0};
    return time_within(query, d, t_max);
}

}  // namespace ccd::adapters::detail
