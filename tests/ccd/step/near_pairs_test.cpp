// Pairs of meshes at rest within a distance, and the least distance, compared with every pair.
#include <gtest/gtest.h>

#include <algorithm>
#include <ccd/contact.hpp>
#include <ccd/nearness.hpp>
#include <ccd/step.hpp>
#include <cstddef>
#include <functional>
#include <limits>
#include <random>
#include <stdexcept>
#include <tuple>
#include <utility>
#include <vector>

#include "tests/ccd/step/brute_force.hpp"
#include "tests/ccd/step/nasty_shapes.hpp"

namespace {

using brute_force::for_each_pair;
using ccd::kind;
using ccd::nearness;
constexpr double infinity = std::numeric_limits<double>::infinity();

struct setting {
    ccd::mesh mesh;
    bool in_plane = false;

    ccd::vertex_rows rows() const { return {mesh, mesh}; }
    /// Positions at the end are not read.
    ccd::vertex_rows start() const { return {rows().before, nullptr, mesh.vertices.size()}; }
    ccd::mesh_steps steps() const {
        return in_plane ? ccd::mesh_steps::in_plane(mesh.edges, mesh.vertices.size())
                        : ccd::mesh_steps(mesh);
    }
    /// Calls visit(pair) for each pair as steps report it.
    template <class Visit>
    void for_each_pair(const Visit& visit) const {
        const auto report = [&](const auto& pair) { visit(brute_force::as_reported(pair)); };
        if (in_plane)
            brute_force::for_each_pair_in_plane(mesh, report);
        else
            brute_force::for_each_pair(mesh, report);
    }
};

using is_kept = std::function<bool(ccd::vertex_index, ccd::vertex_index)>;

ccd::near_lists near_by_brute_force(const setting& s, const ccd::pair_distances& within,
                                    const is_kept& kept = {}) {
    ccd::near_lists near;
    const auto rows = s.rows();
    s.for_each_pair([&]<class Pair>(const Pair& pair) {
        if (kept && !kept(vertices_of(pair).front(), vertices_of(pair).back())) return;
        if (decide_within(query_of(rows, pair), within.of(pair)).outcome == ccd::outcome::collides)
            near.pairs.of<ccd::kind_of<Pair>>().push_back(pair);
    });
    ccd::for_each_kind([&]<kind K>() {
        std::ranges::sort(near.pairs.of<K>());
        for (const auto& pair : near.pairs.of<K>())
            near.data.of<K>().push_back(nearness_of(query_of(rows, pair)));
    });
    return near;
}

void expect_least(const setting& s, const ccd::least_distance_result& found) {
    using key = std::tuple<double, kind, std::array<ccd::vertex_index, 4>>;
    key least{infinity, {}, {}};
    bool any = false;
    double low = infinity;
    const auto rows = s.rows();
    s.for_each_pair([&]<class Pair>(const Pair& pair) {
        const nearness data = nearness_of(query_of(rows, pair));
        std::array<ccd::vertex_index, 4> vertices{};
        std::ranges::copy(vertices_of(pair), vertices.begin());
        const key next{data.distance, ccd::kind_of<Pair>, vertices};
        least = any ? std::min(least, next) : next;
        any = true;
        if (data.distance_error < infinity)
            low = std::min(low, std::max(data.distance - data.distance_error, 0.0));
    });
    if (!any || std::get<double>(least) == infinity) {
        EXPECT_EQ(found, ccd::least_distance_result());
        return;
    }
    const auto& [distance, of, vertices] = least;
    EXPECT_EQ(found.data.distance, distance);
    EXPECT_EQ(found.kind, of);
    EXPECT_EQ(found.vertices, vertices);
    EXPECT_LE(found.low, low);
    EXPECT_LE(found.low, distance);
    EXPECT_GE(found.high, distance + found.data.distance_error);
    EXPECT_LE(found.high - found.low, distance * 0x1p-22);
}

std::vector<setting> random_settings() {
    std::vector<setting> all;
    for (const unsigned seed : {1U, 2U, 3U}) {
        all.push_back({brute_force::random_soup(seed, 60, 40).first});
        all.push_back({brute_force::random_mixture(seed).first});
        setting plane{brute_force::random_mixture(seed).first, true};
        plane.mesh.faces.clear();
        for (auto& p : plane.mesh.vertices) p.z = 0;
        all.push_back(plane);
    }
    return all;
}

TEST(near_pairs, are_those_of_brute_force) {
    std::size_t found = 0;
    for (const setting& s : random_settings()) {
        ccd::mesh_steps steps = s.steps();
        for (const double d : {0.0, 0.25, 1.0, 2.5}) {
            const ccd::near_lists expected = near_by_brute_force(s, {.all = d});
            found += number_of(expected.pairs);
            for (const int threads : {1, 3})
                for (const auto set : ccd::instruction_sets())
                    EXPECT_EQ(ccd::near_pairs(steps, s.start(), {.all = d},
                                              {.threads = threads, .set = set}),
                              expected);
            if (!s.in_plane) {
                EXPECT_EQ(ccd::near_pairs(s.mesh, {.all = d}), expected);
            }
        }
        std::vector<double> thickness(s.mesh.vertices.size());
        std::mt19937_64 random(3);
        for (double& t : thickness) t = static_cast<double>(random() % 5) / 4;
        const ccd::pair_distances of_vertices{.thickness = thickness};
        EXPECT_EQ(ccd::near_pairs(steps, s.start(), of_vertices),
                  near_by_brute_force(s, of_vertices));
    }
    EXPECT_GT(found, 5000U);
}
TEST(near_pairs, are_filtered) {
    const setting s{brute_force::random_mixture(4).first};
    const is_kept even = [](ccd::vertex_index v, ccd::vertex_index w) { return (v + w) % 2 == 0; };
    // One vertex of each element suffices, so only pairs of two vertices are comparable.
    ccd::near_options options;
    options.filter.can_collide = even;
    ccd::mesh_steps steps = s.steps();
    EXPECT_EQ(ccd::near_pairs(steps, s.start(), {.all = 2}, options).pairs.vertex_vertex,
              near_by_brute_force(s, {.all = 2}, even).pairs.vertex_vertex);
}
TEST(near_pairs, at_exactly_the_distance_are_reported) {
    // Two triangles 1 + 2^-60 apart; no double is the distance.
    ccd::mesh m{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}},
                {{0, 1, 2}, {3, 4, 5}}};
    for (auto& p : m.vertices) p.z = p.z == 0 ? -0x1p-60 : p.z;
    const std::vector<double> thick{1, 1, 1, 0x1p-60, 0x1p-60, 0x1p-60};
    EXPECT_EQ(ccd::near_pairs(m, {.all = 1}).pairs.vertex_face.size(), 0U);
    EXPECT_EQ(ccd::near_pairs(m, {.thickness = thick}).pairs.vertex_face.size(), 6U);
    EXPECT_EQ(ccd::near_pairs(m, {.all = std::nextafter(1.0, 2)}).pairs.vertex_face.size(), 6U);
}
TEST(near_pairs, refuse_bad_input) {
    const ccd::mesh m{{{0, 0, 0}, {1, 0, 0}, {0, 1, infinity}}, {{0, 1, 2}}};
    EXPECT_THROW(ccd::near_pairs(m, {.all = 1}), std::invalid_argument);
    EXPECT_THROW(ccd::least_distance(m), std::invalid_argument);
    EXPECT_THROW(ccd::near_pairs(ccd::mesh{}, {.all = -1}), std::invalid_argument);
    ccd::mesh_steps steps{ccd::mesh{{{0, 0, 0}}, {}}};
    EXPECT_THROW(ccd::near_pairs(steps, ccd::vertex_rows(nullptr, nullptr, 1), {}),
                 std::invalid_argument);
}
TEST(near_pairs, are_stopped) {
    const setting s{brute_force::random_soup(1, 60, 40).first};
    EXPECT_THROW(ccd::near_pairs(s.mesh, {.all = 9}, {.stop = [] { return true; }}), ccd::stopped);
    EXPECT_THROW(ccd::least_distance(s.mesh, {.stop = [] { return true; }}), ccd::stopped);
}

TEST(least_distance, is_that_of_brute_force) {
    for (setting s : random_settings()) {
        std::mt19937_64 random(7);
        for (const double noise : {0.0, 0x1p-4, 0x1p-30}) {
            for (auto& p : s.mesh.vertices) {
                p.x += noise * nasty_shapes::uniform(random);
                if (!s.in_plane) p.z += noise * nasty_shapes::uniform(random);
            }
            ccd::mesh_steps steps = s.steps();
            for (const int threads : {1, 3})
                expect_least(s, ccd::least_distance(steps, s.start(), {.threads = threads}));
        }
    }
}
TEST(least_distance, of_nasty_shapes) {
    for (const auto& shape : nasty_shapes::shapes) {
        SCOPED_TRACE(shape.name);
        const setting s{nasty_shapes::triangles(shape, 2).first};
        expect_least(s, ccd::least_distance(s.mesh));
    }
}
TEST(least_distance, of_points_that_touch_no_box) {
    std::mt19937_64 random(9);
    for (const double size : {1e-300, 1.0, 1e150, 1.7e308}) {
        setting s;
        for (int i = 0; i < 40; ++i) s.mesh.vertices.push_back(nasty_shapes::in_cube(random, size));
        expect_least(s, ccd::least_distance(s.mesh));
    }
    const double huge = std::numeric_limits<double>::max();
    const setting corners{{{{huge, huge, huge}, {-huge, -huge, -huge}}, {}}};
    expect_least(corners, ccd::least_distance(corners.mesh));
}
TEST(least_distance, without_pairs) {
    expect_least({}, ccd::least_distance(ccd::mesh{}));
    const setting one{{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}};
    expect_least(one, ccd::least_distance(one.mesh));
    EXPECT_EQ(ccd::least_distance(one.mesh).low, infinity);
    const ccd::mesh edge{{{0, 0, 0}, {1, 0, 0}}, {}, {{0, 1}}};
    EXPECT_EQ(ccd::least_distance(edge).low, infinity);
}
/// Regression: the search within a growing distance began at 0, and did not end.
TEST(least_distance, of_subnormal_meshes) {
    for (const double size : {0x1p-1074, 1e-310, 7e-310}) {
        const auto found = ccd::least_distance(ccd::mesh{{{0, 0, 0}, {size, 0, 0}}, {}});
        EXPECT_EQ(found.data.distance, size);
        EXPECT_LE(found.low, size);
        EXPECT_GE(found.high, size);
        EXPECT_LE(found.high - found.low, 2 * 0x1p-1074 + size * 0x1p-22);
    }
}

}  // namespace
