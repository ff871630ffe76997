// Meshes of faces, rods and points: every pair.
#include <gtest/gtest.h>

#include <limits>

#include "tests/ccd/step/expect_steps.hpp"

namespace {

using brute_force::random_mixture;
using brute_force::two_frames;

TEST(Mixture, AgreesWithBruteForce) {
    ccd::pair_counts found;
    std::size_t at_start = 0;
    for (const unsigned seed : {1U, 2U, 3U, 4U, 5U}) {
        const auto at = random_mixture(seed);
        brute_force::expect_as_by_brute_force(at, ccd::method::exact);
        brute_force::expect_as_by_brute_force(at, ccd::method::tight);
        const auto step = ccd::step(at.first, at.second, {.initial_contact = true});
        EXPECT_EQ(step.touching_at_start, brute_force::step(at).touching_at_start);
        at_start += number_of(step.touching_at_start);
        ccd::for_each_kind([&]<ccd::kind K>() { found.of<K>() += step.pairs.of<K>().size(); });
    }
    EXPECT_GT(at_start, 0U);
    ccd::for_each_kind([&]<ccd::kind K>() { EXPECT_GT(found.of<K>(), 0U) << name(K); });
}

TEST(Mixture, AdjacentRodsAgreeWithBruteForce) {
    std::size_t contacts = 0;
    for (std::uint64_t seed = 1; seed <= 600; ++seed) {
        auto [before, after] = random_mixture(seed);
        // In a plane, rods often meet. Degenerate faces are rods here, and some rods close rings.
        for (auto* m : {&before, &after}) {
            if (seed % 2 == 0)
                for (auto& p : m->vertices) p.z = 0;
            m->faces.push_back({1, 1, 2});
            m->edges.insert(m->edges.end(), {{2, 3}, {3, 4}, {4, 2}, {1, 3}});
        }
        const ccd::vertex_rows rows(before, after);
        ccd::step_options options{.count_candidates = seed % 3 == 0, .times = true};
        auto expected = ccd::step(before, after, options).pairs;
        brute_force::for_each_adjacent_pair(before, [&](const auto& pair) {
            if (decide_exact(query_of(rows, pair)).outcome != ccd::outcome::collides) return;
            expected.vertex_edge.push_back(pair);
            ++contacts;
        });
        std::ranges::sort(expected.vertex_edge);
        options.adjacent_rods = true;
        const ccd::step_result found = ccd::step(before, after, options);
        EXPECT_EQ(found.pairs, expected);
        options.t_max = 0.5;
        std::erase_if(expected.vertex_edge, [&](const auto& pair) {
            return ccd::time_of_impact(query_of(rows, pair), 0.5).outcome != ccd::outcome::collides;
        });
        EXPECT_EQ(ccd::step(before, after, options).pairs.vertex_edge, expected.vertex_edge);
    }
    EXPECT_GT(contacts, 200U);
}

// Regression: points within a few times the least number of each other, and one far away. The
// length of the curve's cells underflowed to 0, and positions on the curve were NaN converted to
// integers.
TEST(Mixture, PointsAtTheLeastDistances) {
    constexpr double least = std::numeric_limits<double>::denorm_min();
    two_frames at;
    for (int k = 0; k < 400; ++k) {
        at.first.vertices.push_back({k % 7 * least, k % 64 * 4 * least, 0});
        at.second.vertices.push_back({(k % 7 + 3) * least, k % 64 * 4 * least, 0});
    }
    brute_force::expect_as_by_brute_force(at, ccd::method::exact);
    at.first.vertices.push_back({1, 1, 1});
    at.second.vertices.push_back({1, 1, 1});
    brute_force::expect_as_by_brute_force(at, ccd::method::exact);
}

TEST(Mixture, PointsOfRodsAndFacesThatAreNone) {
    // Two points that swap places, a rod between them, and a face that is a point.
    const ccd::mesh before{{{0, 0, 0}, {2, 0, 0}, {1, -1, 0}, {1, 1, 0}, {1, 0, 0}},
                           {{4, 4, 4}},
                           {{3, 2}, {2, 3}, {0, 0}}};
    ccd::mesh after = before;
    std::swap(after.vertices[0], after.vertices[1]);
    const auto found = ccd::step(before, after, {.initial_contact = true});
    const std::vector<ccd::vertex_vertex_pair> points{{0, 1}, {0, 4}, {1, 4}};
    const std::vector<ccd::vertex_edge_pair> on_the_rod{{0, 2, 3}, {1, 2, 3}, {4, 2, 3}};
    const std::vector<ccd::vertex_face_pair> on_the_face{{0, 4, 4, 4}, {1, 4, 4, 4}};
    EXPECT_EQ(found.pairs.vertex_vertex, points);
    EXPECT_EQ(found.pairs.vertex_edge, on_the_rod);
    EXPECT_EQ(found.pairs.vertex_face, on_the_face);
    EXPECT_EQ(found.touching_at_start.vertex_edge, std::vector{on_the_rod[2]});
    EXPECT_TRUE(found.touching_at_start.vertex_vertex.empty());
}

TEST(Mixture, PairsComeOnceHoweverOftenFacesAndEdgesAreGiven) {
    ccd::mesh before{
        {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.25, 0.25, 1}, {0.25, 0.25, 2}}, {{0, 1, 2}}, {{3, 4}}};
    ccd::mesh after = before;
    for (const std::size_t v : {3, 4}) after.vertices[v].z -= 3;
    const auto once = ccd::step(before, after, {.count_candidates = true});
    EXPECT_EQ(once.pairs.vertex_face.size(), 2U);
    const ccd::pair_lists candidates_once = ccd::candidates(before, after);
    for (auto* m : {&before, &after}) {
        m->faces.insert(m->faces.end(), {{2, 1, 0}, {1, 2, 0}, {0, 1, 2}});
        m->edges.insert(m->edges.end(), {{4, 3}, {0, 1}, {1, 0}});
    }
    brute_force::expect_both_ways(
        once, {}, [&](const auto& options) { return ccd::step(before, after, options); });
    const ccd::vertex_rows positions(before.vertices, after.vertices);
    ccd::mesh_steps steps(before);
    for (int run = 0; run < 2; ++run)
        brute_force::expect_both_ways(
            once, {}, [&](const auto& options) { return steps.run(positions, options); });
    const ccd::pair_lists found = steps.candidates(positions);
    ccd::for_each_kind(
        [&]<ccd::kind K>() { EXPECT_EQ(found.of<K>().size(), candidates_once.of<K>().size()); });
}

}  // namespace
