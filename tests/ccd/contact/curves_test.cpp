// Motion along curves, also with weights: cases made by hand, and random ones compared with the
// oracle.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <ccd/curves.hpp>
#include <ccd/kind.hpp>
#include <cmath>
#include <cstddef>
#include <random>
#include <type_traits>
#include <utility>
#include <vector>

#include "tests/ccd/contact/random_motion.hpp"
#include "tests/support/first_time_faults.hpp"
#include "tests/support/oracle_rational.hpp"
#include "tests/support/scaled.hpp"
#include "tests/support/special_values.hpp"

namespace {

using by_hand::at;
using by_hand::infinity;
using by_hand::never;
using by_hand::point;
using ccd::first_time;
using ccd::kind;
using ccd::outcome;
using ccd::rational_curve;
using ccd::separation;
using control = std::vector<point>;
using weights = std::vector<double>;

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
    EXPECT_EQ(found.low, 2.5);
    EXPECT_EQ(found.high, 2.5);
    EXPECT_EQ(ccd::first_time_of_pieces(std::array{pieces[0]}).outcome, outcome::separate);
    EXPECT_EQ(ccd::first_time_of_pieces(pieces, {0.5}).in_piece, at(0.25));
    EXPECT_EQ(ccd::first_time_of_pieces(pieces, {-1}).outcome, outcome::uncertain);
    const auto start = ccd::first_time_of_pieces(std::array{piece{3, 5, moving(f0)}});
    EXPECT_EQ(start.low, 3);
    EXPECT_EQ(start.high, 3);
}

TEST(random_curves, in_pieces_have_bounds_of_the_exact_time) {
    std::mt19937_64 random(7);
    int exact = 0;
    for (int i = support::scaled(20000); i > 0; --i) {
        double from = special_value<double>(random), to = special_value<double>(random);
        if (i % 4 == 0) to = std::nextafter(from, HUGE_VAL);
        if (from > to) std::swap(from, to);
        double t = i % 3 == 0 ? static_cast<double>(random() % 9) / 8
                              : std::ldexp(static_cast<double>(random() >> 11), -53);
        if (i % 5 == 0) t = std::ldexp(t, -static_cast<int>(random() % 1000));
        const auto [low, high] = ccd::detail::time_between(from, to, t);
        const rational time = exactly(from) + exactly(t) * (exactly(to) - exactly(from));
        EXPECT_LE(exactly(low), time);
        EXPECT_GE(exactly(high), time);
        EXPECT_TRUE(from <= low && high <= to);
        exact += low == high;
        const double larger = std::max(std::abs(from), std::abs(to));
        const double ulp = std::nextafter(larger, HUGE_VAL) - larger;
        EXPECT_LE(high - low, 8 * ulp) << from << ' ' << to << ' ' << t;
    }
    EXPECT_GT(exact, 100);
}

// ---- Curves with weights ----

TEST(rational_curves, that_are_circles_meet_a_face) {
    // x = (1 − t²)/(1 + t²), y = 2t/(1 + t²): the quarter of a circle from (1, 0) to (0, 1).
    const control quarter{{1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    const weights w{1, 1, 2};
    // The plane x = 3/5 is met at t = 1/2, at y = 4/5.
    const control f0{{0.6, 0.75, -1}}, f1{{0.6, 0.75, 1}}, f2{{0.6, 2, 0}};
    const ccd::vertex_face_of<rational_curve> query{{quarter, w}, {f0}, {f1}, {f2}};
    const first_time found = ccd::time_of_impact(query);
    EXPECT_LE(found.low, 0.5 + 1e-15);
    EXPECT_GE(found.high, 0.5 - 1e-15);
    EXPECT_EQ(support::fault_of(query, found), "");
    // A vertex on the circle itself, and one that the circle misses by one rounding.
    const control on{{0, 1, 0}}, off{{0, std::nextafter(1, 2), 0}};
    using pair = ccd::vertex_vertex_of<rational_curve>;
    EXPECT_EQ(ccd::time_of_impact(pair{{quarter, w}, {on}}), at(1));
    EXPECT_EQ(ccd::time_of_impact(pair{{quarter, w}, {off}}), never);
    // All of the circle is at the distance 1 from its centre.
    const control centre{{0, 0, 0}};
    EXPECT_EQ(ccd::time_within(pair{{quarter, w}, {centre}}, {1}), at(0));
    EXPECT_EQ(ccd::time_within(pair{{quarter, w}, {centre}}, {std::nextafter(1, 0)}), never);
}
TEST(rational_curves, with_equal_weights_move_as_curves_without) {
    const control v{{0.25, 0.25, 3}, {0.25, 0.25, -5}, {0.25, 0.25, 3}};
    const control f0{{0, 0, 0}}, f1{{1, 0, 0}}, f2{{0, 1, 0}};
    for (const double weight : {1.0, 0.1, 1e-300, 1e300}) {
        const weights w{weight, weight, weight};
        const ccd::vertex_face_of<rational_curve> query{{v, w}, {f0}, {f1}, {f2}};
        EXPECT_EQ(ccd::time_of_impact(query), at(0.25));
        EXPECT_EQ(ccd::time_within(query, {0.5}),
                  ccd::time_within(ccd::vertex_face_curves{v, f0, f1, f2}, {0.5}));
    }
}
TEST(rational_curves, with_invalid_weights_are_refused) {
    const control v{{0, 0, 1}, {0, 0, -1}}, o{{0, 0, 0}};
    const auto fault = [&](const weights& w) {
        const rational_curve motion{v, w};
        EXPECT_EQ(ccd::time_of_impact(ccd::vertex_vertex_of<rational_curve>{motion, {o}}),
                  first_time{});
        EXPECT_EQ(ccd::decide_exact(ccd::vertex_vertex_of<rational_curve>{{o}, motion}).cause,
                  ccd::cause::range);
        return ccd::fault_of(motion);
    };
    EXPECT_EQ(fault({1, -1}), "weight 1 is -1.000000; expected a finite number > 0");
    EXPECT_EQ(fault({0, 1}), "weight 0 is 0.000000; expected a finite number > 0");
    EXPECT_EQ(fault({1, infinity}), "weight 1 is inf; expected a finite number > 0");
    EXPECT_EQ(fault({1}), "number of weights is 1; expected 2, one for each control point");
    EXPECT_EQ(ccd::fault_of({v, {}}), "");
}

// ---- Random curves ----

struct random_curves : random_motion::random_source {
    using random_source::random_source;
    std::array<control, 4> points;
    std::array<weights, 4> all_weights;

    /// Curves with 1 to `most` control points each.
    template <class Motion>
    std::array<Motion, 4> of_up_to(unsigned most) {
        std::array<Motion, 4> r;
        for (std::size_t i = 0; i < 4; ++i) {
            points[i].resize(1 + below(most));
            for (point& p : points[i]) p = position(3);
            if constexpr (std::is_same_v<Motion, ccd::curve>) {
                r[i] = points[i];
            } else {
                draw_weights(i);
                r[i] = {points[i], all_weights[i]};
            }
        }
        return r;
    }

  private:
    void draw_weights(std::size_t i) {
        all_weights[i].clear();
        if (i > 0 && below(3) == 0 && points[i].size() == points[i - 1].size())
            all_weights[i] = all_weights[i - 1];
        else if (below(4) != 0)
            for (std::size_t k = 0; k < points[i].size(); ++k)
                all_weights[i].push_back(on_grid ? 1 + below(4) : std::abs(number(1)) + 0.125);
    }
};

template <class Motion>
void expect_times_of_oracle(int contacts, int distances, unsigned most, unsigned seed) {
    random_motion::for_random_queries<random_curves>(contacts, seed, [&]<kind K>(auto& random) {
        const auto query = random_motion::query_of<K>(random.template of_up_to<Motion>(most));
        const double t_max = random.below(4) == 0 ? 0.5 : 1;
        EXPECT_EQ(support::fault_of(query, ccd::time_of_impact(query, t_max), t_max), "");
        EXPECT_EQ(ccd::decide_exact(query).outcome == outcome::collides, oracle::collides(query));
    });
    random_motion::for_random_queries<random_curves>(
        distances, seed + 1, [&]<kind K>(auto& random) {
            const auto query =
                random_motion::query_of<K>(random.template of_up_to<Motion>(most - 1));
            const separation d = random_motion::random_distance(random);
            const first_time found = ccd::time_within(query, d);
            EXPECT_EQ(support::fault_of(query, d, found), "");
            EXPECT_EQ(ccd::decide_within(query, d).outcome, found.outcome);
        });
}
TEST(random_curves, have_the_times_of_the_oracle) {
    expect_times_of_oracle<ccd::curve>(400, 150, 4, 3);
}
TEST(random_curves, with_weights_have_the_times_of_the_oracle) {
    expect_times_of_oracle<rational_curve>(150, 30, 3, 5);
}

}  // namespace
