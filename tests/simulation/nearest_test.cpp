// Nearest points, compared with exact decisions about distances.
#include "examples/simulation/collision/nearest.hpp"

#include <gtest/gtest.h>

#include <array>
#include <ccd/contact.hpp>
#include <random>

namespace {

using simulation::nearest_points;
using simulation::vec3;
using points = std::array<vec3, 4>;

ccd::moving_point<double> at_rest(const vec3& x) {
    const ccd::point<double> p{x.x(), x.y(), x.z()};
    return {p, p};
}

/// Points in general position, and on small grids, where features are parallel or degenerate.
points random_points(std::mt19937_64& random) {
    points x;
    const bool coarse = random() % 2 == 0;
    for (vec3& p : x)
        for (double& c : p)
            c = coarse ? static_cast<double>(random() % 4)
                       : static_cast<double>(random() % (1U << 20)) * 0x1p-20;
    return x;
}

/// Expects that `exact` finds the features within slightly more than the distance, not within less.
template <class Query>
void expect_distance(const Query& query, const nearest_points& found, const points& x) {
    vec3 between = vec3::Zero();
    for (std::size_t i = 0; i < 4; ++i) between += found.weights[i] * x[i];
    ASSERT_NEAR((between - found.between).norm(), 0, 1e-14);
    const double d = found.distance();
    ASSERT_EQ(decide_within(query, {d * (1 + 1e-9) + 1e-12, 0}).outcome, ccd::outcome::collides);
    if (d > 1e-9) {
        ASSERT_EQ(decide_within(query, {d * (1 - 1e-9), 0}).outcome, ccd::outcome::separate);
    }
}

TEST(Nearest, OfRandomFeatures) {
    std::mt19937_64 random(1);
    for (int k = 0; k < 3000; ++k) {
        const points x = random_points(random);
        const auto a = at_rest(x[0]), b = at_rest(x[1]), c = at_rest(x[2]), d = at_rest(x[3]);
        const auto vertex_face = simulation::nearest_vertex_face(x);
        EXPECT_NEAR(vertex_face.weights[1] + vertex_face.weights[2] + vertex_face.weights[3], -1,
                    1e-12);
        expect_distance(ccd::vertex_face<double>{a, b, c, d}, vertex_face, x);
        const auto edges = simulation::nearest_edges(x);
        EXPECT_NEAR(edges.weights[0] + edges.weights[1], 1, 1e-12);
        expect_distance(ccd::edge_edge<double>{a, b, c, d}, edges, x);
        expect_distance(ccd::vertex_edge<double>{a, b, c}, simulation::nearest_vertex_edge(x), x);
    }
}

TEST(Approach, StopsBeforeThePairMeets) {
    // A vertex falls through a face: the normal is that of the face, at the vertex.
    const points before{vec3(0.2, 0.3, 1), vec3(0, 0, 0), vec3(1, 0, 0), vec3(0, 1, 0)};
    points after = before;
    after[0] = vec3(0.4, 0.3, -1);
    const auto found = simulation::approach(before, after, simulation::nearest_vertex_face);
    EXPECT_GT(found.distance(), 0);
    EXPECT_LE(found.distance(), 0.11);
    EXPECT_NEAR(found.between.normalized().z(), 1, 1e-12);
    EXPECT_NEAR(-found.weights[2], 0.3, 0.02);
    // A pair that does not move keeps its nearest points.
    EXPECT_EQ(simulation::approach(before, before, simulation::nearest_vertex_face).weights,
              simulation::nearest_vertex_face(before).weights);
}

}  // namespace
