// Steps to the positions of an advance are free, for stored scenes. One scene is in the repository.
#include <gtest/gtest.h>

#include <ccd/io/mesh_file.hpp>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <numeric>
#include <span>
#include <vector>

#include "tests/ccd/step/expect_advances.hpp"
#include "tests/support/scaled.hpp"
#include "tests/support/stored_data.hpp"

namespace {

namespace fs = std::filesystem;
using brute_force::expect_free;
using brute_force::goes_far;
using brute_force::two_frames;
using support::scaled;

double mean_edge(const ccd::mesh& frame) {
    const auto edges = ccd::unique_edges(frame.faces, frame.edges);
    double sum = 0;
    for (const ccd::edge& e : edges) {
        const auto &a = frame.vertices[e[0]], &b = frame.vertices[e[1]];
        sum += std::hypot(a.x - b.x, a.y - b.y, a.z - b.z);
    }
    return sum / static_cast<double>(edges.size());
}

/// Advances the scene as one group, by bodies, by vertices, and with minimum distances. A small
/// scale of random tests uses only the first.
void advance_scene(const fs::path& before, const fs::path& after) {
    SCOPED_TRACE(before.string());
    const two_frames at{ccd::io::read_mesh(before), ccd::io::read_mesh(after)};
    const ccd::mesh& mesh = at.first;
    const auto bodies = ccd::connected_parts(mesh.faces, mesh.edges, mesh.vertices.size());
    std::vector<int> each(mesh.vertices.size());
    std::iota(each.begin(), each.end(), 0);
    const double edge = mean_edge(mesh);
    const struct {
        const char* name;
        ccd::advance_options options;
    } cases[] = {{"as one", {}},
                 {"by bodies", {.groups = bodies}},
                 {"by vertices", {.groups = each}},
                 {"each vertex by planes", {.each_vertex = true}},
                 {"keeping 1e-3 of the mean edge", {.distances = {1e-3 * edge}, .keep = 0}},
                 {"keeping a tenth of near distances", {.distances = {1e-3 * edge}}},
                 {"keeping 1e-12 of it", {.distances = {1e-12 * edge}, .keep = 0}}};
    for (const auto& [name, options] : std::span(cases).first(scaled(std::size(cases)))) {
        SCOPED_TRACE(name);
        const auto result = expect_free(at, options);
        EXPECT_TRUE(goes_far(result));
        const double mean = std::accumulate(result.fractions.begin(), result.fractions.end(), 0.0) /
                            static_cast<double>(result.fractions.size());
        std::printf(
            "%s, %s: %.17g of the way (mean of vertices %.3g), first contact %.17g; at the start "
            "%zu touch, %zu are near\n",
            before.stem().c_str(), name, result.fraction, mean, result.first_contact.low,
            number_of(result.touching_at_start), number_of(result.near_at_start));
    }
}

TEST(AdvanceOfScenes, OfTheRepository) {
    const fs::path scene = ERRBOUND_SCENE;
    advance_scene(scene / "frame0.ply", scene / "frame1.ply");
}

TEST(AdvanceOfScenes, Stored) {
    if (!stored_data::has_scenes()) GTEST_SKIP() << stored_data::missing;
    stored_data::for_each_scene(advance_scene);
}

}  // namespace
