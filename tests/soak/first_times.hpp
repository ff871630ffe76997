// The parts of the soak that compute first times, and the deciders whose answers they compare.
#pragma once

#include <ccd/contact.hpp>
#include <ccd/kind.hpp>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "tests/ccd/contact/contact_data_faults.hpp"
#include "tests/soak/parts.hpp"

namespace soak {

/// An answer for [0, t_max], and its fault, or "".
struct time_answer {
    double t_max = 1;
    std::string fault = {};
};
/// Returns answers about a query whose first time in [0, 1] is `right`.
template <ccd::kind K>
using time_answers =
    std::function<std::vector<time_answer>(const typename query_list<K>::query&, ccd::separation,
                                           const ccd::first_time& right, double t_max)>;
template <ccd::kind K>
using first_time_of = std::function<ccd::first_time(const typename query_list<K>::query&,
                                                    ccd::separation, double t_max)>;

/// Several threads call it at a time. Contacts have the distance 0.
struct time_decider {
    std::string name;
    ccd::by_kind<time_answers> answers = {};
    ccd::by_kind<first_time_of> when = {};  ///< by_time only
    unsigned stride = 1;                    ///< one query in this many is decided
};
template <class Answers>
time_decider by_answers(std::string name, const Answers& answers) {
    time_decider all{.name = std::move(name)};
    ccd::for_each_kind([&]<ccd::kind K>() { all.answers.of<K>() = answers; });
    return all;
}

/// "", or the found first time in [0, t_max] and the right one.
std::string fault_of(const ccd::first_time& found, const ccd::first_time& right, double t_max);

/// A decider of `when(query, d, t_max)`.
template <class When>
time_decider by_time(std::string name, const When& when) {
    time_decider all =
        by_answers(std::move(name),
                   [when](const auto& q, ccd::separation d, const ccd::first_time& right,
                          double t_max) -> std::vector<time_answer> {
                       return {{1, fault_of(when(q, d, 1), right, 1)},
                               {t_max, fault_of(when(q, d, t_max), right, t_max)}};
                   });
    ccd::for_each_kind([&]<ccd::kind K>() { all.when.of<K>() = when; });
    return all;
}
/// A decider of `whether(query, d)`.
template <class Whether>
time_decider by_outcome(std::string name, const Whether& whether) {
    return by_answers(std::move(name), [whether](const auto& q, ccd::separation d,
                                                 const ccd::first_time& right, double) {
        const ccd::outcome found = whether(q, d);
        return std::vector<time_answer>{
            {1, std::string(found == right.outcome ? "" : ccd::name(found))}};
    });
}
/// A decider of the data of a contact, `what(query, time)`.
template <class What>
time_decider by_data(std::string name, const What& what) {
    return by_answers(std::move(name), [what](const auto& q, ccd::separation,
                                              const ccd::first_time& right, double) {
        if (right.outcome != ccd::outcome::collides) return std::vector<time_answer>();
        const ccd::first_contact found = what(q, right);
        const std::string faults = support::contact_data::check(q, found).faults();
        const bool is_right = faults.empty() && found.time == right;
        return std::vector<time_answer>{{1, is_right ? "" : "what is not so: " + faults}};
    });
}

/// All functions that compute first contacts, or first times within distances. The first accepts
/// all t_max.
std::vector<time_decider> contact_deciders();
std::vector<time_decider> distance_deciders();

/// Queries of every family and all four kinds. The oracle checks the first decider's answer for
/// t_max = 1 (tests/support/first_time_faults.hpp). First times are unique, so all others must
/// agree. For any other t_max, the answer follows from the first time. Rationals check the data of
/// contacts (tests/ccd/contact/contact_data_faults.hpp). Then batches compute
/// the first times of the block's queries with every instruction set. ccd::earliest computes
/// that of the whole block, and of a few queries at a time. Tables: "family", the
/// queries; "distance", the distances; "decider", all answers.
part contact_time_part(std::vector<time_decider> deciders);
/// The same comparison for distances of many families (tests/support/distance_families.hpp).
part distance_time_part(std::vector<time_decider> deciders);

}  // namespace soak
