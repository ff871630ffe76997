// Expectations of advances: a step to the returned positions reports no pair that the result does
// not list.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <ccd/advance.hpp>
#include <cmath>
#include <cstddef>

#include "tests/ccd/step/brute_force.hpp"

namespace brute_force {

/// Expects that in a step to the result, the only pairs in contact are those that touched at the
/// start. The only pairs within their distance are those that were at the start.
inline void expect_none_but_told(ccd::mesh_steps& steps, const ccd::mesh& before,
                                 const ccd::advance_result& result,
                                 const ccd::pair_distances& distances = {}) {
    const ccd::vertex_rows way(before.vertices, result.positions);
    const auto touching = steps.run(way).pairs;
    const auto near =
        distances.is_contact() ? ccd::pair_lists() : steps.run(way, {.distances = distances}).pairs;
    ccd::for_each_kind([&]<ccd::kind K>() {
        const auto& told = result.touching_at_start.of<K>();
        const auto& told_near = result.near_at_start.of<K>();
        EXPECT_TRUE(std::ranges::includes(told, touching.of<K>())) << name(K);
        EXPECT_TRUE(std::ranges::all_of(near.of<K>(), [&](const auto& pair) {
            return std::ranges::binary_search(told, pair) ||
                   std::ranges::binary_search(told_near, pair);
        })) << name(K);
    });
}

/// Also expects positions to agree with the fractions. Returns the result.
inline ccd::advance_result expect_free(const two_frames& at,
                                       const ccd::advance_options& options = {}) {
    const auto& [before, after] = at;
    const auto result = ccd::advance(before, after, options);
    ccd::mesh_steps steps(before);
    expect_none_but_told(steps, before, result, options.distances);
    for (std::size_t v = 0; v < before.vertices.size(); ++v) {
        const double f = result.fractions[v];
        EXPECT_GE(f, result.fraction);
        const double x = std::lerp(before.vertices[v].x, after.vertices[v].x, f);
        EXPECT_NEAR(result.positions[v].x, x, 0x1p-42 * std::abs(x) + 0x1p-1060);
    }
    return result;
}

/// True if the step is at least 0.99 of the way to the first contact; rounding may prevent this.
inline bool goes_far(const ccd::advance_result& result) {
    const double first =
        result.first_contact.outcome == ccd::outcome::collides ? result.first_contact.low : 1;
    return result.fraction >= 0.99 * first;
}

}  // namespace brute_force
