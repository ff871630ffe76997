// Whole steps against brute force, and real frames against their published numbers.
#include <gtest/gtest.h>

#include <algorithm>
#include <ccd/io/mesh_file.hpp>
#include <ccd/method.hpp>
#include <ccd/step.hpp>
#include <cfenv>
#include <cmath>
#include <filesystem>
#include <limits>
#include <random>
#include <set>
#include <utility>
#include <vector>

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

using box = std::array<std::pair<double, double>, 3>;

template <std::size_t N>
box box_of(const ccd::mesh& a, const ccd::mesh& b, const std::array<ccd::index, N>& element) {
    box result{};
    for (std::size_t k = 0; k < 3; ++k) {
        std::vector<double> x;
        for (const ccd::index v : element)
            for (const ccd::mesh* m : {&a, &b}) {
                const auto& p = m->vertices[v];
                x.push_back(k == 0 ? p.x : k == 1 ? p.y : p.z);
            }
        result[k] = {*std::ranges::min_element(x), *std::ranges::max_element(x)};
    }
    return result;
}
bool touch(const box& a, const box& b) {
    for (std::size_t k = 0; k < 3; ++k)
        if (a[k].first > b[k].second || b[k].first > a[k].second) return false;
    return true;
}

/// Every pair looked at.
ccd::step_result brute_force(const ccd::mesh& before, const ccd::mesh& after, ccd::method method) {
    const auto moving = [&](ccd::index v) {
        return ccd::moving_point<double>{before.vertices[v], after.vertices[v]};
    };
    ccd::step_result result;
    std::vector<box> face_boxes;
    for (const ccd::face& f : before.faces) face_boxes.push_back(box_of(before, after, f));
    for (ccd::index v = 0; v < before.vertices.size(); ++v) {
        const box v_box = box_of<1>(before, after, {v});
        for (std::size_t i = 0; i < face_boxes.size(); ++i) {
            const ccd::face& f = before.faces[i];
            if (std::ranges::find(f, v) != f.end() || !touch(v_box, face_boxes[i])) continue;
            ++result.vertex_face_candidates;
            ccd::face sorted = f;
            std::ranges::sort(sorted);
            if (may_collide(ccd::decide(
                    method,
                    ccd::vertex_face<double>{moving(v), moving(f[0]), moving(f[1]), moving(f[2])})))
                result.vertex_face.push_back({v, sorted[0], sorted[1], sorted[2]});
        }
    }
    const auto edges = ccd::unique_edges(before.faces);
    std::vector<box> edge_boxes;
    for (const ccd::edge& e : edges) edge_boxes.push_back(box_of(before, after, e));
    for (std::size_t i = 0; i < edges.size(); ++i)
        for (std::size_t j = i + 1; j < edges.size(); ++j) {
            const auto &a = edges[i], &b = edges[j];
            if (a[0] == b[0] || a[0] == b[1] || a[1] == b[0] || a[1] == b[1]) continue;
            if (!touch(edge_boxes[i], edge_boxes[j])) continue;
            ++result.edge_edge_candidates;
            if (may_collide(
                    ccd::decide(method, ccd::edge_edge<double>{moving(a[0]), moving(a[1]),
                                                               moving(b[0]), moving(b[1])})))
                result.edge_edge.push_back({a[0], a[1], b[0], b[1]});
        }
    std::ranges::sort(result.vertex_face);
    std::ranges::sort(result.edge_edge);
    return result;
}

void expect_as_by_brute_force(const ccd::mesh& before, const ccd::mesh& after, ccd::method method) {
    const auto expected = brute_force(before, after, method);
    for (const int threads : {1, 2, 3}) {
        const auto result = ccd::step(before, after, {.method = method, .threads = threads});
        EXPECT_EQ(result.vertex_face_candidates, expected.vertex_face_candidates);
        EXPECT_EQ(result.edge_edge_candidates, expected.edge_edge_candidates);
        EXPECT_EQ(result.vertex_face, expected.vertex_face);
        EXPECT_EQ(result.edge_edge, expected.edge_edge);
    }
}

TEST(Step, AgreesWithBruteForce) {
    for (const unsigned seed : {1U, 2U, 3U}) {
        const auto [before, after] = random_soup(seed, 60, 50);
        expect_as_by_brute_force(before, after, ccd::method::exact);
        EXPECT_FALSE(ccd::step(before, after).vertex_face.empty());
        EXPECT_FALSE(ccd::step(before, after).edge_edge.empty());
    }
}

using generator = std::mt19937_64;
double uniform(generator& random) {
    return std::uniform_real_distribution<double>(-1, 1)(random);
}
ccd::point<double> in_cube(generator& random, double size) {
    return {size * uniform(random), size * uniform(random), size * uniform(random)};
}
ccd::point<double> operator+(const ccd::point<double>& p, const ccd::point<double>& q) {
    return {p.x + q.x, p.y + q.y, p.z + q.z};
}

/// Places patch i of a soup: where its vertices start, and where they end.
struct shape {
    const char* name;
    ccd::moving_point<double> (*vertex)(generator&, unsigned patch);
};

const shape shapes[] = {
    {"AllInOnePoint",
     [](auto&, unsigned) {
         return ccd::moving_point<double>{{1, 2, 3}, {1, 2, 3}};
     }},
    {"AllInOnePlane",
     [](auto& random, unsigned) {
         const auto p = in_cube(random, 1), q = in_cube(random, 0.1);
         return ccd::moving_point<double>{{p.x, p.y, 0.0}, {p.x + q.x, p.y + q.y, -0.0}};
     }},
    {"OneLine",
     [](auto& random, unsigned patch) {
         const double x = patch + uniform(random);
         return ccd::moving_point<double>{{x, x, x}, {x, x, x}};
     }},
    {"Clusters",
     [](auto& random, unsigned patch) {
         generator of_cluster(patch % 5);
         const auto p = in_cube(of_cluster, 1e6) + in_cube(random, 1e-3);
         return ccd::moving_point<double>{p, p + in_cube(random, 1e-3)};
     }},
    {"CloserThanFloats",
     [](auto& random, unsigned patch) {
         generator of_cluster(patch % 3);
         const auto p = in_cube(of_cluster, 1) + in_cube(random, 1e-9);
         return ccd::moving_point<double>{p, p + in_cube(random, 1e-9)};
     }},
    {"OneFarOff",
     [](auto& random, unsigned patch) {
         const auto p = in_cube(random, 1);
         return patch == 0 ? ccd::moving_point<double>{{1e200, 1, 1}, {1e200, 1, 1}}
                           : ccd::moving_point<double>{p, p + in_cube(random, 0.1)};
     }},
    {"FewBigAmongManySmall",
     [](auto& random, unsigned patch) {
         generator of_patch(patch);
         const double size = patch % 20 == 0 ? 1 : 0.02;
         const auto p = in_cube(of_patch, 1) + in_cube(random, size);
         return ccd::moving_point<double>{p, p + in_cube(random, 0.02)};
     }},
    {"FlyingFar",
     [](auto& random, unsigned patch) {
         generator of_patch(patch);
         const auto p = in_cube(of_patch, 100) + in_cube(random, 0.1);
         return ccd::moving_point<double>{p, p + in_cube(of_patch, 1000)};
     }},
    {"Needles",
     [](auto& random, unsigned patch) {
         generator of_patch(patch);
         auto p = in_cube(of_patch, 1);
         (patch % 3 == 0 ? p.x : patch % 3 == 1 ? p.y : p.z) += uniform(random);
         return ccd::moving_point<double>{p, p};
     }},
    {"Huge",
     [](auto& random, unsigned) {
         constexpr double most = std::numeric_limits<double>::max();
         return ccd::moving_point<double>{in_cube(random, most), in_cube(random, most)};
     }},
    {"Large",
     [](auto& random, unsigned patch) {
         generator of_patch(patch);
         const auto p = in_cube(of_patch, 1e300) + in_cube(random, 1e299);
         return ccd::moving_point<double>{p, p};
     }},
    {"Tiny",
     [](auto& random, unsigned) {
         return ccd::moving_point<double>{in_cube(random, 1e-310), in_cube(random, 1e-310)};
     }},
    {"FewUlpsOfTheLeast",
     [](auto& random, unsigned) {
         constexpr double least = std::numeric_limits<double>::denorm_min();
         const auto few = [&random] { return least * static_cast<double>(random() % 3); };
         return ccd::moving_point<double>{{few(), few(), few()}, {few(), few(), few()}};
     }},
    {"AllMagnitudes",
     [](auto& random, unsigned patch) {
         generator of_patch(patch);
         const double size = std::ldexp(1, static_cast<int>(of_patch() % 2000) - 1000);
         return ccd::moving_point<double>{in_cube(random, size), in_cube(random, size)};
     }},
};

class NastyShape : public testing::TestWithParam<shape> {};

TEST_P(NastyShape, AgreesWithBruteForce) {
    for (const unsigned patches : {1U, 2U, 40U}) {
        for (const unsigned seed : {1U, 2U}) {
            // Patches of six vertices and five faces, one of them degenerate; some joined.
            generator random(seed);
            ccd::mesh before, after;
            for (unsigned patch = 0; patch < patches; ++patch) {
                const ccd::index v = 6 * patch;
                for (unsigned i = 0; i < 6; ++i) {
                    const auto p = GetParam().vertex(random, patch);
                    before.vertices.push_back(p.t0);
                    after.vertices.push_back(p.t1);
                }
                for (const ccd::face f :
                     {ccd::face{v, v + 1, v + 2}, ccd::face{v + 3, v + 2, v + 1},
                      ccd::face{v + 5, v + 4, v + 3}, ccd::face{v, v + 5, v},
                      ccd::face{v + 4, v, v > 0 ? v - 1 : v + 5}})
                    before.faces.push_back(f);
            }
            after.faces = before.faces;
            expect_as_by_brute_force(before, after, ccd::method::float_);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Shapes, NastyShape, testing::ValuesIn(shapes),
                         [](const auto& info) { return info.param.name; });

TEST(Step, FindsInEachOfManyCopiesWhatItFindsInOne) {
    const auto [before, after] = random_soup(4, 60, 50);
    const auto one = brute_force(before, after, ccd::method::exact);
    constexpr ccd::index copies = 120;
    ccd::mesh all_before, all_after;
    std::vector<ccd::vertex_face_pair> vertex_face;
    std::vector<ccd::edge_edge_pair> edge_edge;
    for (ccd::index copy = 0; copy < copies; ++copy) {
        const ccd::index first = 60 * copy;
        const ccd::point<double> offset{100.0 * (copy % 5), 100.0 * (copy / 5), 0};
        for (ccd::index v = 0; v < 60; ++v) {
            all_before.vertices.push_back(before.vertices[v] + offset);
            all_after.vertices.push_back(after.vertices[v] + offset);
        }
        for (const auto& [a, b, c] : before.faces)
            all_before.faces.push_back({first + a, first + b, first + c});
        for (const auto& [v, f0, f1, f2] : one.vertex_face)
            vertex_face.push_back({first + v, first + f0, first + f1, first + f2});
        for (const auto& [a0, a1, b0, b1] : one.edge_edge)
            edge_edge.push_back({first + a0, first + a1, first + b0, first + b1});
    }
    all_after.faces = all_before.faces;
    for (const int threads : {1, 2, 3}) {
        const auto all = ccd::step(all_before, all_after, {.threads = threads});
        EXPECT_EQ(all.vertex_face_candidates, copies * one.vertex_face_candidates);
        EXPECT_EQ(all.edge_edge_candidates, copies * one.edge_edge_candidates);
        EXPECT_EQ(all.vertex_face, vertex_face);
        EXPECT_EQ(all.edge_edge, edge_edge);
    }
}

TEST(Step, TakesOneFaceAndNone) {
    const ccd::mesh one{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.25, 0.25, 0}}, {{0, 1, 2}}};
    expect_as_by_brute_force(one, one, ccd::method::exact);
    EXPECT_EQ(ccd::step(one, one).vertex_face.size(), 1U);
    const ccd::mesh points{one.vertices, {}};
    expect_as_by_brute_force(points, points, ccd::method::exact);
    const ccd::mesh point{{{0, 0, 0}}, {{0, 0, 0}}};
    expect_as_by_brute_force(point, point, ccd::method::exact);
}

// Flat on one axis, and not: no rounding direction may lose a candidate.
TEST(Step, HoldsInEveryRoundingDirection) {
    ccd::mesh before{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {3, 0.25, 0}, {4, 0, 0}, {4, 1, 0}},
                     {{0, 1, 2}, {3, 4, 5}}};
    ccd::mesh after = before;
    for (std::size_t i = 3; i < 6; ++i) after.vertices[i].x -= 2.75;
    const auto soup = random_soup(7, 60, 50);
    const auto flat_expected = brute_force(before, after, ccd::method::exact);
    const auto soup_expected = brute_force(soup.first, soup.second, ccd::method::exact);
    EXPECT_FALSE(flat_expected.vertex_face.empty());
    for (const int mode : {FE_DOWNWARD, FE_UPWARD, FE_TOWARDZERO, FE_TONEAREST}) {
        std::fesetround(mode);
        const auto flat = ccd::step(before, after);
        const auto deep = ccd::step(soup.first, soup.second);
        std::fesetround(FE_TONEAREST);
        EXPECT_EQ(flat.vertex_face_candidates, flat_expected.vertex_face_candidates);
        EXPECT_EQ(flat.edge_edge_candidates, flat_expected.edge_edge_candidates);
        EXPECT_EQ(flat.vertex_face, flat_expected.vertex_face);
        EXPECT_EQ(flat.edge_edge, flat_expected.edge_edge);
        EXPECT_EQ(deep.vertex_face, soup_expected.vertex_face);
        EXPECT_EQ(deep.edge_edge, soup_expected.edge_edge);
    }
}

TEST(Step, TakesAnEmptyMeshAndRefusesAnUnknownInstructionSet) {
    const auto nothing = ccd::step({}, {});
    EXPECT_EQ(nothing.vertex_face_candidates + nothing.edge_edge_candidates, 0U);
    EXPECT_THROW(ccd::step({}, {}, {.set = ccd::instruction_set(7)}), std::invalid_argument);
}

TEST(Mesh, UniqueEdgesAreThoseOfAllFaces) {
    EXPECT_TRUE(ccd::unique_edges({}).empty());
    EXPECT_TRUE(ccd::unique_edges({{7, 7, 7}}).empty());
    constexpr ccd::index last = std::numeric_limits<ccd::index>::max();
    generator random(1);
    for (const ccd::index range : {3U, 50U, 100000U, last}) {
        std::vector<ccd::face> faces;
        std::set<ccd::edge> expected;
        for (unsigned i = 0; i < 300; ++i) {
            ccd::face f;
            for (auto& v : f) v = range - static_cast<ccd::index>(random() % range);
            faces.push_back(f);
            for (std::size_t k = 0; k < 3; ++k) {
                const auto [v, w] = std::minmax(f[k], f[(k + 1) % 3]);
                if (v != w) expected.insert({v, w});
            }
        }
        const auto edges = ccd::unique_edges(faces);
        EXPECT_TRUE(std::ranges::equal(edges, expected));
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
