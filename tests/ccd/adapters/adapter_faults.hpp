// Answers of adapters: two queries made by hand, and checks by the oracle, without brackets of the
// library.
#pragma once

#include <algorithm>
#include <ccd/contact.hpp>
#include <ccd/kind.hpp>
#include <ccd/methods/transform.hpp>
#include <cmath>
#include <limits>
#include <ostream>
#include <string>

#include "tests/ccd/contact/by_hand.hpp"
#include "tests/support/distance_families.hpp"
#include "tests/support/oracle.hpp"
#include "tests/support/query_families.hpp"

namespace support {

using by_hand::infinity, by_hand::still;

template <class T>
struct answer {
    bool collides;
    T toi;
    friend bool operator==(const answer&, const answer&) = default;
    friend std::ostream& operator<<(std::ostream& out, const answer& a) {
        return out << (a.collides ? "true, " : "false, ") << a.toi;
    }
};
inline constexpr answer<double> never{false, infinity};
inline answer<double> at(double t) {
    return {true, t};
}

// The vertex moves from 1 above a face to 3 below; one edge crosses another in the same way.
inline const ccd::vertex_face<double> onto_face{
    {{0.25, 0.25, 1}, {0.25, 0.25, -3}}, still({0, 0, 0}), still({1, 0, 0}), still({0, 1, 0})};
inline const ccd::edge_edge<double> across{
    {{0, -1, 1}, {0, -1, -3}}, {{0, 1, 1}, {0, 1, -3}}, still({-1, 0, 0}), still({1, 0, 0})};

/// A useful distance for tests of the query: 0, or about its distance at some time.
template <class Query>
double some_distance(query_families::source& random, const Query& query) {
    query_families::points p{};
    std::ranges::copy(ccd::points_of(query), p.begin());
    const auto d = distance_families::draw(random).make(random, ccd::kind_of<Query>, p);
    return std::max(d.first, d.second);
}

/// Returns the fault of an answer and its time, of type T, or "". The right answer is true if
/// `holds(interval)` is true at a time in [0, t_max]. The time must be no later than the first such
/// time, and the next T must not be before it.
template <class T, class Holds>
std::string answer_fault(bool answer, T toi, double t_max, const Holds& holds) {
    const double last = std::min(t_max, 1.0);
    if (!answer) {
        if (toi != std::numeric_limits<T>::infinity()) return "a time without a contact";
        return holds(oracle::interval{0, last}) ? "missed" : "";
    }
    if (!(0 <= toi && toi <= last)) return "the time is outside [0, t_max]";
    if (toi > 0 && holds(oracle::interval{.high = toi, .with_high = false})) return "late";
    const double next = std::nextafter(toi, T(2));
    return holds(oracle::interval{toi, std::min(next, last)}) ? "" : "early, or no contact at all";
}

/// Checks a query's answer for contact, or for a distance of at most d.
template <class T, class Query>
std::string answer_fault(const Query& query, ccd::separation d, bool answer, T toi, double t_max) {
    return answer_fault(answer, toi, t_max, [&](const oracle::interval& when) {
        return d.first == 0 && d.second == 0
                   ? oracle::collides(query, oracle::shortcuts::on, when)
                   : oracle::within(query, d.first, d.second, oracle::shortcuts::on, when);
    });
}

}  // namespace support
