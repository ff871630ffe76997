// Nearest features, points, distances and normals: made by hand, and compared with whole numbers.
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <ccd/contact.hpp>
#include <ccd/nearness.hpp>
#include <ccd/plane.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/ccd/contact/by_hand.hpp"
#include "tests/ccd/contact/nearness_faults.hpp"
#include "tests/support/query_families.hpp"
#include "tests/support/scaled.hpp"

namespace {

using ccd::kind;
using ccd::meeting_features;
using ccd::nearness;
using support::nearness_data::faults_of;
using namespace by_hand;

/// The data, which must be right.
template <class Query>
nearness checked(const Query& query, double t = 0) {
    const nearness found = ccd::nearness_of(query, t);
    EXPECT_EQ(faults_of(query, t, found), "");
    return found;
}
void expect(const nearness& found, const meeting_features& features, std::array<double, 4> weights,
            double distance, point normal) {
    EXPECT_EQ(found.features, features);
    for (std::size_t i = 0; i < 4; ++i)
        EXPECT_NEAR(found.weights[i], weights[i], found.weight_error) << "of point " << i;
    EXPECT_LE(found.weight_error, 1e-12);
    EXPECT_NEAR(found.distance, distance, found.distance_error);
    EXPECT_NEAR(found.squared_distance, distance * distance, found.squared_distance_error);
    EXPECT_LE(found.distance_error, 1e-12 * distance);
    if (distance == 0) return;
    EXPECT_NEAR(found.normal.x, normal.x, found.normal_error);
    EXPECT_NEAR(found.normal.y, normal.y, found.normal_error);
    EXPECT_NEAR(found.normal.z, normal.z, found.normal_error);
    EXPECT_LE(found.normal_error, 1e-12);
}
vertex_face above(point v) {
    return over_triangle(v, v);
}
/// Edge a from (-1, 0, 0) to (1, 0, 0), and an edge b.
edge_edge on_x_axis(point b0, point b1) {
    return {still({-1, 0, 0}), still({1, 0, 0}), still(b0), still(b1)};
}

TEST(nearness, of_a_vertex_and_a_face) {
    expect(checked(above({0.25, 0.5, -2})), {kind::vertex_face, {0, 1, 2, 3}}, {1, 0.25, 0.25, 0.5},
           2, {0, 0, -1});
    expect(checked(above({0.25, -3, 4})), {kind::vertex_edge, {0, 1, 2}}, {1, 0.75, 0.25, 0}, 5,
           {0, -0.6, 0.8});
    expect(checked(above({-3, 5, 12})), {kind::vertex_vertex, {0, 3}}, {1, 0, 0, 1}, 13,
           {-3.0 / 13, 4.0 / 13, 12.0 / 13});
}
TEST(nearness, of_edges) {
    expect(checked(on_x_axis({0.5, -1, 3}, {0.5, 3, 3})), {kind::edge_edge, {0, 1, 2, 3}},
           {0.25, 0.75, 0.75, 0.25}, 3, {0, 0, -1});
    expect(checked(on_x_axis({0.5, 6, 8}, {0.5, 3, 4})), {kind::vertex_edge, {3, 0, 1}},
           {0.25, 0.75, 0, 1}, 5, {0, -0.6, -0.8});
    expect(checked(on_x_axis({4, 4, 12}, {5, 8, 12})), {kind::vertex_vertex, {1, 2}}, {0, 1, 1, 0},
           13, {-3.0 / 13, -4.0 / 13, -12.0 / 13});
}
TEST(nearness, of_parallel_edges_is_that_of_the_first_end) {
    // All points of both are at the distance, up to where one ends.
    expect(checked(on_x_axis({0, 0, 3}, {4, 0, 3})), {kind::vertex_edge, {1, 2, 3}},
           {0, 1, 0.75, 0.25}, 3, {0, 0, -1});
    expect(checked(on_x_axis({-0.5, 0, 3}, {0.5, 0, 3})), {kind::vertex_edge, {2, 0, 1}},
           {0.75, 0.25, 1, 0}, 3, {0, 0, -1});
    expect(checked(on_x_axis({-1, 0, 3}, {1, 0, 3})), {kind::vertex_vertex, {0, 2}}, {1, 0, 1, 0},
           3, {0, 0, -1});
    expect(checked(on_x_axis({1, 0, 3}, {-1, 0, 3})), {kind::vertex_vertex, {0, 3}}, {1, 0, 0, 1},
           3, {0, 0, -1});
    expect(checked(on_x_axis({4, 0, 0}, {6, 0, 0})), {kind::vertex_vertex, {1, 2}}, {0, 1, 1, 0}, 3,
           {-1, 0, 0});
}
TEST(nearness, at_a_border_is_that_of_the_smaller_features) {
    expect(checked(above({0.5, 0, 2})), {kind::vertex_edge, {0, 1, 2}}, {1, 0.5, 0.5, 0}, 2,
           {0, 0, 1});
    expect(checked(above({0, 1, 2})), {kind::vertex_vertex, {0, 3}}, {1, 0, 0, 1}, 2, {0, 0, 1});
    expect(checked(on_x_axis({-1, 0, 1}, {-1, 4, 1})), {kind::vertex_vertex, {0, 2}}, {1, 0, 1, 0},
           1, {0, 0, -1});
}
TEST(nearness, of_degenerate_features) {
    const vertex_face segment{still({5, 3, 4}), still({0, 0, 0}), still({2, 0, 0}),
                              still({8, 0, 0})};
    expect(checked(segment), {kind::vertex_edge, {0, 2, 3}}, {1, 0, 0.5, 0.5}, 5, {0, 0.6, 0.8});
    const vertex_face spot{still({3, 4, 12}), still({0, 0, 0}), still({0, 0, 0}), still({0, 0, 0})};
    expect(checked(spot), {kind::vertex_vertex, {0, 1}}, {1, 1, 0, 0}, 13,
           {3.0 / 13, 4.0 / 13, 12.0 / 13});
    expect(checked(on_x_axis({0.5, 3, 4}, {0.5, 3, 4})), {kind::vertex_edge, {2, 0, 1}},
           {0.25, 0.75, 1, 0}, 5, {0, -0.6, -0.8});
    const vertex_edge end{still({3, 4, 0}), still({0, 0, 0}), still({0, 0, 0})};
    expect(checked(end), {kind::vertex_vertex, {0, 1}}, {1, 1, 0, 0}, 5, {0.6, 0.8, 0});
}
TEST(nearness, of_features_that_touch_has_no_normal) {
    for (const nearness& found : {checked(above({0.25, 0.5, 0})), checked(above({0, 0, 0})),
                                  checked(on_x_axis({0, -1, 0}, {0, 1, 0}))}) {
        EXPECT_TRUE(found.touches());
        EXPECT_EQ(found.squared_distance_error, 0);
        EXPECT_EQ(found.normal, point{});
        EXPECT_EQ(found.normal_error, infinity);
        EXPECT_LE(found.weight_error, 1e-15);
    }
    EXPECT_FALSE(checked(above({0.25, 0.5, least})).touches());
    EXPECT_FALSE(nearness().touches());
}
TEST(nearness, at_a_time_is_at_the_exact_position) {
    const auto falling = over_triangle({0.25, 0.5, 3}, {0.25, 0.5, -1});
    expect(checked(falling, 0.25), {kind::vertex_face, {0, 1, 2, 3}}, {1, 0.25, 0.25, 0.5}, 2,
           {0, 0, 1});
    expect(checked(falling, 1), {kind::vertex_face, {0, 1, 2, 3}}, {1, 0.25, 0.25, 0.5}, 1,
           {0, 0, -1});
    EXPECT_TRUE(checked(falling, 0.75).touches());
    // Just before a contact at 1/3, the normal is the side.
    const auto meeting = over_triangle({0.25, 0.5, 1}, {0.25, 0.5, -2});
    const auto time = ccd::time_of_impact(meeting);
    const nearness before = checked(meeting, time.low);
    EXPECT_LT(before.distance, 1e-15);
    EXPECT_EQ(before.normal, (point{0, 0, 1}));
    EXPECT_EQ(checked(meeting, time.high).normal, (point{0, 0, -1}));
}
TEST(nearness, of_all_magnitudes) {
    const double huge = std::numeric_limits<double>::max();
    const nearness far = checked(vertex_vertex{still({huge, huge, 0}), still({-huge, 0, 0})});
    EXPECT_EQ(far.distance, infinity);
    EXPECT_EQ(far.distance_error, infinity);
    EXPECT_LT(far.normal_error, 1e-15);
    const nearness tiny = checked(vertex_vertex{still({3 * least, 0, 0}), still({0, 0, 0})});
    EXPECT_EQ(tiny.distance, 3 * least);
    EXPECT_EQ(tiny.squared_distance, 0);
    EXPECT_EQ(tiny.normal, (point{1, 0, 0}));
    // The distance is below the least double.
    const nearness below =
        checked(vertex_edge{still({least, 0, 0}), still({0, 0, 0}), still({1, least, 0})});
    EXPECT_FALSE(below.touches());
}
TEST(nearness, without_positions_or_a_time_has_no_data) {
    const nearness none;
    EXPECT_EQ(none.weights, (std::array<double, 4>{}));
    const auto query = above({0.25, 0.5, 1});
    for (const double t : {-1.0, 1.5, std::nan("")}) EXPECT_EQ(ccd::nearness_of(query, t), none);
    for (const double bad : {infinity, -infinity, std::nan("")}) {
        const auto moving = over_triangle({0.25, 0.5, 1}, {0.25, 0.5, bad});
        EXPECT_EQ(ccd::nearness_of(moving), ccd::nearness_of(query));
        EXPECT_EQ(ccd::nearness_of(moving, 1), none);
        EXPECT_EQ(ccd::nearness_of(moving, 0.5), none);
    }
}
TEST(nearness, in_the_plane) {
    using plane_point = ccd::plane::point;
    const auto rest = [](plane_point p) { return ccd::plane::moving_point{p, p}; };
    const ccd::plane::vertex_edge query{{{0.5, 3}, {-3, -4}}, rest({0, 0}), rest({1, 0})};
    expect(ccd::plane::nearness_of(query), {kind::vertex_edge, {0, 1, 2}}, {1, 0.5, 0.5, 0}, 3,
           {0, 1, 0});
    expect(ccd::plane::nearness_of(query, 1), {kind::vertex_vertex, {0, 1}}, {1, 1, 0, 0}, 5,
           {-0.6, -0.8, 0});
    expect(ccd::plane::nearness_of(ccd::plane::vertex_vertex{rest({3, 4}), rest({0, 0})}),
           {kind::vertex_vertex, {0, 1}}, {1, 1, 0, 0}, 5, {0.6, 0.8, 0});
}

/// The check must find every fault.
TEST(nearness_faults, of_changed_data) {
    const auto query = above({0.25, 0.5, 2});
    const nearness right = ccd::nearness_of(query);
    const auto is_found = [&](const auto& change, const std::string& fault) {
        nearness wrong = right;
        change(wrong);
        EXPECT_NE(faults_of(query, 0, wrong).find(fault), std::string::npos) << fault;
    };
    is_found([](nearness& n) { n.features = {kind::vertex_edge, {0, 1, 2}}; }, "features");
    is_found([](nearness& n) { n.weights[1] += 2 * n.weight_error; }, "weight off");
    is_found([](nearness& n) { n.weights[0] = 2; }, "out of [0, 1]");
    is_found([](nearness& n) { n.weights[3] = 0.25; }, "add up to 1");
    is_found([](nearness& n) { n.weight_error = 1e-7; }, "weight error too large");
    is_found([](nearness& n) { n.squared_distance += 2 * n.squared_distance_error; }, "squared");
    is_found([](nearness& n) { n.distance -= 2 * n.distance_error; }, "distance off");
    is_found([](nearness& n) { n.distance_error = 1e-6; }, "distance too large");
    is_found([](nearness& n) { n.distance = infinity; }, "no overflow");
    is_found([](nearness& n) { n.distance = n.distance_error = 0; }, "touches wrongly");
    is_found([](nearness& n) { n.normal.x += 2 * n.normal_error; }, "normal off");
    is_found([](nearness& n) { n.normal = {0, 0, -1}; }, "normal off");
    is_found([](nearness& n) { n.normal_error = 1; }, "normal too large");
}

TEST(nearness_families, have_right_features_and_errors_at_all_times) {
    query_families::for_some_queries(
        support::scaled(150), 17, [](const auto& query, const std::string& text) {
            for (const double t : {0.0, 1.0, 0.375, 0x1.8p-40})
                EXPECT_EQ(faults_of(query, t, ccd::nearness_of(query, t)), "")
                    << text << "at " << t;
        });
}

/// Grids of few sizes, on which nearly all features tie.
TEST(nearness_families, on_all_small_grids) {
    std::mt19937_64 random(5);
    for (int i = 0; i < support::scaled(20'000); ++i) {
        const auto size = static_cast<int>(random() % 3) + 1;
        const auto coordinate = [&] {
            return std::ldexp(static_cast<int>(random() % 5) % (size + 1), -size);
        };
        const auto p = [&] { return still({coordinate(), coordinate(), coordinate()}); };
        checked(vertex_face{p(), p(), p(), p()});
        checked(edge_edge{p(), p(), p(), p()});
        checked(vertex_edge{p(), p(), p()});
    }
}

/// Queries of all families as pairs of vertices.
template <kind K>
struct pairs_of_families {
    std::vector<point> before, after;
    std::vector<ccd::pair_of_kind<K>> pairs;

    explicit pairs_of_families(std::uint64_t per_family) {
        for (const auto& family : query_families::families)
            for (std::uint64_t i = 0; i * family.thinning < per_family; ++i) {
                const auto points = query_families::make(family, K, 23, i);
                const auto v = static_cast<ccd::vertex_index>(before.size());
                for (const auto& p : points) {
                    before.push_back(p.t0);
                    after.push_back(p.t1);
                }
                [&]<std::size_t... I>(std::index_sequence<I...>) {
                    pairs.push_back({static_cast<ccd::vertex_index>(v + I)...});
                }
                (std::make_index_sequence<sizeof(ccd::pair_of_kind<K>) / 4>());
            }
    }
    ccd::vertex_rows rows() const { return {before, after}; }
};

template <kind K>
void expect_batches_as_one_by_one() {
    const pairs_of_families<K> given(7);
    const ccd::vertex_rows rows = given.rows(), start(rows.before, nullptr, rows.vertices);
    using query = typename ccd::kind_traits<K>::template query<double>;
    std::vector<query> queries;
    std::vector<nearness> at_start, at_half, at_times;
    for (const auto& pair : given.pairs) queries.push_back(query_of(rows, pair));
    const auto times = ccd::first_times(queries);
    for (std::size_t i = 0; i < queries.size(); ++i) {
        at_start.push_back(ccd::nearness_of(queries[i]));
        at_half.push_back(ccd::nearness_of(queries[i], 0.5));
        at_times.push_back(times[i].outcome == ccd::outcome::collides
                               ? ccd::nearness_of(queries[i], times[i].low)
                               : nearness());
    }
    for (const int threads : {1, 3}) {
        for (const auto set : ccd::instruction_sets())
            EXPECT_EQ(ccd::nearnesses(start, given.pairs, {.threads = threads, .set = set}),
                      at_start);
        EXPECT_EQ(ccd::nearnesses(queries, {.threads = threads}), at_start);
        EXPECT_EQ(ccd::nearnesses(rows, given.pairs, {.t = 0.5, .threads = threads}), at_half);
        EXPECT_EQ(ccd::nearnesses(queries, {.t = 0.5, .threads = threads}), at_half);
        EXPECT_EQ(ccd::nearnesses(rows, given.pairs, times, {.threads = threads}), at_times);
        EXPECT_EQ(ccd::nearnesses(queries, times, {.threads = threads}), at_times);
    }
    // Fewer pairs than a pack has lanes.
    for (std::size_t n = 0; n < 9; ++n) {
        const std::span some(given.pairs.data(), n);
        const auto found = ccd::nearnesses(start, some);
        EXPECT_TRUE(std::equal(found.begin(), found.end(), at_start.begin()));
        EXPECT_EQ(found.size(), n);
    }
}
TEST(nearnesses, are_as_one_by_one) {
    ccd::for_each_kind([]<kind K>() { expect_batches_as_one_by_one<K>(); });
}
TEST(nearnesses, refuse_bad_input) {
    const std::vector<point> p(4);
    const std::vector<ccd::vertex_face_pair> pairs{{0, 1, 2, 3}}, beyond{{0, 1, 2, 4}};
    const ccd::vertex_rows rows(p, p);
    const auto message_of = [](const auto& call) -> std::string {
        try {
            call();
        } catch (const std::invalid_argument& e) {
            return e.what();
        }
        return "";
    };
    EXPECT_EQ(message_of([&] { ccd::nearnesses(rows, pairs, {.t = 2}); }),
              "ccd::nearnesses: t is 2; expected a number in [0, 1]");
    EXPECT_EQ(message_of([&] { ccd::nearnesses(rows, beyond); }),
              "ccd::nearnesses: vertex index of query 0 is 4; expected less than 4");
    EXPECT_EQ(message_of([&] { ccd::nearnesses(rows, pairs, std::vector<ccd::first_time>()); }),
              "ccd::nearnesses: number of times is 0; expected 1, one for each query");
    const ccd::vertex_rows start(rows.before, nullptr, 4);
    EXPECT_NE(message_of([&] { ccd::nearnesses(start, pairs, {.t = 1}); }), "");
    EXPECT_EQ(ccd::nearnesses(start, pairs).size(), 1U);
}
TEST(nearnesses, are_stopped) {
    const std::vector<point> p(4);
    const std::vector<ccd::vertex_face_pair> pairs(10'000, {0, 1, 2, 3});
    std::atomic<int> calls = 0;
    EXPECT_THROW(
        ccd::nearnesses(ccd::vertex_rows(p, p), pairs, {.stop = [&] { return ++calls == 3; }}),
        ccd::stopped);
}

}  // namespace
