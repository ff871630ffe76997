// Steps must report what brute force does.
#pragma once

#include <gtest/gtest.h>

#include "tests/ccd/step/brute_force.hpp"

namespace brute_force {

/// The same pairs, of the same candidates if they were counted.
inline void expect_same(const ccd::step_result& found, const ccd::step_result& expected) {
    if (found.candidates) {
        EXPECT_EQ(found.candidates, expected.candidates);
    }
    EXPECT_EQ(found.pairs, expected.pairs);
}

/// Steps on one thread and more against every pair looked at.
inline void expect_as_by_brute_force(const two_frames& at, ccd::method method) {
    const auto expected = step(at, by_method{method});
    for (const int threads : {1, 2, 3})
        for (const bool counted : {false, true}) {
            const ccd::step_options options{
                .method = method, .threads = threads, .count_candidates = counted};
            const auto found = ccd::step(at.first, at.second, options);
            EXPECT_EQ(found.candidates.has_value(), counted);
            expect_same(found, expected);
        }
}

}  // namespace brute_force
