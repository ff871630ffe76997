// Steps of edges and points in the plane.
#include <gtest/gtest.h>

#include <random>
#include <stdexcept>

#include "tests/ccd/step/expect_steps.hpp"

namespace {

using brute_force::two_frames;
using ccd::outcome;
using ccd::vertex_index;

/// Chains of edges or separate edges, and points on a grid; they do not touch at the start.
two_frames edges_and_points(std::uint64_t seed, bool chains) {
    std::mt19937_64 random(seed);
    const auto coordinate = [&random] { return static_cast<double>(random() % 3); };
    ccd::mesh before;
    for (unsigned chain = 0; chain < 9; ++chain)
        for (unsigned i = 0; i < 4; ++i) {
            const auto v = static_cast<vertex_index>(before.vertices.size());
            before.vertices.push_back(
                {4.0 * (chain % 3) + i % 2, 4.0 * (chain / 3) + 0.5 * coordinate() + i, 0});
            if (i % 2 == 1 || (chains && i > 0 && chain % 4 != 3))
                before.edges.push_back({v - 1, v});
        }
    ccd::mesh after = before;
    for (auto& p : after.vertices) p = {p.x + coordinate(), p.y - 0.75 * coordinate(), 0};
    return {before, after};
}

ccd::mesh_steps steps_of(const ccd::mesh& mesh) {
    return ccd::mesh_steps::in_plane(mesh.edges, mesh.vertices.size());
}

TEST(PlaneStep, ReportsEveryVertexAndEdge) {
    std::size_t found = 0;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        const auto [before, after] = edges_and_points(seed, true);
        const ccd::vertex_rows rows(before, after);
        ccd::pair_lists expected;
        brute_force::for_each_pair_in_plane(before, [&]<class Pair>(const Pair& pair) {
            if (decide_exact(query_of(rows, pair)).outcome == outcome::collides)
                expected.of<ccd::kind_of<Pair>>().push_back(pair);
        });
        for (const int threads : {1, 2})
            EXPECT_EQ(steps_of(before).run(rows, {.threads = threads}).pairs, expected);
        found += expected.vertex_edge.size() + expected.vertex_vertex.size();
    }
    EXPECT_GT(found, 40U);
}

/// If edges do not cross at the start, they first touch at an end of one of them. (Edges with a
/// common vertex may fold onto each other, which steps in space do not detect.)
TEST(PlaneStep, FirstContactIsThatInSpace) {
    std::size_t contacts = 0;
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        const auto [before, after] = edges_and_points(seed, false);
        const ccd::vertex_rows rows(before, after);
        const auto in_space = ccd::step(before, after, {.first_contact = true});
        if (!in_space.touching_at_start.edge_edge.empty()) continue;
        const auto in_plane = steps_of(before).run(rows, {.first_contact = true});
        EXPECT_EQ(in_plane.first_contact, in_space.first_contact) << seed;
        contacts += in_plane.first_contact.outcome == outcome::collides;
    }
    EXPECT_GT(contacts, 10U);
}

TEST(PlaneStep, RefusesWhatIsNotInThePlane) {
    const ccd::mesh flat{{{0, 0, 0}, {1, 0, 0}}, {}, {{0, 1}}};
    ccd::mesh out = flat;
    out.vertices[1].z = 1;
    EXPECT_NO_THROW(steps_of(flat).run({flat, flat}));
    EXPECT_THROW(steps_of(flat).run({flat, out}), std::invalid_argument);
    EXPECT_THROW(steps_of(flat).candidates({out, flat}), std::invalid_argument);
    EXPECT_THROW(ccd::mesh_steps::in_plane(flat.edges, 1), std::invalid_argument);
}

}  // namespace
