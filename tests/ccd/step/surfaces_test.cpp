// Whole steps compared with brute force, and real frames compared with their published numbers; the
// order of elements on a curve.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <ccd/io/mesh_file.hpp>
#include <ccd/method.hpp>
#include <ccd/step.hpp>
#include <cfenv>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "ccd/batch/rounded_positions.hpp"
#include "ccd/batch/threads.hpp"
#include "ccd/step/candidate_search.hpp"
#include "ccd/step/elements.hpp"
#include "ccd/step/order/hilbert_curve.hpp"
#include "tests/ccd/step/expect_steps.hpp"
#include "tests/ccd/step/nasty_shapes.hpp"
#include "tests/support/stored_data.hpp"

namespace {

namespace fs = std::filesystem;

using brute_force::expect_as_by_brute_force;
using brute_force::random_soup;

using nasty_shapes::generator;
using nasty_shapes::shape;
using nasty_shapes::shapes;

class NastyShape : public testing::TestWithParam<shape> {};

TEST_P(NastyShape, AgreesWithBruteForce) {
    for (const unsigned patches : {1U, 2U, 40U}) {
        for (const unsigned seed : {1U, 2U}) {
            // Patches of six vertices and five faces, one of them degenerate; some joined.
            generator random(seed);
            ccd::mesh before, after;
            for (unsigned patch = 0; patch < patches; ++patch) {
                const ccd::vertex_index v = 6 * patch;
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
            expect_as_by_brute_force({before, after}, ccd::method::float_);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Shapes, NastyShape, testing::ValuesIn(shapes),
                         [](const auto& info) { return info.param.name; });

TEST(Step, TakesOneFaceAndNone) {
    const ccd::mesh one{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.25, 0.25, 0}}, {{0, 1, 2}}};
    expect_as_by_brute_force({one, one}, ccd::method::exact);
    EXPECT_EQ(ccd::step(one, one).pairs.vertex_face.size(), 1U);
    const ccd::mesh points{one.vertices, {}};
    expect_as_by_brute_force({points, points}, ccd::method::exact);
    const ccd::mesh point{{{0, 0, 0}}, {{0, 0, 0}}};
    expect_as_by_brute_force({point, point}, ccd::method::exact);
}

// Rounding in any direction loses no candidate, for a mesh that is flat on one axis and for a soup.
TEST(Step, HoldsInEveryRoundingDirection) {
    ccd::mesh before{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {3, 0.25, 0}, {4, 0, 0}, {4, 1, 0}},
                     {{0, 1, 2}, {3, 4, 5}}};
    ccd::mesh after = before;
    for (std::size_t i = 3; i < 6; ++i) after.vertices[i].x -= 2.75;
    const auto soup = random_soup(7, 60, 50);
    const auto flat_expected = brute_force::step({before, after});
    const auto soup_expected = brute_force::step(soup);
    EXPECT_FALSE(flat_expected.pairs.vertex_face.empty());
    for (const int mode : {FE_DOWNWARD, FE_UPWARD, FE_TOWARDZERO, FE_TONEAREST}) {
        const auto in_mode = [mode](const ccd::mesh& first, const ccd::mesh& second) {
            return [&first, &second, mode](const ccd::step_options& options) {
                std::fesetround(mode);
                auto found = ccd::step(first, second, options);
                std::fesetround(FE_TONEAREST);
                return found;
            };
        };
        brute_force::expect_both_ways(flat_expected, {}, in_mode(before, after));
        brute_force::expect_both_ways(soup_expected, {}, in_mode(soup.first, soup.second));
    }
}

ccd::pair_lists found_by_search(const brute_force::two_frames& at, ccd::instruction_set set,
                                const ccd::detail::wanted_candidates& wanted) {
    const ccd::vertex_rows rows(at.first, at.second);
    const ccd::detail::rounded_positions rounded(rows);
    ccd::detail::candidate_search search(at.first.faces, {}, rows.vertices);
    ccd::pair_lists found;
    ccd::candidate_visitor visitor;  // this thread calls it
    visitor.vertex_face = [&](auto block) {
        found.vertex_face.insert(found.vertex_face.end(), block.begin(), block.end());
    };
    visitor.edge_edge = [&](auto block) {
        found.edge_edge.insert(found.edge_edge.end(), block.begin(), block.end());
    };
    ccd::detail::on_threads(1, [&] {
        search.find({rows, rounded}, {.set = set}, visitor, wanted);
    });
    std::ranges::sort(found.vertex_face);
    std::ranges::sort(found.edge_edge);
    return found;
}

/// True if x, y, z, x ± y, y ± z or z ± x separates the features in the same direction at both
/// ends. Precondition: sums of coordinates are doubles.
template <class Query>
bool separated_by_an_axis(const Query& query) {
    using points = std::array<ccd::moving_point<double>, 4>;
    const auto at = std::bit_cast<points>(query);
    constexpr std::size_t first = ccd::kind_traits<ccd::kind_of<Query>>::first_vertices;
    for (const auto& [x, y, z] :
         {std::tuple(1, 0, 0), std::tuple(0, 1, 0), std::tuple(0, 0, 1), std::tuple(1, 1, 0),
          std::tuple(1, -1, 0), std::tuple(0, 1, 1), std::tuple(0, 1, -1), std::tuple(1, 0, 1),
          std::tuple(-1, 0, 1)}) {
        bool below = true, above = true;
        for (const auto end : {&ccd::moving_point<double>::t0, &ccd::moving_point<double>::t1}) {
            const auto along = [&, x = x, y = y, z = z](std::size_t i) {
                const ccd::point<double>& p = at[i].*end;
                return x * p.x + y * p.y + z * p.z;
            };
            for (std::size_t i = 0; i < first; ++i)
                for (std::size_t j = first; j < 4; ++j) {
                    below &= along(i) < along(j);
                    above &= along(i) > along(j);
                }
        }
        if (below || above) return true;
    }
    return false;
}

// On a grid of floats, the search skips exactly the pairs that one of the nine axes separates.
TEST(Search, SkipsExactlyThePairsThatAxesSeparate) {
    const auto at = random_soup(11, 700, 600);
    const auto all = found_by_search(at, ccd::instruction_set::baseline, {});
    for (const ccd::instruction_set set : ccd::instruction_sets()) {
        const auto close = found_by_search(at, set, {.close = true});
        const auto expect = [&](const auto& all_of_kind, const auto& close_of_kind) {
            std::size_t left_out = 0;
            const ccd::vertex_rows rows(at.first, at.second);
            for (const auto& pair : all_of_kind) {
                const bool found = std::ranges::binary_search(close_of_kind, pair);
                ASSERT_EQ(found, !separated_by_an_axis(query_of(rows, pair))) << name(set);
                left_out += !found;
            }
            EXPECT_EQ(close_of_kind.size(), all_of_kind.size() - left_out);
            EXPECT_GT(left_out, all_of_kind.size() / 8);
            EXPECT_GT(close_of_kind.size(), all_of_kind.size() / 8);
        };
        expect(all.vertex_face, close.vertex_face);
        expect(all.edge_edge, close.edge_edge);
    }
}

TEST(Mesh, UniqueEdgesAreThoseOfAllFaces) {
    EXPECT_TRUE(ccd::unique_edges({}).empty());
    const std::vector<ccd::face> point{{7, 7, 7}};
    EXPECT_TRUE(ccd::unique_edges(point).empty());
    constexpr ccd::vertex_index last = std::numeric_limits<ccd::vertex_index>::max();
    generator random(1);
    for (const ccd::vertex_index range : {3U, 50U, 100000U, last}) {
        std::vector<ccd::face> faces;
        std::set<ccd::edge> expected;
        for (unsigned i = 0; i < 300; ++i) {
            ccd::face f;
            for (auto& v : f) v = range - static_cast<ccd::vertex_index>(random() % range);
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

// The curve visits all cells of a cube once, each next to the one before.
TEST(HilbertCurve, GoesFromNeighbourToNeighbour) {
    using ccd::detail::spread_bits;
    for (const unsigned bits : {1U, 2U, 5U}) {
        const std::uint64_t n = std::uint64_t(1) << bits;
        std::vector<std::array<int, 3>> cells(n * n * n, {-1, -1, -1});
        for (std::uint64_t x = 0; x < n; ++x)
            for (std::uint64_t y = 0; y < n; ++y)
                for (std::uint64_t z = 0; z < n; ++z) {
                    const auto morton = spread_bits(x) | spread_bits(y) << 1 | spread_bits(z) << 2;
                    auto& cell = cells.at(ccd::detail::hilbert_position(morton, bits));
                    ASSERT_EQ(cell[0], -1);
                    cell = {static_cast<int>(x), static_cast<int>(y), static_cast<int>(z)};
                }
        for (std::size_t i = 1; i < cells.size(); ++i) {
            int steps = 0;
            for (std::size_t k = 0; k < 3; ++k) steps += std::abs(cells[i][k] - cells[i - 1][k]);
            ASSERT_EQ(steps, 1) << bits << " bits, cell " << i;
        }
    }
}

struct scene {
    const char *name, *before, *after;
    std::size_t vf_candidates, ee_candidates, vf, ee;

    fs::path folder() const {
        const fs::path in_repository = fs::path(ERRBOUND_SCENES) / name;
        return fs::exists(in_repository) ? in_repository
                                         : stored_data::folder() / "scenes" / name / "frames";
    }
};

class RealScene : public testing::TestWithParam<scene> {};

TEST_P(RealScene, HasItsKnownNumbers) {
    const scene& s = GetParam();
    const fs::path frames = s.folder();
    if (!fs::exists(frames)) GTEST_SKIP() << stored_data::missing;
    const auto before = ccd::io::read_mesh(frames / s.before);
    const auto after = ccd::io::read_mesh(frames / s.after);
    const auto exact = ccd::step(before, after, {.count_candidates = true});
    EXPECT_EQ(exact.candidates->vertex_face, s.vf_candidates);
    EXPECT_EQ(exact.candidates->edge_edge, s.ee_candidates);
    for (const ccd::instruction_set set : ccd::instruction_sets())
        for (const int threads : {1, 2, 3}) {
            EXPECT_EQ(ccd::step(before, after, {.threads = threads, .set = set}).pairs, exact.pairs)
                << name(set);
        }
    EXPECT_EQ(exact.pairs.vertex_face.size(), s.vf);
    EXPECT_EQ(exact.pairs.edge_edge.size(), s.ee);
    for (const auto m : {ccd::method::safe, ccd::method::tight}) {
        const auto result = ccd::step(before, after, {.method = m});
        EXPECT_TRUE(std::ranges::includes(result.pairs.vertex_face, exact.pairs.vertex_face));
        EXPECT_TRUE(std::ranges::includes(result.pairs.edge_edge, exact.pairs.edge_edge));
    }
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, RealScene,
    testing::Values(scene{"cloth-over-ball", "frame0.ply", "frame1.ply", 11872, 36882, 100, 345},
                    scene{"cloth-funnel", "227.ply", "228.ply", 7319, 33770, 27, 107},
                    scene{"cloth-ball", "cloth_ball92.ply", "cloth_ball93.ply", 1655541, 5197332,
                          19032, 94822}),
    [](const auto& info) {
        std::string name = info.param.name;
        std::ranges::replace(name, '-', '_');
        return name;
    });

}  // namespace
