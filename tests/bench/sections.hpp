// The benchmark's tables. Each function prints its own.
#pragma once

#include <string_view>
#include <vector>

#include "tests/bench/harness.hpp"
#include "tests/bench/scenes.hpp"

namespace bench {

inline constexpr std::string_view section_names[] = {"methods", "stages", "contacts", "steps",
                                                     "growth",  "curves", "bodies"};

struct options {
    bool quick = false;
    std::vector<std::string> sections = {};  ///< of section_names; empty: all

    int repeats() const { return quick ? 3 : 7; }
    /// The number of queries one by one; they are drawn evenly from more.
    std::size_t max_queries() const { return quick ? 10'000 : 200'000; }
    /// Quick runs sample, others take all.
    template <class Query>
    query_set<Query> sampled(const query_set<Query>& all) const {
        return quick ? all.at_most(max_queries()) : all;
    }
};

/// ns per query of every method one by one, and of batches on every instruction set and with all
/// threads. Throws std::runtime_error if batches and one by one disagree.
void methods(const scene& s, const options& o, report& out);

/// The decisions and cost of each stage of `exact`, its slowest single queries, and those that
/// reach the integers.
void stages(const scene& s, const options& o, report& out);

/// First times of colliding queries and the data of their contacts: ns, and certified errors.
void contacts(const scene& s, const options& o, report& out);

/// Whole steps: time by phase, and memory.
void steps(const scene& s, const options& o, report& out);

/// Whole steps of copies of a scene side by side, up to ten million faces: time and memory. Also
/// compares repeated steps of one mesh with first steps.
void growth(const scene& s, const options& o, report& out);

/// First times of contact and of a distance along random curves, by degree.
void curves(const options& o, report& out);

/// Queries of bodies that turn, next to linear ones.
void bodies(const options& o, report& out);

}  // namespace bench
