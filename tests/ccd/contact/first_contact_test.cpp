// First contact times made by hand, one of each degenerate kind, by time_of_impact and the
// reference. contact_data_test.cpp has more contacts.
#include <gtest/gtest.h>

#include <ccd/contact.hpp>
#include <ccd/reference.hpp>
#include <cmath>
#include <limits>

#include "tests/ccd/contact/by_hand.hpp"

namespace {

using ccd::first_time;
using ccd::outcome;
using namespace by_hand;

/// The first time by both functions, which must agree.
template <class Query>
first_time contact(const Query& query, double t_max = 1) {
    const first_time found = ccd::time_of_impact(query, t_max);
    EXPECT_EQ(found, ccd::time_of_impact_reference(query, t_max));
    return found;
}

TEST(first_contact, at_the_start_and_at_the_end) {
    const first_time start = contact(over_triangle({0.25, 0.25, 0}, {0.25, 0.25, 1}));
    EXPECT_EQ(start, at(0));
    EXPECT_TRUE(start.at_start());
    EXPECT_EQ(contact(over_triangle({0.25, 0.25, 1}, {0.25, 0.25, 0})), at(1));
    EXPECT_EQ(contact(over_triangle({0.25, 0.25, 1}, {0.25, 0.25, least})), never);
}
TEST(first_contact, below_the_least_double_is_not_at_the_start) {
    // At t = 2^-1074/(2^-1074 + 1), less than 2^-1074.
    const first_time found = contact(over_triangle({0.25, 0.25, least}, {0.25, 0.25, -1}));
    EXPECT_EQ(found, between(0, least));
    EXPECT_FALSE(found.at_start());
    EXPECT_EQ(contact(over_triangle({0.25, 0.25, least}, {0.25, 0.25, -1}), 0), never);
}
TEST(first_contact, after_t_max_is_none) {
    const auto query = over_triangle({0.25, 0.25, 1}, {0.25, 0.25, -1});
    EXPECT_EQ(contact(query, 0.5), at(0.5));
    EXPECT_EQ(contact(query, std::nextafter(0.5, 0)), never);
    EXPECT_EQ(contact(query, -0.5), never);
    EXPECT_EQ(contact(query, 7), at(0.5));
    EXPECT_EQ(contact(over_triangle({0.25, 0.25, 1}, {0.25, 0.25, -2}), 1.0 / 3), never);
}
TEST(first_contact, with_coordinates_that_are_not_finite_is_uncertain) {
    EXPECT_EQ(contact(over_triangle({0.25, 0.25, infinity}, {0.25, 0.25, 1})), first_time{});
    EXPECT_EQ(contact(over_triangle({2, 2, 2}, {2, 2, 2}), infinity), first_time{});
    EXPECT_EQ(contact(over_triangle({2, 2, 2}, {2, 2, 2}), std::nan("")), first_time{});
}

TEST(first_contact, in_the_plane_is_at_an_edge) {
    EXPECT_EQ(contact(over_triangle({-0.25, 2, 0}, {0.75, 2, 0})), never);
    EXPECT_EQ(contact(over_triangle({0.25, 0.25, 0}, {2, 2, 0})), at(0));
}
TEST(first_contact, in_the_plane_along_an_edge_s_line_is_at_its_end) {
    EXPECT_EQ(contact(over_triangle({-1, 0, 0}, {3, 0, 0})), at(0.25));
    EXPECT_EQ(contact(over_triangle({3, 0, 0}, {-1, 0, 0})), at(0.5));
}
TEST(first_contact, at_a_double_root_is_found_though_nothing_crosses) {
    // With u = 3t − 1, edge b is (0, −1 − u, −u) + s·(0, 2, 2u): Y = 4u².
    const edge_edge turning{still({-1, 0, 0}), still({1, 0, 0}), from_to({0, 0, 1}, {0, -3, -2}),
                            from_to({0, 2, -1}, {0, -1, 2})};
    EXPECT_EQ(contact(turning), at_a_third);
}
TEST(first_contact, at_a_triple_root_is_found) {
    // b, c and p are on the axes, times 1 − 3t: the figure shrinks to a point at 1/3.
    const vertex_face query{from_to({0, 0, 1}, {0, 0, -2}), still({0, 0, 0}),
                            from_to({1, 0, 0}, {-2, 0, 0}), from_to({0, 1, 0}, {0, -2, 0})};
    EXPECT_EQ(contact(query), at_a_third);
}
TEST(first_contact, is_at_the_second_root_where_the_first_is_outside) {
    // With u = 2t − 1, N = (0, −u, 1) and Y = (1 − 4u²)/8; at u = −1/2, v is at y = −1/4.
    const vertex_face query{from_to({0.25, -0.5, 0.125}, {0.25, 0.5, 0.125}), still({0, 0, 0}),
                            still({1, 0, 0}), from_to({0, 1, -1}, {0, 1, 1})};
    EXPECT_EQ(contact(query), at(0.75));
}

TEST(first_contact, with_a_triangle_that_is_a_segment_only_at_that_time) {
    // f2 falls onto the line of f0 f1 together with v, at t = 1/2.
    const vertex_face query{from_to({0.5, -1, 0}, {0.5, 1, 0}), still({0, 0, 0}), still({1, 0, 0}),
                            from_to({0, 0, 1}, {0, 0, -1})};
    EXPECT_EQ(contact(query), at(0.5));
}

TEST(first_contact, along_the_line_of_an_edge_that_grows_from_a_point) {
    // The edge grows from (1, 0, 0) in both directions while v moves from 0: v = t, edge [1 − t, 1
    // + t].
    const vertex_edge query{from_to({0, 0, 0}, {1, 0, 0}), from_to({1, 0, 0}, {0, 0, 0}),
                            from_to({1, 0, 0}, {2, 0, 0})};
    EXPECT_EQ(contact(query), at(0.5));
}
TEST(first_contact, at_an_irrational_time) {
    // In y and z: v = (2t, 1), and the edge goes from 0 to (2, 2t), so 4t² = 2.
    const vertex_edge query{from_to({0, 0, 1}, {0, 2, 1}), still({0, 0, 0}),
                            from_to({0, 2, 0}, {0, 2, 2})};
    const double root = std::sqrt(0.5);  // rounded up
    EXPECT_EQ(contact(query), between(std::nextafter(root, 0), root));
}
TEST(first_contact, at_a_double_root_just_after_a_root_that_is_none) {
    // Y = (t − r)(t − m)². At r the face has no area and v is outside it. Regression: the root at r
    // was tested with the weights at m, which is within the bracket around r.
    const double m = 0.25 + 0x1p-8 + 0x1p-20, r = m - 0x1p-44, y = 0x1p-46;
    const vertex_face query{from_to({0.5, y, -m}, {0.5, y, 1 - m}), still({0, 0, 0}),
                            from_to({1 - m, 0, -2 * m}, {2 - m, 0, 2 - 2 * m}),
                            from_to({0, -r, 0}, {0, 1 - r, 0})};
    EXPECT_EQ(contact(query), at(m));
}
TEST(first_contact, of_coordinates_of_all_magnitudes) {
    const double huge = std::numeric_limits<double>::max();
    EXPECT_EQ(contact(over_triangle({0.25, 0.25, huge}, {0.25, 0.25, -huge})), at(0.5));
    const first_time near_end = contact(over_triangle({0.25, 0.25, huge}, {0.25, 0.25, -least}));
    EXPECT_EQ(near_end, between(std::nextafter(1.0, 0), 1));
    const vertex_vertex tiny{from_to({least, 0, 0}, {-huge, 0, 0}), still({0, 0, 0})};
    EXPECT_EQ(contact(tiny), between(0, least));
}

}  // namespace
