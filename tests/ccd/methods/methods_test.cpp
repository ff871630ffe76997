// The methods of the comparison: known lost collisions, and the root finder of `provot`.
// property_test has the promises of all methods, stress_test their answers for NaN and infinity.
#include <gtest/gtest.h>

#include <algorithm>
#include <ccd/method.hpp>
#include <ccd/methods/provot.hpp>
#include <ccd/methods/transform.hpp>
#include <cmath>
#include <errbound/roots/floating_roots.hpp>
#include <limits>
#include <random>

namespace {

using ccd::edge_edge;
using ccd::method;
using ccd::outcome;
using ccd::vertex_face;

// ---- The root finder ----

template <class T>
class guarded_newton : public testing::Test {};
using number_types = testing::Types<float, double>;
TYPED_TEST_SUITE(guarded_newton, number_types);

template <class T>
errbound::bernstein<T, 3> with_roots(T a, T b, T c) {
    return {-a * b * c, a * b + a * c + b * c, -(a + b + c), 1};
}

TYPED_TEST(guarded_newton, pieces_are_monotone_and_roots_are_found) {
    using T = TypeParam;
    std::mt19937_64 random(1);
    const auto number = [&random] { return T(std::ldexp(double(random() >> 11), -52)) - T(0.5); };
    int found = 0;
    for (int i = 0; i < 2000; ++i) {
        const auto f = with_roots<T>(number(), number(), number());
        const auto pieces = errbound::roots::monotone_pieces(f);
        ASSERT_EQ(pieces.at[0], 0);
        ASSERT_EQ(pieces.at[pieces.count - 1], 1);
        for (std::size_t p = 1; p < pieces.count; ++p) {
            const T low = pieces.at[p - 1], high = pieces.at[p];
            ASSERT_LE(low, high);
            const T at_low = value_at(f, T(1), low), at_high = value_at(f, T(1), high);
            for (int part = 1; part < 8; ++part) {
                const T inside = value_at(f, T(1), T(low + (high - low) * T(part) / 8));
                const T slack = 16 * std::numeric_limits<T>::epsilon();
                EXPECT_GE(inside, std::min(at_low, at_high) - slack);
                EXPECT_LE(inside, std::max(at_low, at_high) + slack);
            }
            if (!(at_low * at_high < 0)) continue;
            const T root = errbound::roots::guarded_newton(f, low, high);
            EXPECT_GE(root, low);
            EXPECT_LE(root, high);
            EXPECT_LE(std::abs(value_at(f, T(1), root)), 16 * std::numeric_limits<T>::epsilon());
            ++found;
        }
    }
    EXPECT_GT(found, 2000);
}

TYPED_TEST(guarded_newton, degrees_below_three) {
    using T = TypeParam;
    const auto count = [](const errbound::bernstein<T, 3>& f) {
        return errbound::roots::monotone_pieces(f).count;
    };
    EXPECT_EQ(count({T(-1), T(4), T(-4), 0}), 3U);  // turns at 1/2
    EXPECT_EQ(
        errbound::roots::monotone_pieces(errbound::bernstein<T, 3>{T(-1), T(4), T(-4), 0}).at[1],
        T(0.5));
    EXPECT_EQ(count({T(-1), T(4), 0, 0}), 2U);
    EXPECT_EQ(count({T(1), 0, 0, 0}), 2U);
    EXPECT_EQ(count({0, 0, 0, 0}), 2U);
    EXPECT_EQ(count({0, 0, 0, T(1)}), 2U);           // t³ turns at 0, which is an end
    EXPECT_EQ(count({0, 0, T(-1), T(1)}), 3U);       // t³ − t² also turns at 2/3
    EXPECT_EQ(count({0, T(3), T(-7.5), T(5)}), 4U);  // 15t² − 15t + 3 at 0.28 and 0.72
    EXPECT_EQ(
        errbound::roots::guarded_newton(errbound::bernstein<T, 3>{T(-1), T(4), 0, 0}, T(0), T(1)),
        T(0.25));
}

// ---- Queries with known contacts ----

// The plane z = s·x, s from 1 to −1, under a vertex that moves with x = −s: the vertex is at height
// z_v + s² above the plane. With z_v = −1/4 it is below the plane for |s| < 1/2: it enters at t =
// 1/4 and leaves at t = 3/4.
constexpr ccd::moving_point<double> crossing_point(double y, double z0, double z1) {
    return {{-1, y, z0}, {1, y, z1}};
}
constexpr vertex_face<double> over_tilting_face(double z0, double z1) {
    return {.v = crossing_point(0, z0, z1),
            .f0 = {{-4, -4, -4}, {-4, -4, 4}},
            .f1 = {{4, -4, 4}, {4, -4, -4}},
            .f2 = {{0, 8, 0}, {0, 8, 0}}};
}
constexpr edge_edge<double> over_tilting_edge(double z0, double z1) {
    return {.a0 = crossing_point(-1, z0, z1),
            .a1 = crossing_point(1, z0, z1),
            .b0 = {{-4, 0, -4}, {-4, 0, 4}},
            .b1 = {{4, 0, 4}, {4, 0, -4}}};
}

TEST(root_parity, misses_a_vertex_that_goes_in_and_out_again) {
    const auto in_and_out = [](const auto& query) {
        EXPECT_EQ(decide(method::exact, query).outcome, outcome::collides);
        EXPECT_EQ(decide(method::root_parity, query).outcome, outcome::separate);
    };
    in_and_out(over_tilting_face(-0.25, -0.25));
    in_and_out(over_tilting_edge(-0.25, -0.25));
    in_and_out(over_tilting_face(0, 0));  // a touch at t = 1/2: a double root
    in_and_out(over_tilting_edge(0, 0));
}

TEST(root_parity, finds_an_odd_number) {
    const auto found = [](const auto& query) {
        EXPECT_EQ(decide(method::exact, query).outcome, outcome::collides);
        EXPECT_EQ(decide(method::root_parity, query).outcome, outcome::collides);
    };
    found(over_tilting_face(-0.25, -2));
    found(over_tilting_edge(-0.25, -2));
}

// The vertex slides in the face's plane: Y is zero throughout, and no vertex meets an edge.
TEST(methods, contact_of_coplanar_motion_inside_the_face) {
    const vertex_face<double> query{.v = {{1, 1, 0}, {2, 1, 0}},
                                    .f0 = {{0, 0, 0}, {0, 0, 0}},
                                    .f1 = {{4, 0, 0}, {4, 0, 0}},
                                    .f2 = {{0, 4, 0}, {0, 4, 0}}};
    for (const ccd::method_info& m : ccd::methods()) {
        if (m.may_lose_collisions) continue;
        EXPECT_TRUE(ccd::may_collide(ccd::decide(m.method, query))) << m.name;
    }
    for (const method m : {method::bsc_exact, method::root_parity, method::provot})
        EXPECT_EQ(decide(m, query).outcome, outcome::collides) << ccd::info(m).name;
}

TEST(provot, has_no_fallback_for_degenerate_features) {
    // A vertex falls onto a triangle that is a segment.
    const vertex_face<double> query{.v = {{1, 0, 1}, {1, 0, -1}},
                                    .f0 = {{0, 0, 0}, {0, 0, 0}},
                                    .f1 = {{4, 0, 0}, {4, 0, 0}},
                                    .f2 = {{2, 0, 0}, {2, 0, 0}}};
    EXPECT_EQ(decide(method::exact, query).outcome, outcome::collides);
    EXPECT_EQ(decide(method::provot, query).outcome, outcome::separate);
}

TEST(provot, in_float_as_in_double) {
    const auto same = [](const auto& query, outcome expected) {
        const auto narrow = ccd::transformed(query, [](double x) { return static_cast<float>(x); });
        EXPECT_EQ(ccd::decide_provot(query).outcome, expected);
        EXPECT_EQ(ccd::decide_provot(narrow).outcome, expected);
    };
    same(over_tilting_face(-0.25, -0.25), outcome::collides);
    same(over_tilting_edge(-0.25, -2), outcome::collides);
    same(over_tilting_face(0.25, 0.5), outcome::separate);
    same(over_tilting_edge(0.25, 0.5), outcome::separate);
}

}  // namespace
