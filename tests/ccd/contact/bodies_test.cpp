// Points of affine and rigid bodies. Cases made by hand, degenerate families and random queries are
// compared with the oracle.
#include <gtest/gtest.h>

#include <array>
#include <ccd/bodies/motion.hpp>
#include <ccd/contact.hpp>
#include <ccd/curves.hpp>
#include <ccd/exact.hpp>
#include <ccd/kind.hpp>
#include <cmath>
#include <cstddef>
#include <iostream>
#include <limits>
#include <numbers>
#include <optional>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "ccd/contact/rotation.hpp"
#include "ccd/contact/turning/body_filter.hpp"
#include "tests/ccd/bodies/positions.hpp"
#include "tests/ccd/contact/random_motion.hpp"
#include "tests/support/first_time_faults.hpp"
#include "tests/support/oracle_rational.hpp"
#include "tests/support/query_families.hpp"

namespace {

using by_hand::at;
using by_hand::infinity;
using by_hand::never;
using by_hand::point;
using ccd::affine_motion;
using ccd::body_motion;
using ccd::body_point;
using ccd::first_time;
using ccd::kind;
using ccd::outcome;
using ccd::quaternion;
using ccd::resting;
using ccd::rigid_motion;
using ccd::separation;
using random_motion::for_random_queries;
using random_motion::query_of;
using random_motion::random_distance;
using random_motion::random_source;

template <class Query>
void expect_first_time_of_oracle(const Query& query, double t_max = 1) {
    const first_time found = ccd::time_of_impact(query, t_max);
    EXPECT_EQ(support::fault_of(query, found, t_max), "");
    if (t_max < 1) return;
    EXPECT_EQ(ccd::decide_exact(query).outcome, found.outcome);
}

// ---- Bodies, by hand ----

body_point of(const body_motion& motion, const point& rest) {
    return {&motion, rest};
}
using vertex_face = ccd::vertex_face_of<body_point>;
using edge_edge = ccd::edge_edge_of<body_point>;
using vertex_edge = ccd::vertex_edge_of<body_point>;
using vertex_vertex = ccd::vertex_vertex_of<body_point>;

const body_motion still = resting{};
/// A quarter of a turn about z, by quaternions of small integers: (1, 0, 0, 0) to (1, 0, 0, 1).
const body_motion quarter = ccd::screw({0, 0, 1}, {0, 0, 0}, {0, 0, 0});

TEST(bodies, that_turn_about_z_meet_a_plane) {
    // (1, 0, 0) arrives at (0, 1, 0); x = (1 − t²)/(1 + t²) is 3/5 at t = 1/2.
    const vertex_face query{of(quarter, {1, 0, 0}), of(still, {0.6, 0, -1}),
                            of(still, {0.6, 2, -1}), of(still, {0.6, 1, 2})};
    expect_first_time_of_oracle(query);
    EXPECT_NEAR(ccd::time_of_impact(query).low, 0.5, 1e-15);
    // Exactly 3/5 = 0.6 needs a plane through it: with x = 3 for a radius of 5.
    const vertex_face exact{of(quarter, {5, 0, 0}), of(still, {3, 0, -1}), of(still, {3, 8, -1}),
                            of(still, {3, 4, 2})};
    EXPECT_EQ(ccd::time_of_impact(exact), at(0.5));
    EXPECT_EQ(ccd::time_of_impact(exact, 0.25), never);
    // The face turns instead, the other way.
    const body_motion back = ccd::screw({0, 0, -1}, {0, 0, 0}, {0, 0, 0});
    const vertex_face face_turns{of(still, {5, 0, 0}), of(back, {3, 0, -1}), of(back, {3, 8, -1}),
                                 of(back, {3, 4, 2})};
    EXPECT_EQ(ccd::time_of_impact(face_turns), at(0.5));
    EXPECT_EQ(ccd::time_within(face_turns, {2.25}), at(0));
    EXPECT_EQ(support::fault_of(face_turns, {2}, ccd::time_within(face_turns, {2})), "");
}
TEST(bodies, that_turn_sweep_more_than_the_hull_of_their_ends) {
    // A rod turns by a quarter about its end. Its other end leaves the triangle of its three ends.
    const vertex_vertex query{of(quarter, {5, 0, 0}), of(still, {3, 4, 0})};
    EXPECT_EQ(ccd::time_of_impact(query), at(0.5));
    EXPECT_EQ(ccd::decide_exact(
                  vertex_edge{of(still, {4, 3, 0}), of(quarter, {0, 0, 0}), of(quarter, {5, 0, 0})})
                  .outcome,
              outcome::collides);
}
TEST(bodies, with_invalid_motion_are_refused) {
    const auto fault = [&](const body_motion& m) {
        EXPECT_EQ(ccd::time_of_impact(vertex_vertex{of(m, {1, 0, 0}), of(still, {1, 0, 0})}),
                  first_time{});
        return ccd::fault_of(m);
    };
    const std::string rest =
        "; expected a number certainly > 0, so that the piece turns by less than half a turn";
    EXPECT_EQ(fault(rigid_motion{{1, 0, 0, 0}, {-1, 0, 0, 0}, {}, {}, {}}), "q0·q1 is -1" + rest);
    EXPECT_EQ(fault(rigid_motion{{1, 0, 0, 0}, {0, 0, 0, 1}, {}, {}, {}}), "q0·q1 is 0" + rest);
    EXPECT_EQ(fault(rigid_motion{{0, 0, 0, 0}, {0, 0, 0, 1}, {}, {}, {}}),
              "q0 is (0, 0, 0, 0); expected finite numbers, not all 0");
    EXPECT_EQ(fault(rigid_motion{{1, 0, 0, 0}, {0.5, std::nan(""), -infinity, 0}, {}, {}, {}}),
              "q1 is (0.5, nan, -inf, 0); expected finite numbers, not all 0");
    EXPECT_EQ(fault(rigid_motion{{}, {}, {infinity, 0, 0}, {}, {}}),
              "p0 is not finite; expected finite numbers");
    EXPECT_EQ(fault(affine_motion{.p0 = {}, .p1 = {0, infinity, 0}}),
              "p1 is not finite; expected finite numbers");
    EXPECT_EQ(ccd::fault_of(still), "");
    EXPECT_EQ(ccd::time_of_impact(vertex_vertex{{nullptr, {}}, of(still, {})}), first_time{});
    EXPECT_EQ(ccd::time_of_impact(vertex_vertex{of(still, {infinity, 0, 0}), of(still, {})}),
              first_time{});
}
TEST(bodies, take_the_shorter_arc) {
    const rigid_motion m = ccd::shorter_arc({{1, 0, 0, 0}, {}}, {{-1, 0, 0, -1}, {1, 2, 3}});
    EXPECT_EQ(m.q1, (quaternion{1, 0, 0, 1}));
    EXPECT_EQ(m.p1, (point{1, 2, 3}));
}
TEST(bodies, turn_by_quaternions_of_any_length) {
    const double smallest = std::numeric_limits<double>::denorm_min();
    for (const double a : {smallest, 1e-160, 1.0, 0x1p1023})
        for (const double b : {smallest, 1e-160, 1.0, 0x1p1023}) {
            const body_motion m = ccd::shorter_arc({{a, 0, 0, 0}, {}}, {{-b, 0, 0, -b}, {}});
            EXPECT_EQ(ccd::fault_of(m), "");
            const vertex_face query{of(m, {5, 0, 0}), of(still, {3, 0, -1}), of(still, {3, 8, -1}),
                                    of(still, {3, 4, 2})};
            EXPECT_EQ(support::fault_of(query, ccd::time_of_impact(query)), "") << a << ' ' << b;
        }
}
TEST(bodies, in_pieces_turn_by_any_angle) {
    // One and a half turns about z at (0, 0, 0), of the vertex (1, 0, 0): it passes −x at a third.
    const auto pieces = ccd::turn({}, {0, 0, 2}, 3 * std::numbers::pi, {0, 0, 0});
    ASSERT_EQ(pieces.size(), 6u);
    std::vector<body_motion> motions;
    for (const auto& piece : pieces) motions.emplace_back(piece.motion);
    std::vector<ccd::spline_piece<vertex_face>> queries;
    for (std::size_t i = 0; i < motions.size(); ++i) {
        EXPECT_EQ(ccd::fault_of(motions[i]), "");
        EXPECT_EQ(pieces[i].motion.q0, i == 0 ? quaternion{} : pieces[i - 1].motion.q1);
        EXPECT_EQ(pieces[i].from, i == 0 ? 0 : pieces[i - 1].to);
        queries.push_back({pieces[i].from,
                           pieces[i].to,
                           {of(motions[i], {1, 0, 0}), of(still, {-2, 0, -1}),
                            of(still, {0, 0, -1}), of(still, {-1, 0, 1})}});
    }
    const auto found = ccd::first_time_of_pieces(queries);
    EXPECT_EQ(found.outcome, outcome::collides);
    EXPECT_NEAR(found.low, 1 / 3.0, 1e-14);
    EXPECT_EQ(ccd::turn({}, {0, 0, 0}, 9, {1, 0, 0}).size(), 1u);
    EXPECT_EQ(ccd::turn({}, {0, 0, 1}, 0, {1, 0, 0})[0].motion.q1, quaternion{});
}
TEST(bodies, turn_about_axes_of_any_length) {
    const auto end = [](const point& axis) { return ccd::turn({}, axis, 1.25, {})[0].motion.q1; };
    const quaternion expected = end({1, -1, 0.5});
    for (const double length : {0x1p1023, 0x1p600, 0x1p-600, 0x1p-1073})
        EXPECT_EQ(end({length, -length, length / 2}), expected) << length;
}
TEST(bodies, turn_by_finite_angles_about_finite_axes) {
    const auto expect_refused = [](const point& axis, double angle) {
        const auto pieces = ccd::turn({}, axis, angle, {});
        ASSERT_EQ(pieces.size(), 1u);
        EXPECT_NE(ccd::fault_of(pieces[0].motion), "");
    };
    for (const double x : {infinity, -infinity, std::nan("")}) {
        expect_refused({0, 0, 1}, x);
        expect_refused({0, 0, x}, 1);
        expect_refused({x, 1, 0}, 1);
    }
    EXPECT_THROW(ccd::turn({}, {0, 0, 1}, 1e300, {}), std::length_error);
}

// ---- Limits: motion without rotation ----

template <class Linear, class Query>
void expect_as_linear(const Linear& linear, const Query& query) {
    EXPECT_EQ(ccd::time_of_impact(query), ccd::time_of_impact(linear));
    EXPECT_EQ(ccd::decide_exact(query).outcome, ccd::decide_exact(linear).outcome);
    for (const double d : {0.125, 0.75})
        EXPECT_EQ(ccd::time_within(query, {d, 1e-9}), ccd::time_within(linear, {d, 1e-9}));
}
TEST(bodies, that_only_move_along_lines_have_the_times_of_linear_motion) {
    std::mt19937 random(1);
    const auto whole = [&] { return static_cast<double>(random() % 9) - 4; };
    const auto position = [&] { return point{whole(), whole(), whole()}; };
    for (int i = 0; i < support::scaled(200); ++i) {
        const point p0 = position(), p1 = position();
        // One translation as four motions: without rotation; with half a turn about z at both ends;
        // with the identity as its matrix; with another matrix.
        const std::array<body_motion, 4> motions{
            rigid_motion{{1, 0, 0, 0}, {2, 0, 0, 0}, p0, p1, {}},
            rigid_motion{{0, 0, 0, 3}, {0, 0, 0, 3}, p0, p1, {}}, affine_motion{.p0 = p0, .p1 = p1},
            affine_motion{{{{-1, 0, 0}, {0, -1, 0}, {0, 0, 1}}},
                          {{{2, 0, 0}, {0, 1, 3}, {0, 0, 1}}},
                          p0,
                          p1}};
        std::array<point, 4> x;
        for (point& p : x) p = position();
        for (const body_motion& motion : motions) {
            const auto moving = [&](const point& p) -> ccd::moving_point<double> {
                if (const auto* a = std::get_if<affine_motion>(&motion)) return rounded_ends(*a, p);
                const double s = std::get<rigid_motion>(motion).q0.z != 0 ? -1 : 1;
                return {{s * p.x + p0.x, s * p.y + p0.y, p.z + p0.z},
                        {s * p.x + p1.x, s * p.y + p1.y, p.z + p1.z}};
            };
            // One feature moves, the other rests.
            ccd::for_each_kind([&]<kind K>() {
                for (const bool first_moves : {false, true}) {
                    std::array<ccd::moving_point<double>, 4> linear;
                    std::array<body_point, 4> of_bodies;
                    for (std::size_t k = 0; k < 4; ++k) {
                        const bool is_first = k < ccd::kind_traits<K>::first_vertices;
                        const bool moves = is_first == first_moves;
                        linear[k] = moves ? moving(x[k]) : by_hand::still(x[k]);
                        of_bodies[k] = of(moves ? motion : still, x[k]);
                    }
                    expect_as_linear(
                        query_families::as_query<
                            typename ccd::kind_traits<K>::template query<double>>(linear),
                        query_of<K>(of_bodies));
                }
            });
        }
    }
}
TEST(bodies, about_the_poses_as_given_differ_from_rounded_ends) {
    // 0.1·3 − 0.3 is not 0 in exact numbers, but its rounding 5.55e-17 is not its value either.
    const affine_motion m{{{{0.1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
                          {{{0.1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
                          {-0.3, 0, 1},
                          {-0.3, 0, -1}};
    const body_motion motion = m;
    const auto ends = ccd::rounded_ends(m, {3, 0, 0});
    EXPECT_EQ(ends.t0.x, 0.1 * 3 - 0.3);
    const point o{ends.t0.x, 0, 0};
    EXPECT_EQ(ccd::decide_exact(ccd::vertex_vertex<double>{ends, by_hand::still(o)}).outcome,
              outcome::collides);
    EXPECT_EQ(ccd::decide_exact(vertex_vertex{of(motion, {3, 0, 0}), of(still, o)}).outcome,
              outcome::separate);
}

// ---- Degenerate families ----

TEST(degenerate_bodies, that_roll_touch_the_plane_all_the_time) {
    // A polygon inscribed in a wheel of radius 5 turns about its axis: no rolling without slip has
    // rational speed, but each vertex touches the plane z = −5 with a double root.
    const body_motion wheel = ccd::screw({0, 1, 0}, {0, 0, 0}, {4, 0, 0});
    const std::array<point, 3> plane{{{-99, -99, -5}, {99, -99, -5}, {0, 99, -5}}};
    // Angles whose tangent of the half is rational: (3, 4), (4, 3), (0, 5).
    for (const point& rim :
         {point{3, 0, -4}, point{4, 0, -3}, point{5, 0, 0}, point{-3, 0, -4}, point{0, 0, -5}}) {
        const vertex_face query{of(wheel, rim), of(still, plane[0]), of(still, plane[1]),
                                of(still, plane[2])};
        expect_first_time_of_oracle(query);
        const edge_edge rim_edge{of(wheel, {rim.x, -1, rim.z}), of(wheel, {rim.x, 1, rim.z}),
                                 of(still, {-9, 0, -5}), of(still, {9, 0, -5})};
        expect_first_time_of_oracle(rim_edge);
        // One rounding higher or lower decides.
        const vertex_face below{of(wheel, rim), of(still, {-99, -99, std::nextafter(-5, -6)}),
                                of(still, {99, -99, std::nextafter(-5, -6)}),
                                of(still, {0, 99, std::nextafter(-5, -6)})};
        EXPECT_EQ(ccd::time_of_impact(below), never);
        expect_first_time_of_oracle(below);
    }
}
TEST(degenerate_bodies, that_spin_about_an_axis_through_the_contact_touch_from_the_start) {
    const body_motion spin = ccd::screw({1, 2, 3}, {1, 1, 1}, {1, 1, 1});
    const vertex_face at_vertex{of(spin, {1, 1, 1}), of(still, {1, 1, 1}), of(still, {2, 0, 1}),
                                of(still, {3, 1, 7})};
    EXPECT_EQ(ccd::time_of_impact(at_vertex), at(0));
    // The vertex lies on the axis and never moves; a plane hits it, or misses it by one rounding.
    const vertex_vertex on_axis{of(spin, {2, 3, 4}), of(still, {2, 3, 4})};
    EXPECT_EQ(ccd::time_of_impact(on_axis), at(0));
    const vertex_vertex beside{of(spin, {2, 3, 4}), of(still, {2, 3, std::nextafter(4, 5)})};
    EXPECT_EQ(ccd::time_of_impact(beside), never);
    // An edge through the axis point sweeps a cone; a second edge meets only its apex.
    const edge_edge apex{of(spin, {1, 1, 1}), of(spin, {4, 1, 1}), of(still, {1, 1, 1}),
                         of(still, {0, -1, -3})};
    EXPECT_EQ(ccd::time_of_impact(apex), at(0));
}
TEST(degenerate_bodies, that_are_teeth_of_gears) {
    // Two wheels with centres 10 apart turn in opposite directions; their rims of radius 5 touch
    // at (5, 0, z) at all times, so points of both rims that arrive there together touch.
    const body_motion left = ccd::screw({0, 0, 1}, {0, 0, 0}, {0, 0, 0});
    const body_motion right = ccd::screw({0, 0, -1}, {10, 0, 0}, {10, 0, 0});
    // At t = 1/2, (3, −4) on the left and (7, −4) on the right arrive at (5, 0).
    const vertex_vertex teeth{of(left, {3, -4, 0}), of(right, {7, -4, 0})};
    EXPECT_EQ(ccd::time_of_impact(teeth), at(0.5));
    const edge_edge axles{of(left, {3, -4, -1}), of(left, {3, -4, 1}), of(right, {7, -4, 0}),
                          of(right, {7, -4, 3})};
    EXPECT_EQ(ccd::time_of_impact(axles), at(0.5));
    expect_first_time_of_oracle(axles);
    const edge_edge apart{of(left, {3, -4, -1}), of(left, {3, -4, 1}),
                          of(right, {std::nextafter(7, 8), -4, 0}),
                          of(right, {std::nextafter(7, 8), -4, 3})};
    EXPECT_EQ(ccd::time_of_impact(apart), never);
}
// ---- Random numbers ----

class random_bodies : public random_source {
  public:
    using random_source::random_source;

    quaternion rotation() {
        if (flat) return {number(3), 0, 0, number(3)};
        return {number(3), number(3), number(3), number(3)};
    }
    rigid_motion rigid() {
        rigid_motion m;
        do {
            m = ccd::shorter_arc({rotation(), position(3)}, {rotation(), position(3)});
            if (below(4) == 0) {  // lengths of quaternions do not matter, except for the speed
                const int size = static_cast<int>(below(1000)) - 500;
                for (double* x : {&m.q0.w, &m.q0.x, &m.q0.y, &m.q0.z}) *x = std::ldexp(*x, size);
                const int other = size + static_cast<int>(below(40)) - 20;
                for (double* x : {&m.q1.w, &m.q1.x, &m.q1.y, &m.q1.z}) *x = std::ldexp(*x, other);
            }
        } while (!ccd::fault_of(m).empty());
        if (below(3) == 0) m.centre = position(2);
        if (below(3) == 0) m.p1 = m.p0;
        return m;
    }
    affine_motion affine() {
        affine_motion m{{}, {}, position(3), position(3)};
        for (auto* a : {&m.a0, &m.a1})
            for (auto& row : *a)
                for (double& x : row) x = number(1);
        if (flat)
            for (auto* a : {&m.a0, &m.a1}) (*a)[2] = {0, 0, 1};
        return m;
    }
    rigid_motion screw() {
        constexpr std::array sizes{1.0, 1.0, 0x1p-6, 0x1p-6, 0x1p-6, 0x1p-40, 0x1p-600};
        const double shorter = sizes[below(7)];  // 2^-6: less than 0.1 rad
        const point d{shorter * number(2), shorter * number(2), shorter * number(2)};
        if (flat) return ccd::screw({0, 0, d.z}, position(2), position(3));
        return ccd::screw(d, position(2), position(3));
    }
    enum class style { affine, interpolated, screw, any };
    body_motion motion(style s) {
        switch (s) {
            case style::affine:
                return affine();
            case style::interpolated:
                return rigid();
            case style::screw:
                return screw();
            default:
                return motion(static_cast<style>(below(3)));
        }
    }
    /// Points of two bodies, one for each feature; if `mixed`, of four bodies.
    template <kind K>
    std::array<body_point, 4> points(const std::array<body_motion, 4>& motions, bool mixed) {
        std::array<body_point, 4> p;
        for (std::size_t i = 0; i < 4; ++i) {
            const std::size_t feature = i < ccd::kind_traits<K>::first_vertices ? 0 : 1;
            p[i] = {&motions[mixed ? i : feature], position(2)};
        }
        return p;
    }
    /// Draws motions of one style, some at rest.
    std::array<body_motion, 4> motions(style s) {
        std::array<body_motion, 4> all{motion(s), motion(s), motion(s), motion(s)};
        if (below(4) == 0) all[below(2)] = resting{};
        return all;
    }
};

/// True unless ERRBOUND_TEST_SCALE reduces the counts.
bool is_whole_run() {
    return support::scaled(100) >= 100;
}
void expect_times_of_oracle(random_bodies::style style, unsigned seed) {
    std::array<std::size_t, 4> queries{}, contacts{};
    for_random_queries<random_bodies>(30, seed, [&]<kind K>(auto& random) {
        const auto motions = random.motions(style);
        const auto query = query_of<K>(random.template points<K>(motions, random.below(8) == 0));
        expect_first_time_of_oracle(query, random.below(4) == 0 ? 0.5 : 1);
        ++queries[static_cast<std::size_t>(K)];
        contacts[static_cast<std::size_t>(K)] +=
            ccd::decide_exact(query).outcome == outcome::collides;
    });
    if (is_whole_run()) {
        EXPECT_GT(contacts[0], 0u);
    }
    for (std::size_t k = 0; k < 4; ++k)
        std::cout << queries[k] << " queries of kind " << k << ", " << contacts[k] << " contacts\n";
}
TEST(random_body_queries, of_affine_bodies_touch_first_at_the_time_of_the_oracle) {
    expect_times_of_oracle(random_bodies::style::affine, 3);
}
TEST(random_body_queries, of_interpolated_poses_touch_first_at_the_time_of_the_oracle) {
    expect_times_of_oracle(random_bodies::style::interpolated, 4);
}
TEST(random_body_queries, of_screws_touch_first_at_the_time_of_the_oracle) {
    expect_times_of_oracle(random_bodies::style::screw, 5);
}
TEST(random_body_queries, of_mixed_motions_touch_first_at_the_time_of_the_oracle) {
    expect_times_of_oracle(random_bodies::style::any, 6);
}
// ---- Filters, by themselves ----

/// The queries that each filter decided.
struct filter_counts {
    int axes = 0, far = 0, separate = 0, collides = 0, uncertain = 0;
};
template <kind K>
void expect_decisions_of_oracle(random_bodies& random, filter_counts& counts) {
    const auto motions = random.motions(random_bodies::style::any);
    const auto query = query_of<K>(random.template points<K>(motions, false));
    const auto points = points_of(query);
    const ccd::detail::motion_chords a(*points.front().motion), b(*points.back().motion);
    const ccd::detail::body_filter<K> filter(points, a, b);
    const bool touches = oracle::collides(query);
    if (filter.separated(0)) {
        ++counts.axes;
        EXPECT_FALSE(touches);
        const double d = std::ldexp(1 + random.below(2), random.scale);
        if (random.below(4) == 0 && filter.separated(d)) {
            ++counts.far;
            EXPECT_FALSE(oracle::within(query, d, 0));
        }
    }
    if constexpr (ccd::is_cubic(K)) {
        ccd::detail::touching_interval part;
        const outcome found = filter.decide(&part);
        if (found == outcome::uncertain) ++counts.uncertain;
        if (found == outcome::separate) {
            ++counts.separate;
            EXPECT_FALSE(touches);
        }
        if (found != outcome::collides) return;
        ++counts.collides;
        EXPECT_TRUE(touches);
        EXPECT_TRUE(part.low == 0 ||
                    !oracle::collides(query, oracle::shortcuts::on, {0, part.low}));
        EXPECT_TRUE(oracle::collides(query, oracle::shortcuts::on, {part.low, part.high}));
    }
}
TEST(random_body_queries, pass_filters_that_agree_with_the_oracle) {
    filter_counts all;
    for_random_queries<random_bodies>(
        60, 8, [&]<kind K>(auto& random) { expect_decisions_of_oracle<K>(random, all); });
    std::cout << "axes " << all.axes << ", axes with a distance " << all.far << "; signs: separate "
              << all.separate << ", collides " << all.collides << ", uncertain " << all.uncertain
              << '\n';
    if (!is_whole_run()) return;
    for (const int count : {all.axes, all.far, all.separate, all.collides}) EXPECT_GT(count, 0);
}

using support::position_at;
using support::rational;

/// Checks the bound of ccd/contact/turning/chords.cpp at a time, as a share of the interval between
/// two times. Returns the bound divided by the distance of the chord, or 0 if the bound is
/// infinite.
double expect_error_of_chord(const body_motion& motion, double from, double to, double share,
                             const point& rest) {
    const ccd::detail::motion_chords chords(motion, from, to);
    const point y{rest.x - chords.centre.x, rest.y - chords.centre.y, rest.z - chords.centre.z};
    const auto [start, end] = chords.ends_of(y);
    const double bound = chords.error_of(std::abs(y.x) + std::abs(y.y) + std::abs(y.z));
    if (!(bound < infinity)) return 0;
    const auto x = position_at(motion, rest,
                               rational(from) + rational(share) * (rational(to) - rational(from)));
    const auto on_chord = [&](double a, double b) {
        return (1 - rational(share)) * rational(a) + rational(share) * rational(b);
    };
    const rational dx = x[0] - on_chord(start.x, end.x), dy = x[1] - on_chord(start.y, end.y),
                   dz = x[2] - on_chord(start.z, end.z);
    const rational squared = dx * dx + dy * dy + dz * dz;
    EXPECT_LE(squared, rational(bound) * rational(bound));
    return squared == 0
               ? infinity
               : std::sqrt(static_cast<double>(rational(bound) * rational(bound) / squared));
}
TEST(motion_chords, have_errors_within_their_bounds) {
    random_bodies random(9);
    int bounded = 0, all = 0;
    double least = infinity;
    for (int i = 0; i < support::scaled(500); ++i) {
        SCOPED_TRACE("motion " + std::to_string(i));
        random.draw_style();
        for (const body_motion& motion : {body_motion(random.rigid()), body_motion(random.screw()),
                                          body_motion(random.affine())})
            for (const auto& [from, to] : {std::pair(0.0, 1.0), {0.0, 0.5}, {0.375, 0.5}}) {
                const double ratio = expect_error_of_chord(
                    motion, from, to, std::ldexp(random.below(17), -4), random.position(2));
                bounded += ratio > 0;
                ++all;
                if (ratio > 0) least = std::min(least, ratio);
            }
    }
    std::cout << bounded << " of " << all << " bounds are finite, the tightest " << least
              << " times the distance\n";
    EXPECT_GT(bounded, all / 2);
    if (is_whole_run()) {
        EXPECT_LT(least, 2);
    }
    // Close to half a turn, and at the middle of a turn by 90 degrees.
    const double half = expect_error_of_chord(
        rigid_motion{{1, 0, 0, 0}, {0x1p-20, 0, 0, 1}, {}, {}, {}}, 0, 1, 0.5, {1, 0, 0});
    EXPECT_GT(half, 1);
    EXPECT_LT(half, 3);
    EXPECT_LT(expect_error_of_chord(quarter, 0, 1, 0.5, {1, 0, 0}), 2);
}
TEST(random_body_queries, of_prepared_motions_have_the_same_times) {
    for_random_queries<random_bodies>(30, 10, []<kind K>(auto& random) {
        const auto motions = random.motions(random_bodies::style::any);
        const std::array prepared{
            ccd::prepared_motion(motions[0]), ccd::prepared_motion(motions[1]),
            ccd::prepared_motion(motions[2]), ccd::prepared_motion(motions[3])};
        const auto points = random.template points<K>(motions, random.below(8) == 0);
        auto same = points;
        for (body_point& p : same)
            p = prepared[static_cast<std::size_t>(p.motion - &motions[0])].at(p.rest);
        EXPECT_EQ(ccd::time_of_impact(query_of<K>(same)), ccd::time_of_impact(query_of<K>(points)));
        const separation d = random_distance(random);
        EXPECT_EQ(ccd::time_within(query_of<K>(same), d), ccd::time_within(query_of<K>(points), d));
    });
}

TEST(random_body_queries, come_near_first_at_the_time_of_the_oracle) {
    for_random_queries<random_bodies>(8, 7, []<kind K>(auto& random) {
        const auto motions = random.motions(random_bodies::style::any);
        const auto query = query_of<K>(random.template points<K>(motions, random.below(8) == 0));
        const separation d = random_distance(random);
        EXPECT_EQ(support::fault_of(query, d, ccd::time_within(query, d)), "");
    });
}

}  // namespace
