// The adapter for Tight-Inclusion, in cases made by hand and compared with the oracle on all
// families of queries.
#include <gtest/gtest.h>

#include <algorithm>
#include <ccd/adapters/tight_inclusion.hpp>
#include <ccd/methods/transform.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <tight_inclusion/ccd.hpp>

#include "tests/ccd/adapters/adapter_faults.hpp"
#include "tests/support/query_families.hpp"
#include "tests/support/scaled.hpp"
#include "tests/support/special_values.hpp"

namespace {

namespace adapter = ccd::adapters::tight_inclusion;
using support::across, support::answer, support::at, support::infinity, support::never;
using support::onto_face, support::still;

// Each call has the original's type, except for the type of the method.
[[maybe_unused]] ticcd::call<double, adapter::CCDRootFindingMethod>* const calls_in_double[] = {
    adapter::vertexFaceCCD, adapter::edgeEdgeCCD};
[[maybe_unused]] ticcd::call<float, adapter::CCDRootFindingMethod>* const calls_in_float[] = {
    adapter::vertexFaceCCD, adapter::edgeEdgeCCD};

template <class T>
Eigen::Matrix<T, 3, 1> as_vector(const ccd::point<double>& p) {
    return Eigen::Vector3d(p.x, p.y, p.z).cast<T>();
}

template <class T = double, class Query>
answer<T> ask(const Query& query, T ms = 0, T t_max = 1, bool no_zero_toi = false) {
    const auto points = ccd::points_of(query);
    const auto t0 = [&](std::size_t i) { return as_vector<T>(points[i].t0); };
    const auto t1 = [&](std::size_t i) { return as_vector<T>(points[i].t1); };
    const Eigen::Array<T, 3, 1> err(-1, -1, -1);
    const T tolerance = T(1e-6);
    T toi = -1, output_tolerance = -1;
    const auto call = [&](const auto& function) {
        return function(t0(0), t0(1), t0(2), t0(3), t1(0), t1(1), t1(2), t1(3), err, ms, toi,
                        tolerance, t_max, 1000, output_tolerance, no_zero_toi);
    };
    const bool collides = ccd::kind_of<Query> == ccd::kind::vertex_face
                              ? call([](auto&&... x) { return adapter::vertexFaceCCD(x...); })
                              : call([](auto&&... x) { return adapter::edgeEdgeCCD(x...); });
    EXPECT_EQ(output_tolerance, tolerance);
    return {collides, toi};
}

TEST(calls, find_first_contacts) {
    EXPECT_EQ(ask(onto_face), at(0.25));
    EXPECT_EQ(ask(across), at(0.25));
    EXPECT_EQ(ask(onto_face, 0.0, 0.25), at(0.25));
    EXPECT_EQ(ask(onto_face, 0.0, std::nextafter(0.25, 0)), never);
}
TEST(calls, take_expressions_and_defaults) {
    Eigen::Matrix<double, 8, 3> v;
    v << 0.25, 0.25, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0,  //
        0.25, 0.25, -3, 0, 0, 0, 1, 0, 0, 0, 1, 0;
    double toi = 0, output_tolerance = 0;
    EXPECT_TRUE(adapter::vertexFaceCCD(v.row(0), v.row(1), v.row(2), v.row(3), v.row(4), v.row(5),
                                       v.row(6), v.row(7), Eigen::Array3d::Constant(-1), 0, toi,
                                       1e-6, 1, 1000000, output_tolerance, false,
                                       adapter::CCDRootFindingMethod::DEPTH_FIRST_SEARCH));
    EXPECT_EQ(toi, 0.25);
    EXPECT_EQ(output_tolerance, 1e-6);
}
TEST(calls, keep_the_box_of_a_minimum_separation_free) {
    // A box of half width 0.5 has a half diagonal of 0.866.
    const double toi = ask(onto_face, 0.5).toi;
    EXPECT_NEAR(toi, (1 - std::sqrt(0.75)) / 4, 1e-15);
    // A vertex that passes a corner of the box around another vertex, on its diagonal.
    const auto passing = [](double offset) {
        const ccd::moving_point<double> v{{offset, offset, 5}, {offset, offset, -5}};
        const auto f = still({0, 0, 0});
        return ccd::vertex_face<double>{v, f, f, f};
    };
    EXPECT_TRUE(ask(passing(0.5), 0.5).collides);
    EXPECT_EQ(ask(passing(0.7), 0.5), never);
}
TEST(calls, return_0_if_near_at_the_start_unless_zero_times_are_off) {
    EXPECT_EQ(ask(onto_face, 1.0), at(0));
    EXPECT_EQ(ask(onto_face, 1.0, 1.0, true), at(0.25));
    EXPECT_EQ(ask(onto_face, 1.0, 0.125, true), never);
    EXPECT_EQ(ask(onto_face, 0.1, 1.0, true), ask(onto_face, 0.1));
    const ccd::vertex_face<double> touching{still({0.25, 0.25, 0}), onto_face.f0, onto_face.f1,
                                            onto_face.f2};
    EXPECT_EQ(ask(touching, 0.0, 1.0, true), at(0)) << "it touches";
}
TEST(calls, return_0_for_invalid_numbers) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(ask(onto_face, nan), at(0));
    EXPECT_EQ(ask(onto_face, infinity), at(0));
    EXPECT_EQ(ask(onto_face, -1.0), at(0));
    EXPECT_EQ(ask(onto_face, 0.0, nan, true), at(0));
    ccd::vertex_face<double> query = onto_face;
    query.v.t1.z = -infinity;
    EXPECT_EQ(ask(query, 0.5, 1.0, true), at(0));
}
TEST(calls, in_float_round_times_down) {
    const ccd::vertex_face<double> query{
        {{0.25, 0.25, 1}, {0.25, 0.25, -2}}, onto_face.f0, onto_face.f1, onto_face.f2};
    const answer<float> a = ask<float>(query);
    EXPECT_TRUE(a.collides);
    EXPECT_EQ(a.toi, std::nextafter(float(1. / 3), 0.f)) << "which rounds to above 1 / 3";
    EXPECT_EQ(ask<float>(query, 0, a.toi).collides, false);
}

/// The ball contains the box and is at most two last places larger.
TEST(calls, use_the_ball_around_the_box) {
    std::mt19937_64 random(18);
    const auto check = [](double ms) {
        const ccd::separation d = adapter::detail::ball_around_box(ms);
        const rational whole = exactly(d.first) + exactly(d.second), box = exactly(ms);
        EXPECT_TRUE(std::isfinite(d.first) && std::isfinite(d.second)) << ms;
        EXPECT_GE(whole * whole, 3 * box * box) << ms;
        const double less = std::nextafter(std::nextafter(d.second, 0), 0);
        const rational lower = exactly(d.first) + exactly(less);
        EXPECT_TRUE(ms == 0 || lower * lower < 3 * box * box) << ms;
    };
    for (int i = 0; i < support::scaled(10000); ++i) check(std::abs(special_value<double>(random)));
    for (int i = 0; i < 1000; ++i) check(i * std::numeric_limits<double>::denorm_min());
    check(std::numeric_limits<double>::max());
    EXPECT_EQ(adapter::detail::ball_around_box(0).second, 0);
}

template <class T, class Query>
std::string fault(const Query& query, T ms, T t_max, const answer<T>& a) {
    return support::answer_fault(query, adapter::detail::ball_around_box(ms), a.collides, a.toi,
                                 t_max);
}

/// A query with coordinates rounded to floats, unless that overflows.
template <class Query>
Query in_float(const Query& query) {
    return ccd::transformed(query, [](double x) {
        const double largest = std::numeric_limits<float>::max();
        return double(static_cast<float>(std::clamp(x, -largest, largest)));
    });
}

/// Calls check(query, text) for vertex/face and edge/edge queries of all families.
template <class Check>
void for_some_queries(int per_family, std::uint64_t seed, const Check& check) {
    query_families::for_some_queries(support::scaled(static_cast<std::uint64_t>(per_family)), seed,
                                     [&]<class Query>(const Query& query, const std::string& text) {
                                         if constexpr (
                                             requires { query.f0; } || requires { query.a0; })
                                             check(query, text);
                                     });
}

TEST(families, agree_with_the_oracle) {
    std::size_t queries = 0, true_answers = 0;
    std::uint64_t seed = 0;
    for_some_queries(16, 18, [&](const auto& query, const std::string& text) {
        query_families::source random(++seed);
        for (const double ms : {0.0, support::some_distance(random, query)}) {
            const double t_max = random.one_in(2) ? 1 : random.unit();
            const answer<double> a = ask(query, ms, t_max);
            EXPECT_EQ(fault(query, ms, t_max, a), "") << ms << ", " << t_max << ", " << text;
            const auto floats = in_float(query);
            const auto float_ms = static_cast<float>(std::min(ms, 1e38));
            const auto float_t_max = static_cast<float>(t_max);
            const answer<float> b = ask<float>(floats, float_ms, float_t_max);
            EXPECT_EQ(fault(floats, float_ms, float_t_max, b), "")
                << "float, " << float_ms << ", " << float_t_max << ", " << text;
            queries += 2;
            true_answers += a.collides + b.collides;
        }
    });
    std::printf("%zu answers, %zu true\n", queries, true_answers);
}

TEST(families, near_at_the_start_are_tested_only_for_contact_without_zero_times) {
    for_some_queries(8, 19, [&](const auto& query, const std::string& text) {
        for (const double ms : {0.0, 0.5}) {
            const answer<double> a = ask(query, ms), b = ask(query, ms, 1.0, true);
            EXPECT_EQ(b, a == at(0) ? ask(query) : a) << text;
        }
    });
}

}  // namespace
