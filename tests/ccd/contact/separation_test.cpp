// Distances made by hand by decide_within, time_within and the reference. The soak of separations
// has queries of all families and distances of all degenerate kinds, compared with an oracle.
#include <gtest/gtest.h>

#include <ccd/contact.hpp>
#include <ccd/reference.hpp>
#include <cmath>
#include <limits>

#include "tests/ccd/contact/by_hand.hpp"

namespace {

using ccd::first_time;
using ccd::outcome;
using ccd::separation;
using namespace by_hand;

/// The first time by both functions. They must agree, and so must the decision.
template <class Query>
first_time within(const Query& query, separation d, double t_max = 1) {
    const first_time found = ccd::time_within(query, d, t_max);
    EXPECT_EQ(found, ccd::time_within_reference(query, d, t_max));
    EXPECT_EQ(ccd::decide_within(query, d), ccd::decide_within_reference(query, d));
    if (t_max >= 1 && std::isfinite(t_max)) {
        EXPECT_EQ(ccd::decide_within(query, d).outcome, found.outcome);
    }
    return found;
}

TEST(separation, above_a_face) {
    const auto query = over_triangle({0.25, 0.25, 1}, {0.25, 0.25, 0.5});
    EXPECT_EQ(within(query, {0.75}), at(0.5));
    EXPECT_EQ(within(query, {0.5, 0.25}), at(0.5));
    EXPECT_EQ(within(query, {0.5}), at(1));
    EXPECT_EQ(within(query, {std::nextafter(0.5, 0)}), never);
    EXPECT_EQ(within(query, {1}), at(0));
    EXPECT_EQ(within(query, {4}), at(0));
    EXPECT_EQ(within(query, {0.75}, 0.5), at(0.5));
    EXPECT_EQ(within(query, {0.75}, 0.25), never);
    EXPECT_EQ(within(query, {0.75}, -1), never);
}
TEST(separation, of_no_distance_is_contact) {
    EXPECT_EQ(within(over_triangle({0.25, 0.25, 1}, {0.25, 0.25, -1}), {0}), at(0.5));
    EXPECT_EQ(within(over_triangle({0.25, 0.25, 1}, {0.25, 0.25, least}), {0, 0}), never);
}
TEST(separation, of_two_parts_is_their_exact_sum) {
    // 1 + 2^-60 is not a double. At the end, the distance is 1 + 2^-60 on one axis and less on
    // another.
    const vertex_vertex query{from_to({3, 0, 0}, {1, 0, 0}), from_to({0, 0, 0}, {-0x1p-60, 0, 0})};
    EXPECT_EQ(within(query, {1, 0x1p-60}), at(1));
    EXPECT_EQ(within(query, {1, std::nextafter(0x1p-60, 0)}), never);
    EXPECT_EQ(within(query, {1, 0x1p-61}), never);
}
TEST(separation, that_is_no_distance_is_uncertain) {
    const auto query = over_triangle({2, 2, 2}, {3, 3, 3});
    EXPECT_EQ(within(query, {-1}), first_time{});
    EXPECT_EQ(within(query, {2, -1}), first_time{});
    EXPECT_EQ(within(query, {infinity}), first_time{});
    EXPECT_EQ(within(query, {0, std::nan("")}), first_time{});
    EXPECT_EQ(within(over_triangle({2, 2, infinity}, {3, 3, 3}), {1}), first_time{});
    EXPECT_EQ(within(query, {0.5}, infinity), first_time{});
    EXPECT_EQ(ccd::decide_within(query, {-1}).cause, ccd::cause::range);
}

TEST(separation, beside_a_face_is_from_its_edge) {
    // Moves along y = 1/4, z = 0 from x = −2: within 1/2 of the edge x = 0 at x = −1/2.
    EXPECT_EQ(within(over_triangle({-2, 0.25, 0}, {0, 0.25, 0}), {0.5}), at(0.75));
    // At a height of 3, within 5 at x = −4.
    EXPECT_EQ(within(over_triangle({-8, 0.25, 3}, {0, 0.25, 3}), {5}), at(0.5));
}
TEST(separation, beside_a_face_is_from_its_corner) {
    // Reaches (−3, −4, 0), which is 5 from the corner, at t = 1/2.
    EXPECT_EQ(within(over_triangle({-6, -8, 0}, {0, 0, 0}), {5}), at(0.5));
    // A box of 4 on each axis contains (−3, −3, 0), which is 3√2 from the corner.
    EXPECT_EQ(within(over_triangle({-3, -3, 0}, {-3, -3, 0}), {4}), never);
}
TEST(separation, sliding_at_exactly_that_height) {
    // N·P = d|N| throughout: the distance is d from the time at which v is above the edge x = 0.
    EXPECT_EQ(within(over_triangle({-1, 0.25, 2}, {1, 0.25, 2}), {2}), at(0.5));
    EXPECT_EQ(within(over_triangle({-1, 0.25, 2}, {1, 0.25, 2}), {std::nextafter(2.0, 0)}), never);
    // Along an edge's line |E × W| = d|E| throughout; the distance is d once v is next to the
    // edge's end.
    const vertex_edge beside{from_to({-1, 2, 0}, {1, 2, 0}), still({0, 0, 0}), still({4, 0, 0})};
    EXPECT_EQ(within(beside, {2}), at(0.5));
    // The distance of the vertices is constant, so it is reached at the start.
    const vertex_vertex kept{from_to({0, 0, 2}, {5, 5, 7}), from_to({0, 0, 0}, {5, 5, 5})};
    EXPECT_EQ(within(kept, {2}), at(0));
    EXPECT_EQ(within(kept, {1.5}), never);
}
TEST(separation, whose_sphere_is_touched_at_once) {
    // Passes a vertex at distance 3: a double root.
    const vertex_vertex passing{from_to({-4, 3, 0}, {12, 3, 0}), still({0, 0, 0})};
    EXPECT_EQ(within(passing, {3}), at(0.25));
    EXPECT_EQ(within(passing, {std::nextafter(3.0, 0)}), never);
    EXPECT_EQ(within(passing, {5}), at(0));
    // Passes an edge.
    const vertex_edge beside{from_to({0.5, 3, -4}, {0.5, 3, 12}), still({0, 0, 0}),
                             still({1, 0, 0})};
    EXPECT_EQ(within(beside, {3}), at(0.25));
}
}  // namespace
