// Expectations of steps: their results equal those of brute force.
#pragma once

#include <gtest/gtest.h>

#include "tests/ccd/step/brute_force.hpp"

namespace brute_force {

inline void expect_same(const ccd::step_result& found, const ccd::step_result& expected) {
    EXPECT_EQ(found.candidates, expected.candidates);
    EXPECT_EQ(found.pairs, expected.pairs);
}

/// Compares pairs and times.
template <class Found>
void expect_same_results(const Found& found, const ccd::step_result& expected) {
    EXPECT_EQ(found.pairs, expected.pairs);
    EXPECT_EQ(found.times, expected.times);
    EXPECT_EQ(found.touching_at_start, expected.touching_at_start);
    EXPECT_EQ(found.first_contact, expected.first_contact);
}

/// Expects the result of `run(options)` with and without counted candidates.
template <class Run>
void expect_both_ways(const ccd::step_result& expected, ccd::step_options options, const Run& run) {
    options.count_candidates = true;
    expect_same(run(options), expected);
    options.count_candidates = false;
    const ccd::step_result found = run(options);
    EXPECT_FALSE(found.candidates.has_value());
    EXPECT_EQ(found.pairs, expected.pairs);
}

/// Compares steps with one to three threads with a test of every pair.
inline void expect_as_by_brute_force(const two_frames& at, ccd::method method) {
    const auto expected = step(at, by_method{method});
    for (const int threads : {1, 2, 3})
        expect_both_ways(
            expected, {.method = method, .threads = threads},
            [&](const auto& options) { return ccd::step(at.first, at.second, options); });
}

}  // namespace brute_force
