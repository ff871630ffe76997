// Contacts and distances made by hand: first times by the library and by the reference, and contact
// data with known features, weights, normals and velocities. The soaks of times and of separations
// compare all families of queries and distances with an oracle.
#include <gtest/gtest.h>

#include <array>
#include <ccd/contact.hpp>
#include <ccd/plane.hpp>
#include <ccd/reference.hpp>
#include <cmath>
#include <limits>

#include "tests/ccd/contact/by_hand.hpp"

namespace {

using ccd::first_contact;
using ccd::first_time;
using ccd::kind;
using ccd::meeting_features;
using ccd::normal_source;
using ccd::outcome;
using ccd::separation;
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

// ---- Distances ----

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

// ---- Contact data ----

/// Edge a from (-1, 0, 0) to (1, 0, 0), at rest, and an edge b.
edge_edge on_x_axis(moving b0, moving b1) {
    return {still({-1, 0, 0}), still({1, 0, 0}), b0, b1};
}

/// The contact, which must be at this time, as by the reference.
template <class Query>
first_contact data_of(const Query& query, const ccd::first_time& time) {
    const first_contact found = ccd::find_first_contact(query);
    EXPECT_EQ(found.time, time);
    EXPECT_EQ(ccd::time_of_impact(query), time);
    EXPECT_EQ(ccd::time_of_impact_reference(query), time);
    return found;
}
void expect_weights(const first_contact& found, std::array<double, 4> weights) {
    for (std::size_t i = 0; i < 4; ++i)
        EXPECT_NEAR(found.weights[i], weights[i], found.weight_error) << "of point " << i;
    EXPECT_LE(found.weight_error, 2e-15);
}
void expect_normal(const first_contact& found, normal_source source, point n, double velocity) {
    EXPECT_EQ(found.normal_from, source);
    const double length = std::sqrt(n.x * n.x + n.y * n.y + n.z * n.z);
    EXPECT_NEAR(found.normal.x, n.x / length, found.normal_error);
    EXPECT_NEAR(found.normal.y, n.y / length, found.normal_error);
    EXPECT_NEAR(found.normal.z, n.z / length, found.normal_error);
    EXPECT_LE(found.normal_error, 2e-15);
    EXPECT_NEAR(found.normal_velocity, velocity,
                found.normal_velocity_error + 1e-15 * std::abs(velocity));
    EXPECT_LE(found.normal_velocity_error, 1e-14);
}

TEST(contact_data, of_a_vertex_inside_a_face_from_either_side) {
    const auto above = data_of(over_triangle({0.25, 0.5, 1}, {0.25, 0.5, -1}), at(0.5));
    EXPECT_EQ(above.features, (meeting_features{kind::vertex_face, {0, 1, 2, 3}}));
    expect_weights(above, {1, 0.25, 0.25, 0.5});
    expect_normal(above, normal_source::cross_product, {0, 0, 1}, -2);
    EXPECT_TRUE(above.sided);
    const auto below = data_of(over_triangle({0.25, 0.5, -1}, {0.25, 0.5, 2}), at_a_third);
    expect_weights(below, {1, 0.25, 0.25, 0.5});
    expect_normal(below, normal_source::cross_product, {0, 0, -1}, -3);
    EXPECT_TRUE(below.sided);
}
TEST(contact_data, of_edges_that_cross_from_either_side) {
    const auto above =
        data_of(on_x_axis(from_to({0.5, -1, 1}, {0.5, -1, -2}), from_to({0.5, 3, 1}, {0.5, 3, -2})),
                at_a_third);
    EXPECT_EQ(above.features, (meeting_features{kind::edge_edge, {0, 1, 2, 3}}));
    expect_weights(above, {0.25, 0.75, 0.75, 0.25});
    expect_normal(above, normal_source::cross_product, {0, 0, -1}, -3);  // edge a is below
    EXPECT_TRUE(above.sided);
    const auto below =
        data_of(on_x_axis(from_to({0.5, -1, -1}, {0.5, -1, 2}), from_to({0.5, 3, -1}, {0.5, 3, 2})),
                at_a_third);
    expect_normal(below, normal_source::cross_product, {0, 0, 1}, -3);
}
TEST(contact_data, of_a_vertex_on_the_border_of_a_face_names_the_border) {
    // Falls onto f1 f2 sideways: the normal is the face's, not opposite to the velocity.
    const auto edge = data_of(over_triangle({0, 0.75, 1}, {0.5, 0.75, -1}), at(0.5));
    EXPECT_EQ(edge.features, (meeting_features{kind::vertex_edge, {0, 2, 3}}));
    expect_weights(edge, {1, 0, 0.25, 0.75});
    EXPECT_EQ(edge.weights[1], 0);
    expect_normal(edge, normal_source::cross_product, {0, 0, 1}, -2);
    const auto corner = data_of(over_triangle({0, 1, 1}, {0, 1, -1}), at(0.5));
    EXPECT_EQ(corner.features, (meeting_features{kind::vertex_vertex, {0, 3}}));
    expect_weights(corner, {1, 0, 0, 1});
    EXPECT_EQ(corner.weight_error, 0);
    expect_normal(corner, normal_source::cross_product, {0, 0, 1}, -2);
    EXPECT_TRUE(corner.sided);
}
TEST(contact_data, of_an_edge_s_end_names_the_vertex_first) {
    // b0 falls onto the middle of a.
    const auto end =
        data_of(on_x_axis(from_to({0, 0, 1}, {0, 0, -1}), from_to({0, 2, 1}, {0, 2, -1})), at(0.5));
    EXPECT_EQ(end.features, (meeting_features{kind::vertex_edge, {2, 0, 1}}));
    expect_weights(end, {0.5, 0.5, 1, 0});
    expect_normal(end, normal_source::cross_product, {0, 0, -1}, -2);
    const auto ends =
        data_of(on_x_axis(from_to({1, 0, 1}, {1, 0, -1}), from_to({1, 2, 1}, {1, 2, -1})), at(0.5));
    EXPECT_EQ(ends.features, (meeting_features{kind::vertex_vertex, {1, 2}}));
    expect_weights(ends, {0, 1, 1, 0});
}
TEST(contact_data, of_a_touch_without_crossing_is_on_the_side_it_came_from) {
    // Y = 4u² with u = 2t − 1 has no second side.
    const auto found = data_of(
        on_x_axis(from_to({0, 0, 1}, {0, -2, -1}), from_to({0, 2, -1}, {0, 0, 1})), at(0.5));
    expect_weights(found, {0.5, 0.5, 0.5, 0.5});
    expect_normal(found, normal_source::cross_product, {0, 0, -1}, 0);
    EXPECT_TRUE(found.sided);
}
TEST(contact_data, weight_error_includes_the_rounding_of_weights) {
    // At t = 1/3 the weights are 2^-54, 2^-54 + 2^-106/3, and 1 minus both. The last is a tie
    // twice, rounded to 1 each time.
    const auto found = ccd::find_first_contact(
        over_triangle({0x1p-54, 0x1p-54, 1}, {0x1p-54, 0x1p-54 + 0x1p-106, -2}));
    EXPECT_EQ(found.weights, (std::array<double, 4>{1, 1, 0x1p-54, 0x1p-54}));
    EXPECT_GT(found.weight_error, 0x1p-53);
    EXPECT_LE(found.weight_error, 0x1p-52);
}
TEST(contact_data, at_the_start_has_no_side) {
    for (const double end : {-1.0, 1.0}) {
        const auto found = data_of(over_triangle({0.25, 0.5, 0}, {0.25, 0.5, end}), at(0));
        expect_weights(found, {1, 0.25, 0.25, 0.5});
        expect_normal(found, normal_source::cross_product, {0, 0, 1}, end);
        EXPECT_FALSE(found.sided);
    }
}
TEST(contact_data, of_features_at_rest) {
    const auto resting = data_of(over_triangle({0.5, 0, 0}, {0.5, 0, 0}), at(0));
    EXPECT_EQ(resting.features, (meeting_features{kind::vertex_edge, {0, 1, 2}}));
    expect_normal(resting, normal_source::cross_product, {0, 0, 1}, 0);
    EXPECT_FALSE(resting.sided);
    const auto vertex = still({0.5, 0, 0});
    const auto none = data_of(vertex_vertex{vertex, vertex}, at(0));
    EXPECT_EQ(none.normal_from, normal_source::none);
    EXPECT_EQ(none.normal, (point{0, 0, 0}));
    EXPECT_EQ(none.normal_velocity_error, infinity);
    EXPECT_FALSE(none.sided);
}

TEST(contact_data, of_motion_in_a_plane_is_normal_to_the_edge_that_is_hit) {
    // Moves obliquely through the edge f2 f0.
    const auto found = data_of(over_triangle({-0.25, 0, 0}, {0.75, 1, 0}), at(0.25));
    EXPECT_EQ(found.features, (meeting_features{kind::vertex_edge, {0, 3, 1}}));
    expect_weights(found, {1, 0.75, 0, 0.25});
    expect_normal(found, normal_source::nearest_points, {-1, 0, 0}, -1);
    EXPECT_TRUE(found.sided);
}
TEST(contact_data, of_parallel_edges_is_normal_to_them) {
    const auto found = data_of(
        on_x_axis(from_to({0, 1, 1}, {1, -1, -1}), from_to({4, 1, 1}, {5, -1, -1})), at(0.5));
    EXPECT_EQ(found.features, (meeting_features{kind::vertex_edge, {1, 2, 3}}));
    expect_weights(found, {0, 1, 0.875, 0.125});
    expect_normal(found, normal_source::nearest_points, {0, -1, -1}, -std::sqrt(8));
}
TEST(contact_data, of_edges_on_one_line_is_along_it) {
    const auto found =
        data_of(on_x_axis(from_to({3, 0, 0}, {1, 0, 0}), from_to({5, 0, 0}, {3, 0, 0})), at(1));
    EXPECT_EQ(found.features, (meeting_features{kind::vertex_vertex, {1, 2}}));
    expect_normal(found, normal_source::nearest_points, {-1, 0, 0}, -2);
}
TEST(contact_data, of_a_face_without_area_is_its_edge_s) {
    const vertex_face segment{from_to({0.5, 0, 1}, {0.5, 0, -1}), still({0, 0, 0}),
                              still({1, 0, 0}), still({2, 0, 0})};
    const auto found = data_of(segment, at(0.5));
    EXPECT_EQ(found.features, (meeting_features{kind::vertex_edge, {0, 1, 2}}));
    expect_weights(found, {1, 0.5, 0.5, 0});
    expect_normal(found, normal_source::nearest_points, {0, 0, 1}, -2);
    const vertex_face spot{from_to({0, 0, 1}, {0, 0, -3}), still({0, 0, 0}), still({0, 0, 0}),
                           still({0, 0, 0})};
    EXPECT_EQ(data_of(spot, at(0.25)).features, (meeting_features{kind::vertex_vertex, {0, 1}}));
}

TEST(contact_data, of_a_vertex_and_an_edge) {
    const vertex_edge crossing{from_to({0.25, 1, 0}, {0.75, -1, 0}), still({0, 0, 0}),
                               still({1, 0, 0})};
    const auto found = data_of(crossing, at(0.5));
    EXPECT_EQ(found.features, (meeting_features{kind::vertex_edge, {0, 1, 2}}));
    expect_weights(found, {1, 0.5, 0.5, 0});
    expect_normal(found, normal_source::nearest_points, {0, 1, 0}, -2);
    const vertex_edge along{from_to({0.25, 0, 0}, {0.75, 0, 0}), still({0, 0, 0}),
                            still({1, 0, 0})};
    const auto inside = data_of(along, at(0));
    expect_normal(inside, normal_source::relative_velocity, {-1, 0, 0}, -0.5);
    EXPECT_FALSE(inside.sided);
    const vertex_edge to_its_end{from_to({-1, 0, 0}, {1, 0, 0}), still({0.5, 0, 0}),
                                 still({2, 0, 0})};
    EXPECT_EQ(data_of(to_its_end, at(0.75)).features,
              (meeting_features{kind::vertex_vertex, {0, 1}}));
}
TEST(contact_data, of_two_vertices) {
    const vertex_vertex query{from_to({0, 0, 0}, {2, 2, 0}), from_to({0, 2, 0}, {2, 0, 0})};
    const auto found = data_of(query, at(0.5));
    EXPECT_EQ(found.features, (meeting_features{kind::vertex_vertex, {0, 1}}));
    expect_weights(found, {1, 1, 0, 0});
    expect_normal(found, normal_source::nearest_points, {0, -1, 0}, -4);
    EXPECT_TRUE(found.sided);
}

TEST(contact_data, in_the_plane_has_its_normal_there) {
    const ccd::plane::vertex_edge query{
        {{0.25, 1}, {0.75, -1}}, {{0, -1}, {0, -1}}, {{1, 1}, {1, 1}}};
    const auto found = ccd::plane::find_first_contact(query);
    expect_weights(found, {1, 0.5, 0.5, 0});
    expect_normal(found, normal_source::nearest_points, {-2, 1, 0}, -3 / std::sqrt(5));
    const ccd::plane::vertex_vertex ends{{{0, 0}, {2, 0}}, {{1, 1}, {1, -1}}};
    expect_normal(ccd::plane::find_first_contact(ends), normal_source::nearest_points, {-1, -1, 0},
                  -std::sqrt(8));
}

TEST(contact_data, of_separate_features_is_empty) {
    const auto apart = ccd::find_first_contact(over_triangle({2, 2, 1}, {2, 2, -1}));
    EXPECT_EQ(apart.time.outcome, outcome::separate);
    EXPECT_EQ(apart.weights, (std::array<double, 4>{}));
    EXPECT_EQ(apart.weight_error, infinity);
    EXPECT_EQ(apart.normal_from, normal_source::none);
    const auto late = ccd::find_first_contact(over_triangle({0.25, 0.5, 1}, {0.25, 0.5, -1}), 0.25);
    EXPECT_EQ(late.time.outcome, outcome::separate);
    const auto unknown = ccd::find_first_contact(over_triangle({infinity, 0, 0}, {0, 0, 0}));
    EXPECT_EQ(unknown.time.outcome, outcome::uncertain);
}
/// If a corner of the face or an end of an edge is nearest, the cross product is not a normal.
TEST(contact_data, of_a_time_within_a_distance_is_empty) {
    const auto expect_nothing = [](const auto& query, double distance) {
        first_contact nothing;
        nothing.time = ccd::time_within(query, {distance, 0});
        EXPECT_EQ(nothing.time.outcome, outcome::collides);
        EXPECT_EQ(contact_at(query, nothing.time), nothing);
    };
    expect_nothing(over_triangle({-3, -3, 5}, {-3, -3, 0}), 4.5);
    expect_nothing(edge_edge{from_to({-1, 0, 2}, {-1, 0, -1}), from_to({1, 0, 2}, {1, 0, -1}),
                             still({1.5, -1, 0}), still({1.5, 1, 0})},
                   1);
    // In a plane or on a line, the features' planes or lines meet all the time, outside the
    // features.
    expect_nothing(over_triangle({5, 0.25, 0}, {1, 0.25, 0}), 1);
    expect_nothing(edge_edge{still({0, 0, 0}), still({1, 0, 0}), from_to({3, -1, 1}, {3, -1, -1}),
                             from_to({3, 1, 1}, {3, 1, -1})},
                   2);
    expect_nothing(vertex_edge{from_to({3, 0, 0}, {2, 0, 0}), still({0, 0, 0}), still({1, 0, 0})},
                   1.5);
}

TEST(contact_data, of_coordinates_of_all_magnitudes) {
    for (const double unit : {0x1p-1070, 0x1p-600, 0x1p600, 0x1p1020}) {
        const auto at = [unit](double x, double y, double z) {
            return point{x * unit, y * unit, z * unit};
        };
        const vertex_face query{from_to(at(1, 2, 1), at(1, 2, -1)), still(at(0, 0, 0)),
                                still(at(4, 0, 0)), still(at(0, 4, 0))};
        const auto found = data_of(query, by_hand::at(0.5));
        expect_weights(found, {1, 0.25, 0.25, 0.5});
        EXPECT_EQ(found.normal, (point{0, 0, 1}));
        EXPECT_NEAR(found.normal_velocity / unit, -2, 1e-14);
    }
}
TEST(contact_data, of_a_sliver_has_large_errors) {
    // Edges that rotate past each other, parallel except for 2^-60.
    const double tilt = 0x1p-60;
    const auto found = ccd::find_first_contact(
        on_x_axis(from_to({-1, -tilt, 1}, {-1, -tilt, -2}), from_to({1, tilt, 1}, {1, tilt, -2})));
    EXPECT_EQ(found.features.kind, kind::edge_edge);
    EXPECT_NEAR(found.weights[0], 0.5, found.weight_error);
    EXPECT_NEAR(found.weights[0] + found.weights[1], 1, 1e-15);
    const vertex_face needle{from_to({0.5, 0x1p-1060, 1}, {0.5, 0x1p-1060, -2}), still({0, 0, 0}),
                             still({1, 0, 0}), still({0.5, 0x1p-1058, 0})};
    const auto thin = ccd::find_first_contact(needle);
    EXPECT_EQ(thin.features.kind, kind::vertex_face);
    double sum = 0;
    for (std::size_t i = 1; i < 4; ++i) {
        EXPECT_GE(thin.weights[i], 0);
        sum += thin.weights[i];
    }
    EXPECT_NEAR(sum, 1, 1e-15);
    EXPECT_EQ(thin.weight_error, infinity);
}

}  // namespace
