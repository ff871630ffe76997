// The part of the soak that asks when: first contacts, and first times within a distance, against
// the oracle.
#pragma once

#include <ccd/contact.hpp>
#include <ccd/kind.hpp>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "tests/soak/long_run.hpp"

namespace soak {

template <ccd::kind K>
using first_time_of = std::function<ccd::first_time(
    const typename ccd::kind_traits<K>::template query<double>&, ccd::separation, double t_max)>;
template <ccd::kind K>
using outcome_of = std::function<ccd::outcome(
    const typename ccd::kind_traits<K>::template query<double>&, ccd::separation)>;
template <ccd::kind K>
using contact_of = std::function<ccd::first_contact(
    const typename ccd::kind_traits<K>::template query<double>&, const ccd::first_time&)>;

/// Whoever says when the features first come within a distance, which is 0 where contacts are
/// asked for, or whether they do. Called from several threads at once.
struct time_decider {
    std::string name;
    ccd::by_kind<first_time_of> when = {};
    ccd::by_kind<outcome_of> whether = {};  ///< asked if it is there; else ...
    ccd::by_kind<contact_of> what = {};     ///< ... of contacts alone; else `when`
    unsigned stride = 1;                    ///< it is asked of one query in so many
};

/// A decider of `when(query, d, t_max)`.
template <class When>
time_decider by_time(std::string name, const When& when) {
    time_decider all{.name = std::move(name)};
    ccd::for_each_kind([&]<ccd::kind K>() { all.when.of<K>() = when; });
    return all;
}
/// A decider of `whether(query, d)`.
template <class Whether>
time_decider by_outcome(std::string name, const Whether& whether) {
    time_decider all{.name = std::move(name)};
    ccd::for_each_kind([&]<ccd::kind K>() { all.whether.of<K>() = whether; });
    return all;
}
/// A decider of `what(query, time)`.
template <class What>
time_decider by_data(std::string name, const What& what) {
    time_decider all{.name = std::move(name)};
    ccd::for_each_kind([&]<ccd::kind K>() { all.what.of<K>() = what; });
    return all;
}

/// All ways to ask for first contacts, or for distances; the first answers for all t.
std::vector<time_decider> contact_deciders();
std::vector<time_decider> distance_deciders();

/// Queries of every family and all four kinds. The first decider's answer for t_max = 1 is checked
/// by the oracle (tests/support/first_time_faults.hpp). First times are unique, so it is what all
/// others must say, too, and what follows for another t_max, near that time or not, is what all
/// must say for that. Data of contacts are checked by rationals
/// (tests/support/contact_data_faults.hpp). A block's queries are then asked at once, on every
/// instruction set, and the earliest of all and of a few. Tables: "family", the queries;
/// "distance", of distances; "decider", all answers.
part contact_time_part(std::vector<time_decider> deciders);
/// The same of distances of many families (tests/support/distance_families.hpp).
part distance_time_part(std::vector<time_decider> deciders);

}  // namespace soak
