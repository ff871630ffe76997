// Queries in the plane, made by hand, and compared with the oracle in another plane of space.
#include <gtest/gtest.h>

#include <ccd/plane.hpp>
#include <cmath>
#include <random>

#include "tests/ccd/contact/by_hand.hpp"
#include "tests/support/first_time_faults.hpp"
#include "tests/support/scaled.hpp"

namespace {

namespace plane = ccd::plane;
using by_hand::at;
using by_hand::infinity;
using by_hand::never;
using ccd::first_time;
using ccd::outcome;

plane::moving_point still(plane::point p) {
    return {p, p};
}

TEST(plane_queries, of_a_vertex_that_crosses_an_edge) {
    const plane::vertex_edge query{{{0.5, 1}, {0.5, -3}}, still({0, 0}), still({1, 0})};
    EXPECT_EQ(plane::time_of_impact(query), at(0.25));
    EXPECT_EQ(plane::time_of_impact(query, 0.125), never);
    EXPECT_EQ(plane::decide_exact(query).outcome, outcome::collides);
    EXPECT_EQ(plane::touches_at_start(query).outcome, outcome::separate);
    EXPECT_EQ(plane::time_within(query, {0.5}), at(0.125));
    EXPECT_EQ(plane::decide_within(query, {0.5}).outcome, outcome::collides);
}
TEST(plane_queries, of_what_is_not_finite) {
    EXPECT_EQ(plane::time_of_impact(plane::vertex_vertex{still({0, infinity}), still({1, 2})}),
              first_time{});
}

/// Moves the point to the plane of x and z, which the library does not treat specially.
ccd::moving_point<double> upright(const plane::moving_point& p) {
    return {{p.t0.x, 0, p.t0.y}, {p.t1.x, 0, p.t1.y}};
}

TEST(random_plane_queries, agree_with_the_oracle_in_another_plane) {
    std::mt19937_64 random(11);
    const auto check = [](const auto& query, const auto& upright_query, ccd::separation d) {
        const first_time contact = plane::time_of_impact(query),
                         near = plane::time_within(query, d);
        EXPECT_EQ(support::fault_of(upright_query, contact), "");
        EXPECT_EQ(support::fault_of(upright_query, d, near), "");
        EXPECT_EQ(plane::decide_exact(query).outcome, contact.outcome);
        EXPECT_EQ(plane::decide_within(query, d).outcome, near.outcome);
        EXPECT_EQ(plane::touches_at_start(query).outcome == outcome::collides, contact.at_start());
    };
    for (int i = 0; i < support::scaled(1000); ++i) {
        const int size = static_cast<int>(random() % 8);
        const auto coordinate = [&] {
            return static_cast<double>(static_cast<int>(random() % 17) % (2 * size + 1) - size);
        };
        const auto moving = [&] {
            const plane::point from{coordinate(), coordinate()};
            return plane::moving_point{from, {coordinate(), coordinate()}};
        };
        const plane::vertex_edge ve{moving(), moving(), moving()};
        const plane::vertex_vertex vv{ve.v, ve.e0};
        const ccd::separation d{std::ldexp(1, static_cast<int>(random() % 4) - 2)};
        check(ve, ccd::vertex_edge<double>{upright(ve.v), upright(ve.e0), upright(ve.e1)}, d);
        check(vv, ccd::vertex_vertex<double>{upright(vv.v), upright(vv.w)}, d);
    }
}

}  // namespace
