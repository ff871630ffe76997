// Whole steps against brute force, and real frames against their published numbers.
#include <gtest/gtest.h>

#include <algorithm>
#include <ccd/exact.hpp>
#include <ccd/step.hpp>
#include <filesystem>
#include <random>
#include <vector>

#include "ccd/io/mesh_file.hpp"

namespace {

namespace fs = std::filesystem;

/// A soup of triangles on a small grid, so that touching boxes and degenerate contacts abound.
std::pair<ccd::mesh, ccd::mesh> random_soup(std::uint64_t seed, unsigned vertices, unsigned faces) {
    std::mt19937_64 random(seed);
    const auto coordinate = [&random] { return static_cast<double>(random() % 12); };
    ccd::mesh before;
    for (unsigned i = 0; i < vertices; ++i)
        before.vertices.push_back({coordinate(), coordinate(), coordinate()});
    for (unsigned i = 0; i < faces; ++i) {
        const auto v = static_cast<ccd::index>(random() % (vertices - 2));
        before.faces.push_back({v + 2, v, v + 1});
    }
    ccd::mesh after = before;
    for (auto& p : after.vertices) p = {p.x + coordinate() / 4, p.y - coordinate() / 4, p.z};
    return {before, after};
}

struct interval {
    double low, high;
};
template <std::size_t N>
std::array<interval, 3> box_of(const ccd::mesh& a, const ccd::mesh& b,
                               const std::array<ccd::index, N>& element) {
    std::array<interval, 3> box{};
    for (std::size_t k = 0; k < 3; ++k) {
        std::vector<double> x;
        for (const ccd::index v : element)
            for (const ccd::mesh* m : {&a, &b}) {
                const auto& p = m->vertices[v];
                x.push_back(k == 0 ? p.x : k == 1 ? p.y : p.z);
            }
        box[k] = {*std::ranges::min_element(x), *std::ranges::max_element(x)};
    }
    return box;
}
bool touch(const std::array<interval, 3>& a, const std::array<interval, 3>& b) {
    for (std::size_t k = 0; k < 3; ++k)
        if (a[k].low > b[k].high || b[k].low > a[k].high) return false;
    return true;
}

TEST(Step, AgreesWithBruteForce) {
    for (const unsigned seed : {1U, 2U, 3U}) {
        const auto frames = random_soup(seed, 60, 50);
        const ccd::mesh &before = frames.first, &after = frames.second;
        const auto moving = [&](ccd::index v) {
            return ccd::moving_point<double>{before.vertices[v], after.vertices[v]};
        };
        std::size_t vf_candidates = 0, ee_candidates = 0;
        std::vector<ccd::vertex_face_pair> vf;
        for (ccd::index v = 0; v < before.vertices.size(); ++v)
            for (const ccd::face& f : before.faces) {
                if (std::ranges::find(f, v) != f.end()) continue;
                if (!touch(box_of<1>(before, after, {v}), box_of(before, after, f))) continue;
                ++vf_candidates;
                ccd::face sorted = f;
                std::ranges::sort(sorted);
                if (may_collide(ccd::decide_exact(ccd::vertex_face<double>{
                        moving(v), moving(f[0]), moving(f[1]), moving(f[2])})))
                    vf.push_back({v, sorted});
            }
        std::vector<ccd::edge_edge_pair> ee;
        const auto edges = ccd::unique_edges(before.faces);
        for (std::size_t i = 0; i < edges.size(); ++i)
            for (std::size_t j = i + 1; j < edges.size(); ++j) {
                const auto &a = edges[i], &b = edges[j];
                if (a[0] == b[0] || a[0] == b[1] || a[1] == b[0] || a[1] == b[1]) continue;
                if (!touch(box_of(before, after, a), box_of(before, after, b))) continue;
                ++ee_candidates;
                if (may_collide(ccd::decide_exact(ccd::edge_edge<double>{
                        moving(a[0]), moving(a[1]), moving(b[0]), moving(b[1])})))
                    ee.push_back({a, b});
            }
        std::ranges::sort(vf);
        std::ranges::sort(ee);
        for (const int threads : {1, 2}) {
            const auto result =
                ccd::step(before, after, {.method = ccd::method::exact, .threads = threads});
            EXPECT_EQ(result.vertex_face_candidates, vf_candidates);
            EXPECT_EQ(result.edge_edge_candidates, ee_candidates);
            EXPECT_EQ(result.vertex_face, vf);
            EXPECT_EQ(result.edge_edge, ee);
        }
        EXPECT_FALSE(vf.empty());
        EXPECT_FALSE(ee.empty());
    }
}

TEST(Step, RefusesFramesThatDoNotBelongTogether) {
    auto [before, after] = random_soup(1, 10, 5);
    const ccd::step_options options{};
    ccd::mesh other = after;
    other.faces.pop_back();
    EXPECT_THROW(ccd::step(before, other, options), std::invalid_argument);
    other = after;
    other.vertices[3].y = std::numeric_limits<double>::infinity();
    EXPECT_THROW(ccd::step(before, other, options), std::invalid_argument);
    before.faces[0][1] = after.faces[0][1] = 10;
    EXPECT_THROW(ccd::step(before, after, options), std::invalid_argument);
    EXPECT_TRUE(ccd::step({}, {}, options).vertex_face.empty());
}

TEST(Step, ConservativeMethodsReportEveryExactCollision) {
    const fs::path scene = fs::path(ERRBOUND_SCENES) / "cloth-over-ball";
    const auto before = ccd::io::read_mesh(scene / "frame0.ply");
    const auto after = ccd::io::read_mesh(scene / "frame1.ply");
    const auto exact = ccd::step(before, after, {.method = ccd::method::exact});
    EXPECT_FALSE(exact.vertex_face.empty());
    EXPECT_FALSE(exact.edge_edge.empty());
    for (const auto m : {ccd::method::safe, ccd::method::tight}) {
        const auto result = ccd::step(before, after, {.method = m});
        EXPECT_TRUE(std::ranges::includes(result.vertex_face, exact.vertex_face));
        EXPECT_TRUE(std::ranges::includes(result.edge_edge, exact.edge_edge));
    }
}

struct scene {
    const char *name, *before, *after;
    std::size_t vf_candidates, ee_candidates, vf, ee;
};

class RealScene : public testing::TestWithParam<scene> {};

TEST_P(RealScene, HasItsKnownNumbers) {
    const scene& s = GetParam();
    const fs::path frames = fs::path(ERRBOUND_SHARED_DATA) / "scenes" / s.name / "frames";
    if (!fs::exists(frames)) GTEST_SKIP() << "skipped: no real frames at " << frames;
    const auto before = ccd::io::read_mesh(frames / s.before);
    const auto after = ccd::io::read_mesh(frames / s.after);
    const auto exact = ccd::step(before, after, {.method = ccd::method::exact});
    EXPECT_EQ(exact.vertex_face_candidates, s.vf_candidates);
    EXPECT_EQ(exact.edge_edge_candidates, s.ee_candidates);
    EXPECT_EQ(exact.vertex_face.size(), s.vf);
    EXPECT_EQ(exact.edge_edge.size(), s.ee);
    const auto tight = ccd::step(before, after, {.method = ccd::method::tight});
    EXPECT_TRUE(std::ranges::includes(tight.vertex_face, exact.vertex_face));
    EXPECT_TRUE(std::ranges::includes(tight.edge_edge, exact.edge_edge));
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, RealScene,
    testing::Values(scene{"cloth-funnel", "227.ply", "228.ply", 7319, 33770, 27, 107},
                    scene{"cloth-ball", "cloth_ball92.ply", "cloth_ball93.ply", 1655541, 5197332,
                          19032, 94822}),
    [](const auto& info) { return info.index == 0 ? "ClothFunnel" : "ClothBall"; });

}  // namespace
