// Motion along curves: cases made by hand, and random ones compared with the oracle.
#include <gtest/gtest.h>

#include <array>
#include <ccd/curves.hpp>
#include <ccd/kind.hpp>
#include <ccd/methods/transform.hpp>
#include <ccd/reference.hpp>
#include <cmath>
#include <cstddef>
#include <random>
#include <string>
#include <vector>

#include "tests/ccd/contact/by_hand.hpp"
#include "tests/support/first_time_faults.hpp"
#include "tests/support/query_families.hpp"
#include "tests/support/scaled.hpp"

namespace {

using by_hand::at;
using by_hand::infinity;
using by_hand::never;
using by_hand::point;
using ccd::first_time;
using ccd::outcome;
using ccd::separation;
using control = std::vector<point>;

const control f0{{0, 0, 0}}, f1{{1, 0, 0}}, f2{{0, 1, 0}};
first_time over_triangle(const control& v, double t_max = 1) {
    return ccd::time_of_impact(ccd::vertex_face_curves{v, f0, f1, f2}, t_max);
}

TEST(curves, that_touch_a_face_and_turn_back) {
    EXPECT_EQ(over_triangle({{0.25, 0.25, 1}, {0.25, 0.25, -1}, {0.25, 0.25, 1}}), at(0.5));
    EXPECT_EQ(over_triangle({{0.25, 0.25, 1}, {0.25, 0.25, -0.99}, {0.25, 0.25, 1}}), never);
    EXPECT_EQ(over_triangle({{2, 2, 1}, {2, 2, -1}, {2, 2, 1}}), never);
    EXPECT_EQ(over_triangle({{0.25, 0.25, 1}, {0.25, 0.25, -1}, {0.25, 0.25, 1}}, 0.25), never);
    // z = (1 − 4t)(3 − 4t): the first of two crossings.
    EXPECT_EQ(over_triangle({{0.25, 0.25, 3}, {0.25, 0.25, -5}, {0.25, 0.25, 3}}), at(0.25));
}
TEST(curves, in_the_plane_that_turn_back_at_an_edge) {
    // x = −(1 − 2t)² in the face's plane.
    EXPECT_EQ(over_triangle({{-1, 0.25, 0}, {1, 0.25, 0}, {-1, 0.25, 0}}), at(0.5));
    EXPECT_EQ(over_triangle({{-1, 0.25, 0}, {0.99, 0.25, 0}, {-1, 0.25, 0}}), never);
    // The vertex moves along the line of an edge to its end and back.
    const control v{{-1, 0, 0}, {1, 0, 0}, {-1, 0, 0}}, e0{{0, 0, 0}}, e1{{3, 0, 0}};
    EXPECT_EQ(ccd::time_of_impact(ccd::vertex_edge_curves{v, e0, e1}), at(0.5));
    EXPECT_EQ(ccd::time_of_impact(ccd::vertex_vertex_curves{v, e0}), at(0.5));
    EXPECT_EQ(ccd::time_of_impact(ccd::vertex_vertex_curves{v, e1}), never);
}
TEST(curves, within_a_distance) {
    const control v{{0.25, 0.25, 2}, {0.25, 0.25, 0}, {0.25, 0.25, 2}};  // down to 1
    const ccd::vertex_face_curves query{v, f0, f1, f2};
    EXPECT_EQ(ccd::time_within(query, {1}), at(0.5));
    EXPECT_EQ(ccd::time_within(query, {std::nextafter(1.0, 0)}), never);
    EXPECT_EQ(ccd::decide_within(query, {1}).outcome, outcome::collides);
    EXPECT_EQ(ccd::decide_within(query, {0.5}).outcome, outcome::separate);
    EXPECT_EQ(ccd::time_within(query, {2}), at(0));
}
TEST(curves, that_are_invalid_are_uncertain) {
    EXPECT_EQ(over_triangle({}), first_time{});
    EXPECT_EQ(over_triangle({{0, 0, 1}, {0, 0, infinity}, {0, 0, 1}}), first_time{});
    EXPECT_EQ(over_triangle({{0, 0, 1}}, infinity), first_time{});
    EXPECT_EQ(over_triangle({{0, 0, 1}}, -1), never);
    const ccd::vertex_vertex_curves query{f0, f1};
    EXPECT_EQ(ccd::time_within(query, {-1}), first_time{});
    EXPECT_EQ(ccd::decide_within(query, {-1}).cause, ccd::cause::range);
}
TEST(curves, of_a_degree_beyond_the_filter) {
    control v(80, {0.25, 0.25, 1});
    v.back().z = -1;  // 1 − 2t^79
    const first_time found = over_triangle(v);
    const double t = std::pow(0.5, 1 / 79.0);
    EXPECT_EQ(found.outcome, outcome::collides);
    EXPECT_NEAR(found.low, t, 1e-15);
    EXPECT_EQ(found.high, std::nextafter(found.low, 1));
}

TEST(curves, in_pieces_meet_at_the_first_of_them) {
    const control away{{0.25, 0.25, 1}}, down{{0.25, 0.25, 1}, {0.25, 0.25, -1}};
    using piece = ccd::spline_piece<ccd::vertex_face_curves>;
    const auto moving = [&](const control& v) { return ccd::vertex_face_curves{v, f0, f1, f2}; };
    const std::vector<piece> pieces{
        {0, 2, moving(away)}, {2, 3, moving(down)}, {3, 4, moving(down)}};
    const auto found = ccd::first_time_of_pieces(pieces);
    EXPECT_EQ(found.outcome, outcome::collides);
    EXPECT_EQ(found.piece, 1u);
    EXPECT_EQ(found.in_piece, at(0.5));
    EXPECT_LE(found.low, 2.5);
    EXPECT_GE(found.high, 2.5);
    EXPECT_LT(found.high - found.low, 1e-14);
    EXPECT_EQ(ccd::first_time_of_pieces(std::array{pieces[0]}).outcome, outcome::separate);
    EXPECT_EQ(ccd::first_time_of_pieces(pieces, {0.5}).in_piece, at(0.25));
    EXPECT_EQ(ccd::first_time_of_pieces(pieces, {-1}).outcome, outcome::uncertain);
    const auto start = ccd::first_time_of_pieces(std::array{piece{3, 5, moving(f0)}});
    EXPECT_EQ(start.low, 3);
    EXPECT_EQ(start.high, 3);
}

// ---- Random curves ----

/// Curves with these control points; kinds with fewer points skip the last ones.
template <ccd::kind K>
auto curves_of(const std::array<control, 4>& p) {
    if constexpr (K == ccd::kind::vertex_face)
        return ccd::vertex_face_curves{p[0], p[1], p[2], p[3]};
    else if constexpr (K == ccd::kind::edge_edge)
        return ccd::edge_edge_curves{p[0], p[1], p[2], p[3]};
    else if constexpr (K == ccd::kind::vertex_edge)
        return ccd::vertex_edge_curves{p[0], p[1], p[2]};
    else
        return ccd::vertex_vertex_curves{p[0], p[1]};
}

std::string text(const std::array<control, 4>& points) {
    std::string all;
    for (const control& p : points) {
        for (const point& c : p)
            all += "(" + std::to_string(c.x) + " " + std::to_string(c.y) + " " +
                   std::to_string(c.z) + ") ";
        all += "\n";
    }
    return all;
}

/// Points on a coarse grid, where many coincide, or at random positions.
class random_motion {
  public:
    explicit random_motion(unsigned seed) : random_(seed) {}

    /// Curves with 1 to `most` control points each.
    std::array<control, 4> of_up_to(std::size_t most) {
        size_ = 1 + static_cast<int>(random_() % 6);
        on_grid_ = random_() % 4 != 0;
        flat_ = random_() % 4 == 0;
        std::array<control, 4> points;
        for (control& c : points) {
            c.resize(1 + random_() % most);
            for (point& p : c) p = {coordinate(), coordinate(), flat_ ? 0 : coordinate()};
        }
        return points;
    }
    unsigned number() { return static_cast<unsigned>(random_()); }

  private:
    double coordinate() {
        if (!on_grid_) return std::ldexp(static_cast<double>(random_()), -63) - 1;
        return static_cast<double>(
            static_cast<int>(random_() % static_cast<unsigned>(2 * size_ + 1)) - size_);
    }
    std::mt19937_64 random_;
    int size_ = 2;
    bool on_grid_ = true, flat_ = false;
};

template <class Check>
void for_random_curves(int count, std::size_t most, const Check& check) {
    random_motion random(3);
    for (int i = 0; i < support::scaled(count); ++i) {
        const auto points = random.of_up_to(most);
        ccd::for_each_kind([&]<ccd::kind K>() { check(curves_of<K>(points), points, random); });
    }
}

TEST(random_curves, touch_first_at_the_time_of_the_oracle) {
    for_random_curves(400, 4, [](const auto& query, const auto& points, auto& random) {
        const double t_max = random.number() % 4 == 0 ? 0.5 : 1;
        const first_time found = ccd::time_of_impact(query, t_max);
        EXPECT_EQ(support::fault_of(query, found, t_max), "") << text(points);
        EXPECT_EQ(ccd::decide_exact(query).outcome == outcome::collides, oracle::collides(query))
            << text(points);
    });
}
TEST(random_curves, come_near_first_at_the_time_of_the_oracle) {
    for_random_curves(150, 3, [](const auto& query, const auto& points, auto& random) {
        const separation d{std::ldexp(1, static_cast<int>(random.number() % 5) - 3),
                           random.number() % 2 * 1.0};
        const first_time found = ccd::time_within(query, d);
        EXPECT_EQ(support::fault_of(query, d, found), "") << text(points);
        EXPECT_EQ(ccd::decide_within(query, d).outcome, found.outcome);
    });
}

}  // namespace
