// Meshes of faces, rods and points: every pair, and every contact of two elements.
#include <gtest/gtest.h>

#include <limits>

#include "tests/ccd/step/expect_steps.hpp"

namespace {

using brute_force::random_mixture;
using brute_force::two_frames;
using brute_force::vertex;
using brute_force::vertex_index;

TEST(Mixture, AgreesWithBruteForce) {
    ccd::pair_counts found;
    for (const unsigned seed : {1U, 2U, 3U, 4U, 5U}) {
        const auto at = random_mixture(seed);
        brute_force::expect_as_by_brute_force(at, ccd::method::exact);
        brute_force::expect_as_by_brute_force(at, ccd::method::tight);
        const auto pairs = ccd::step(at.first, at.second).pairs;
        ccd::for_each_kind([&]<ccd::kind K>() { found.of<K>() += pairs.of<K>().size(); });
    }
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

/// An element of a mesh with all its vertices and edges.
struct element {
    std::vector<vertex> vertices;
    std::vector<ccd::edge> edges;
    std::vector<ccd::face> faces;
};

std::vector<element> elements_of(const ccd::mesh& mesh) {
    const brute_force::elements of(mesh);
    std::vector<element> all;
    for (const ccd::face& f : of.faces)
        all.push_back({{{f[0]}, {f[1]}, {f[2]}}, {{f[0], f[1]}, {f[1], f[2]}, {f[2], f[0]}}, {f}});
    for (const ccd::edge& e : of.rods) all.push_back({{{e[0]}, {e[1]}}, {e}, {}});
    for (const vertex& v : of.points) all.push_back({{v}, {}, {}});
    return all;
}

/// True if a feature of one element touches a feature of the other, of any kinds.
bool touch(const ccd::vertex_rows& rows, const element& a, const element& b) {
    const auto hit = [&](const auto& pair) {
        return decide_exact(query_of(rows, pair)).outcome == ccd::outcome::collides;
    };
    bool touching = false;
    for (const auto& [one, other] : {std::pair(&a, &b), std::pair(&b, &a)})
        for (const vertex& v : one->vertices) {
            for (const vertex& w : other->vertices)
                touching |= hit(ccd::vertex_vertex_pair{v[0], w[0]});
            for (const ccd::edge& e : other->edges)
                touching |= hit(ccd::vertex_edge_pair{v[0], e[0], e[1]});
            for (const ccd::face& f : other->faces)
                touching |= hit(ccd::vertex_face_pair{v[0], f[0], f[1], f[2]});
        }
    for (const ccd::edge& e : a.edges)
        for (const ccd::edge& f : b.edges)
            touching |= hit(ccd::edge_edge_pair{e[0], e[1], f[0], f[1]});
    return touching;
}

bool holds(const element& e, auto... vertices) {
    const auto is_one = [&e](vertex_index v) {
        return std::ranges::find(e.vertices, vertex{v}) != e.vertices.end();
    };
    return (is_one(vertices) && ...);
}

/// True if a reported pair has one feature of each element.
bool reported(const ccd::pair_lists& pairs, const element& a, const element& b) {
    return std::ranges::any_of(
               pairs.vertex_face,
               [&](const auto& p) { return holds(a, p.v) && holds(b, p.f0, p.f1, p.f2); }) ||
           std::ranges::any_of(
               pairs.edge_edge,
               [&](const auto& p) { return holds(a, p.a0, p.a1) && holds(b, p.b0, p.b1); }) ||
           std::ranges::any_of(
               pairs.vertex_edge,
               [&](const auto& p) { return holds(a, p.v) && holds(b, p.e0, p.e1); }) ||
           std::ranges::any_of(pairs.vertex_vertex,
                               [&](const auto& p) { return holds(a, p.v) && holds(b, p.w); });
}

TEST(Mixture, ReportsEveryContactOfTwoElements) {
    std::size_t contacts = 0;
    for (unsigned seed = 1; seed <= 30; ++seed) {
        const auto [before, after] = random_mixture(seed);
        const auto pairs = ccd::step(before, after).pairs;
        const ccd::vertex_rows rows(before, after);
        const auto all = elements_of(before);
        for (std::size_t i = 0; i < all.size(); ++i)
            for (std::size_t j = i + 1; j < all.size(); ++j) {
                const element &a = all[i], &b = all[j];
                if (std::ranges::any_of(a.vertices, [&](vertex v) { return holds(b, v[0]); }))
                    continue;
                const bool touching = touch(rows, a, b);
                contacts += touching;
                EXPECT_EQ(reported(pairs, a, b) || reported(pairs, b, a), touching);
            }
    }
    EXPECT_GT(contacts, 100U);
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
