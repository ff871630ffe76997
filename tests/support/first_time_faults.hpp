// Checks first times by the oracle. A bracket is right if two yes/no questions have the right
// answers; no number except its ends is used.
#pragma once

#include <algorithm>
#include <ccd/contact.hpp>
#include <cmath>
#include <string>

#include "tests/support/oracle.hpp"

namespace support {

/// Returns the fault of `claimed` as the first time in [0, t_max] at which a property holds, or "".
/// `holds(interval)` is true if it holds at a time in the interval. Times of contact and of
/// closeness are closed intervals. So the first time is at most `high` if and only if the property
/// holds in an interval that ends there.
template <class Holds>
std::string fault_of(const ccd::first_time& claimed, double t_max, const Holds& holds) {
    const double last = std::min(t_max, 1.0), low = claimed.low, high = claimed.high;
    if (claimed.outcome == ccd::outcome::uncertain) return "it is uncertain";
    if (claimed.outcome == ccd::outcome::separate)
        return last >= 0 && holds(oracle::interval{0, last}) ? "there is one" : "";
    if (!(0 <= low && low <= high && high <= last)) return "it is outside [0, t_max]";
    if (low == high) {
        if (!holds(oracle::interval::instant(low))) return "it does not hold at that instant";
        return holds(oracle::interval{.high = low, .with_high = false}) ? "it holds before" : "";
    }
    if (std::nextafter(low, 1) != high) return "the ends are not adjacent";
    if (holds(oracle::interval{0, low})) return "it holds at low or before";
    return holds(oracle::interval{low, high, false, false}) ? "" : "it does not hold between";
}

/// Checks a result of time_of_impact.
template <class Query>
std::string fault_of(const Query& query, const ccd::first_time& claimed, double t_max = 1) {
    return fault_of(claimed, t_max, [&](const oracle::interval& when) {
        return oracle::collides(query, oracle::shortcuts::on, when);
    });
}

/// Checks a result of time_within.
template <class Query>
std::string fault_of(const Query& query, ccd::separation d, const ccd::first_time& claimed,
                     double t_max = 1) {
    return fault_of(claimed, t_max, [&](const oracle::interval& when) {
        return oracle::within(query, d.first, d.second, oracle::shortcuts::on, when);
    });
}

}  // namespace support
