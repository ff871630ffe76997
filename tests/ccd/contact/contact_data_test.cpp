// Contacts made by hand, with known times, features, weights, normals and velocities.
#include <gtest/gtest.h>

#include <array>
#include <ccd/contact.hpp>
#include <ccd/plane.hpp>
#include <ccd/reference.hpp>
#include <cmath>

#include "tests/ccd/contact/by_hand.hpp"

namespace {

using ccd::first_contact;
using ccd::kind;
using ccd::meeting_features;
using ccd::normal_source;
using ccd::outcome;
using namespace by_hand;

/// Edge a from (-1, 0, 0) to (1, 0, 0), at rest, and an edge b.
edge_edge on_x_axis(moving b0, moving b1) {
    return {still({-1, 0, 0}), still({1, 0, 0}), b0, b1};
}

/// The contact, which must be at this time, as by the reference.
template <class Query>
first_contact contact(const Query& query, const ccd::first_time& time) {
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
    const auto above = contact(over_triangle({0.25, 0.5, 1}, {0.25, 0.5, -1}), at(0.5));
    EXPECT_EQ(above.features, (meeting_features{kind::vertex_face, {0, 1, 2, 3}}));
    expect_weights(above, {1, 0.25, 0.25, 0.5});
    expect_normal(above, normal_source::cross_product, {0, 0, 1}, -2);
    EXPECT_TRUE(above.sided);
    const auto below = contact(over_triangle({0.25, 0.5, -1}, {0.25, 0.5, 2}), at_a_third);
    expect_weights(below, {1, 0.25, 0.25, 0.5});
    expect_normal(below, normal_source::cross_product, {0, 0, -1}, -3);
    EXPECT_TRUE(below.sided);
}
TEST(contact_data, of_edges_that_cross_from_either_side) {
    const auto above =
        contact(on_x_axis(from_to({0.5, -1, 1}, {0.5, -1, -2}), from_to({0.5, 3, 1}, {0.5, 3, -2})),
                at_a_third);
    EXPECT_EQ(above.features, (meeting_features{kind::edge_edge, {0, 1, 2, 3}}));
    expect_weights(above, {0.25, 0.75, 0.75, 0.25});
    expect_normal(above, normal_source::cross_product, {0, 0, -1}, -3);  // edge a is below
    EXPECT_TRUE(above.sided);
    const auto below =
        contact(on_x_axis(from_to({0.5, -1, -1}, {0.5, -1, 2}), from_to({0.5, 3, -1}, {0.5, 3, 2})),
                at_a_third);
    expect_normal(below, normal_source::cross_product, {0, 0, 1}, -3);
}
TEST(contact_data, of_a_vertex_on_the_border_of_a_face_names_the_border) {
    // Falls onto f1 f2 sideways: the normal is the face's, not opposite to the velocity.
    const auto edge = contact(over_triangle({0, 0.75, 1}, {0.5, 0.75, -1}), at(0.5));
    EXPECT_EQ(edge.features, (meeting_features{kind::vertex_edge, {0, 2, 3}}));
    expect_weights(edge, {1, 0, 0.25, 0.75});
    EXPECT_EQ(edge.weights[1], 0);
    expect_normal(edge, normal_source::cross_product, {0, 0, 1}, -2);
    const auto corner = contact(over_triangle({0, 1, 1}, {0, 1, -1}), at(0.5));
    EXPECT_EQ(corner.features, (meeting_features{kind::vertex_vertex, {0, 3}}));
    expect_weights(corner, {1, 0, 0, 1});
    EXPECT_EQ(corner.weight_error, 0);
    expect_normal(corner, normal_source::cross_product, {0, 0, 1}, -2);
    EXPECT_TRUE(corner.sided);
}
TEST(contact_data, of_an_edge_s_end_names_the_vertex_first) {
    // b0 falls onto the middle of a.
    const auto end =
        contact(on_x_axis(from_to({0, 0, 1}, {0, 0, -1}), from_to({0, 2, 1}, {0, 2, -1})), at(0.5));
    EXPECT_EQ(end.features, (meeting_features{kind::vertex_edge, {2, 0, 1}}));
    expect_weights(end, {0.5, 0.5, 1, 0});
    expect_normal(end, normal_source::cross_product, {0, 0, -1}, -2);
    const auto ends =
        contact(on_x_axis(from_to({1, 0, 1}, {1, 0, -1}), from_to({1, 2, 1}, {1, 2, -1})), at(0.5));
    EXPECT_EQ(ends.features, (meeting_features{kind::vertex_vertex, {1, 2}}));
    expect_weights(ends, {0, 1, 1, 0});
}
TEST(contact_data, of_a_touch_without_crossing_is_on_the_side_it_came_from) {
    // Y = 4u² with u = 2t − 1 has no second side.
    const auto found = contact(
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
        const auto found = contact(over_triangle({0.25, 0.5, 0}, {0.25, 0.5, end}), at(0));
        expect_weights(found, {1, 0.25, 0.25, 0.5});
        expect_normal(found, normal_source::cross_product, {0, 0, 1}, end);
        EXPECT_FALSE(found.sided);
    }
}
TEST(contact_data, of_features_at_rest) {
    const auto resting = contact(over_triangle({0.5, 0, 0}, {0.5, 0, 0}), at(0));
    EXPECT_EQ(resting.features, (meeting_features{kind::vertex_edge, {0, 1, 2}}));
    expect_normal(resting, normal_source::cross_product, {0, 0, 1}, 0);
    EXPECT_FALSE(resting.sided);
    const auto vertex = still({0.5, 0, 0});
    const auto none = contact(vertex_vertex{vertex, vertex}, at(0));
    EXPECT_EQ(none.normal_from, normal_source::none);
    EXPECT_EQ(none.normal, (point{0, 0, 0}));
    EXPECT_EQ(none.normal_velocity_error, infinity);
    EXPECT_FALSE(none.sided);
}

TEST(contact_data, of_motion_in_a_plane_is_normal_to_the_edge_that_is_hit) {
    // Moves obliquely through the edge f2 f0.
    const auto found = contact(over_triangle({-0.25, 0, 0}, {0.75, 1, 0}), at(0.25));
    EXPECT_EQ(found.features, (meeting_features{kind::vertex_edge, {0, 3, 1}}));
    expect_weights(found, {1, 0.75, 0, 0.25});
    expect_normal(found, normal_source::nearest_points, {-1, 0, 0}, -1);
    EXPECT_TRUE(found.sided);
}
TEST(contact_data, of_parallel_edges_is_normal_to_them) {
    const auto found = contact(
        on_x_axis(from_to({0, 1, 1}, {1, -1, -1}), from_to({4, 1, 1}, {5, -1, -1})), at(0.5));
    EXPECT_EQ(found.features, (meeting_features{kind::vertex_edge, {1, 2, 3}}));
    expect_weights(found, {0, 1, 0.875, 0.125});
    expect_normal(found, normal_source::nearest_points, {0, -1, -1}, -std::sqrt(8));
}
TEST(contact_data, of_edges_on_one_line_is_along_it) {
    const auto found =
        contact(on_x_axis(from_to({3, 0, 0}, {1, 0, 0}), from_to({5, 0, 0}, {3, 0, 0})), at(1));
    EXPECT_EQ(found.features, (meeting_features{kind::vertex_vertex, {1, 2}}));
    expect_normal(found, normal_source::nearest_points, {-1, 0, 0}, -2);
}
TEST(contact_data, of_a_face_without_area_is_its_edge_s) {
    const vertex_face segment{from_to({0.5, 0, 1}, {0.5, 0, -1}), still({0, 0, 0}),
                              still({1, 0, 0}), still({2, 0, 0})};
    const auto found = contact(segment, at(0.5));
    EXPECT_EQ(found.features, (meeting_features{kind::vertex_edge, {0, 1, 2}}));
    expect_weights(found, {1, 0.5, 0.5, 0});
    expect_normal(found, normal_source::nearest_points, {0, 0, 1}, -2);
    const vertex_face spot{from_to({0, 0, 1}, {0, 0, -3}), still({0, 0, 0}), still({0, 0, 0}),
                           still({0, 0, 0})};
    EXPECT_EQ(contact(spot, at(0.25)).features, (meeting_features{kind::vertex_vertex, {0, 1}}));
}

TEST(contact_data, of_a_vertex_and_an_edge) {
    const vertex_edge crossing{from_to({0.25, 1, 0}, {0.75, -1, 0}), still({0, 0, 0}),
                               still({1, 0, 0})};
    const auto found = contact(crossing, at(0.5));
    EXPECT_EQ(found.features, (meeting_features{kind::vertex_edge, {0, 1, 2}}));
    expect_weights(found, {1, 0.5, 0.5, 0});
    expect_normal(found, normal_source::nearest_points, {0, 1, 0}, -2);
    const vertex_edge along{from_to({0.25, 0, 0}, {0.75, 0, 0}), still({0, 0, 0}),
                            still({1, 0, 0})};
    const auto inside = contact(along, at(0));
    expect_normal(inside, normal_source::relative_velocity, {-1, 0, 0}, -0.5);
    EXPECT_FALSE(inside.sided);
    const vertex_edge to_its_end{from_to({-1, 0, 0}, {1, 0, 0}), still({0.5, 0, 0}),
                                 still({2, 0, 0})};
    EXPECT_EQ(contact(to_its_end, at(0.75)).features,
              (meeting_features{kind::vertex_vertex, {0, 1}}));
}
TEST(contact_data, of_two_vertices) {
    const vertex_vertex query{from_to({0, 0, 0}, {2, 2, 0}), from_to({0, 2, 0}, {2, 0, 0})};
    const auto found = contact(query, at(0.5));
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
    const vertex_face above_a_corner{from_to({-3, -3, 5}, {-3, -3, 0}), still({0, 0, 0}),
                                     still({1, 0, 0}), still({0, 1, 0})};
    const edge_edge beside{from_to({-1, 0, 2}, {-1, 0, -1}), from_to({1, 0, 2}, {1, 0, -1}),
                           still({1.5, -1, 0}), still({1.5, 1, 0})};
    const auto expect_nothing = [](const first_contact& found, const ccd::first_time& time) {
        EXPECT_EQ(time.outcome, outcome::collides);
        first_contact nothing;
        nothing.time = time;
        EXPECT_EQ(found, nothing);
    };
    const ccd::first_time at_corner = ccd::time_within(above_a_corner, {4.5, 0});
    expect_nothing(contact_at(above_a_corner, at_corner), at_corner);
    const ccd::first_time at_end = ccd::time_within(beside, {1, 0});
    expect_nothing(contact_at(beside, at_end), at_end);
    // In a plane or on a line, the features' planes or lines meet all the time, outside the
    // features.
    const vertex_face in_plane{from_to({5, 0.25, 0}, {1, 0.25, 0}), still({0, 0, 0}),
                               still({1, 0, 0}), still({0, 1, 0})};
    const ccd::first_time near_edge = ccd::time_within(in_plane, {1, 0});
    expect_nothing(contact_at(in_plane, near_edge), near_edge);
    const edge_edge past_end{still({0, 0, 0}), still({1, 0, 0}), from_to({3, -1, 1}, {3, -1, -1}),
                             from_to({3, 1, 1}, {3, 1, -1})};
    const ccd::first_time past = ccd::time_within(past_end, {2, 0});
    expect_nothing(contact_at(past_end, past), past);
    const vertex_edge on_line{from_to({3, 0, 0}, {2, 0, 0}), still({0, 0, 0}), still({1, 0, 0})};
    const ccd::first_time ahead = ccd::time_within(on_line, {1.5, 0});
    expect_nothing(contact_at(on_line, ahead), ahead);
}

TEST(contact_data, of_coordinates_of_all_magnitudes) {
    for (const double unit : {0x1p-1070, 0x1p-600, 0x1p600, 0x1p1020}) {
        const auto at = [unit](double x, double y, double z) {
            return point{x * unit, y * unit, z * unit};
        };
        const vertex_face query{from_to(at(1, 2, 1), at(1, 2, -1)), still(at(0, 0, 0)),
                                still(at(4, 0, 0)), still(at(0, 4, 0))};
        const auto found = contact(query, by_hand::at(0.5));
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
