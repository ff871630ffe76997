// Steps that are certainly free: in a step to the returned positions, no pair touches except those
// that touched at the start. tests/soak has random meshes of all families, with groups, distances,
// in the plane and a last place apart, compared with the oracle.
#include <gtest/gtest.h>

#include <array>
#include <ccd/advance.hpp>
#include <ccd/nearness.hpp>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <span>
#include <vector>

#include "ccd/step/advance/advancing.hpp"
#include "tests/ccd/step/expect_advances.hpp"
#include "tests/ccd/step/nasty_shapes.hpp"

namespace {

using brute_force::expect_free;
using brute_force::goes_far;
using brute_force::random_mixture;
using brute_force::random_soup;
using brute_force::two_frames;
using ccd::outcome;

TEST(Advance, GoesAllTheWayWhereThatIsFree) {
    const ccd::mesh before{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.1, 0.1, 1}}, {{0, 1, 2}}};
    ccd::mesh after = before;
    after.vertices[3] = {0.3, 0.7, 0x1p-1074};
    const auto result = expect_free({before, after});
    EXPECT_EQ(result.fraction, 1);
    EXPECT_EQ(result.positions, after.vertices);
    EXPECT_EQ(result.first_contact.outcome, outcome::separate);
}

/// std::lerp(-1, -0.0, 1) and std::lerp(-0.0, 1, 0) are +0.0.
TEST(Advance, KeepsNegativeZerosAtBothEnds) {
    const auto signs_of = [](const ccd::point<double>& p) {
        return std::array{std::signbit(p.x), std::signbit(p.y), std::signbit(p.z)};
    };
    const std::vector<ccd::point<double>> ends{{-0.0, 0.0, -0.0}, {1, -1, -0.0}};
    for (const bool reversed : {false, true}) {
        const ccd::mesh before{{ends[reversed]}, {}}, after{{ends[!reversed]}, {}};
        const auto all = ccd::advance(before, after);
        ASSERT_EQ(all.fraction, 1);
        EXPECT_EQ(signs_of(all.positions[0]), signs_of(after.vertices[0]));
    }
    const ccd::moving_point<double> way{{-0.0, -0.0, -0.0}, {1, -1, 0.0}};
    EXPECT_EQ(signs_of(ccd::detail::between(way, 0, 0)), signs_of(way.t0));
    EXPECT_EQ(signs_of(ccd::detail::between(way, 1, 0)), signs_of(way.t1));
}

TEST(Advance, StopsBeforeTheFirstContact) {
    const ccd::mesh before{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.1, 0.1, 1}}, {{0, 1, 2}}};
    ccd::mesh after = before;
    after.vertices[3].z = -2;
    const auto result = expect_free({before, after});
    EXPECT_EQ(result.first_contact.low, 1.0 / 3);
    EXPECT_LE(result.fraction, 1.0 / 3);
    EXPECT_GT(result.fraction, 1.0 / 3 - 0x1p-40);
}

TEST(Advance, IsFreeAtEveryScale) {
    for (const auto& shape : nasty_shapes::shapes) {
        SCOPED_TRACE(shape.name);
        expect_free(nasty_shapes::triangles(shape, 1));
    }
}

TEST(Advance, LeavesOutWhatTouchesAtTheStart) {
    // A vertex on a face passes through it, another falls onto it.
    const ccd::mesh before{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.25, 0.25, 0}, {0.5, 0.25, 1}},
                           {{0, 1, 2}}};
    ccd::mesh after = before;
    after.vertices[3].z = -1;
    after.vertices[4].z = -1;
    const auto result = expect_free({before, after});
    EXPECT_EQ(result.touching_at_start.vertex_face,
              (std::vector<ccd::vertex_face_pair>{{3, 0, 1, 2}}));
    EXPECT_EQ(result.first_contact.low, 0.5);
    EXPECT_TRUE(goes_far(result));
}

/// Four triangles, each over a floor, far from each other: two pairs touch, at different times.
two_frames four_bodies() {
    ccd::mesh before;
    for (unsigned body = 0; body < 4; ++body) {
        const double x = 10.0 * body;
        const auto v = ccd::vertex_index(before.vertices.size());
        for (const double z : {0.0, 1.0})
            for (const auto& [dx, dy] : {std::pair(0.0, 0.0), {1.0, 0.0}, {0.0, 1.0}})
                before.vertices.push_back({x + dx + z / 8, dy + z / 8, z});
        before.faces.push_back({v, v + 1, v + 2});
        before.faces.push_back({v + 3, v + 4, v + 5});
    }
    ccd::mesh after = before;
    for (unsigned v = 0; v < after.vertices.size(); ++v)
        if (v % 6 > 2) after.vertices[v].z -= std::array{2.0, 0.5, 4.0, 0.9}[v / 6];
    return {before, after};
}

TEST(AdvanceByGroups, ContactsHoldOnlyTheirIsland) {
    const auto at = four_bodies();
    const auto whole = expect_free(at);
    EXPECT_EQ(whole.first_contact.low, 0.25);
    EXPECT_EQ(whole.fractions, std::vector<double>(24, whole.fraction));
    const auto bodies = ccd::connected_parts(at.first.faces, at.first.edges, 24);
    EXPECT_EQ(bodies[0], 0);
    EXPECT_EQ(bodies[23], 7);
    const auto result = expect_free(at, {.groups = bodies});
    EXPECT_EQ(result.fraction, whole.fraction);
    for (unsigned v = 0; v < 24; ++v) {
        const double first = std::array{0.5, 1.0, 0.25, 1.0}[v / 6];
        EXPECT_GE(result.fractions[v], 0.99 * first);
        if (first == 1)
            EXPECT_EQ(result.positions[v], at.second.vertices[v]);
        else
            EXPECT_LT(result.fractions[v], first);
    }
}

TEST(AdvanceByGroups, GroupsThatMeetOnlyAsOneIsHeldBecomeOne) {
    // Three points on a line. The wall stops the second; the first, which would have followed it,
    // runs into it.
    const ccd::mesh before{{{0, 0, 0}, {1, 0, 0}, {2, -1, -1}, {2, 1, -1}, {2, 0, 1}}, {{2, 3, 4}}};
    ccd::mesh after = before;
    after.vertices[0].x = 3;
    after.vertices[1].x = 4;
    const std::vector<int> groups{0, 1, 2, 2, 2};
    const auto result = expect_free({before, after}, {.groups = groups});
    EXPECT_EQ(result.fractions[0], result.fractions[1]);
    EXPECT_GT(result.fractions[1], 0.33);
    EXPECT_LT(result.fractions[1], 1.0 / 3);
}

TEST(AdvanceByGroups, RefusesGroupsOfOtherVertices) {
    const auto at = random_mixture(1);
    const std::vector<int> groups(3);
    EXPECT_THROW(ccd::advance(at.first, at.second, {.groups = groups}), std::invalid_argument);
}

/// Regression: the pair was skipped and passed through.
TEST(AdvanceKeepingADistance, NearPairsDoNotTouch) {
    const ccd::mesh before{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.25, 0.25, 0.5}}, {{0, 1, 2}}};
    ccd::mesh after = before;
    after.vertices[3].z = -0.5;
    const auto result = expect_free({before, after}, {.distances = {0.75}, .keep = 0});
    EXPECT_EQ(result.near_at_start.vertex_face, (std::vector<ccd::vertex_face_pair>{{3, 0, 1, 2}}));
    EXPECT_EQ(result.touching_at_start, ccd::pair_lists());
    EXPECT_GE(result.fraction, 0.99 * 0.5);
    EXPECT_LT(result.fraction, 0.5);
}

TEST(Advance, NamesThePairsThatLimitIt) {
    const auto bodies = four_bodies();
    for (const bool by_parts : {false, true}) {
        const auto parts =
            ccd::connected_parts(bodies.first.faces, {}, bodies.first.vertices.size());
        const auto result = ccd::advance(
            bodies.first, bodies.second,
            {.groups = by_parts ? std::span<const int>(parts) : std::span<const int>()});
        const auto whole = ccd::step(bodies.first, bodies.second, {.first_contact = true});
        EXPECT_EQ(result.first_contact, whole.first_contact);
        EXPECT_EQ(result.first_pairs, whole.first_pairs);
        EXPECT_GT(number_of(result.first_pairs), 0U);
    }
}

TEST(Advance, KeepsAGapIfConservative) {
    const ccd::mesh before{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.1, 0.1, 1}}, {{0, 1, 2}}};
    ccd::mesh after = before;
    after.vertices[3].z = -1;
    const auto result = expect_free({before, after}, {.conservative = 0.75});
    EXPECT_EQ(result.first_contact.low, 0.5);
    EXPECT_EQ(result.fraction, 0.75 * std::nextafter(0.5, 0));
    for (const double bad : {0.0, -1.0, 1.5, std::nan("")})
        EXPECT_THROW(ccd::advance(before, after, {.conservative = bad}), std::invalid_argument);
}

/// Both forms of x + alpha * p.
std::array<ccd::mesh, 2> moved(const ccd::mesh& x, const ccd::mesh& p, double alpha) {
    std::array<ccd::mesh, 2> ends{x, x};
    for (std::size_t v = 0; v < x.vertices.size(); ++v)
        for (double ccd::point<double>::*k :
             {&ccd::point<double>::x, &ccd::point<double>::y, &ccd::point<double>::z}) {
            volatile double product = alpha * (p.vertices[v].*k);
            ends[0].vertices[v].*k = x.vertices[v].*k + product;
            ends[1].vertices[v].*k = std::fma(alpha, p.vertices[v].*k, x.vertices[v].*k);
        }
    return ends;
}

ccd::advance_result expect_free_line(const ccd::mesh& x, const ccd::mesh& p,
                                     const ccd::advance_options& options = {}) {
    ccd::mesh_steps steps(x);
    const auto result = ccd::free_step(steps, {x, p}, options);
    const auto ends = moved(x, p, result.fraction);
    EXPECT_EQ(result.positions, ends[0].vertices);
    for (const ccd::mesh& end : ends) {
        ccd::advance_result as_advance = result;
        as_advance.positions = end.vertices;
        brute_force::expect_none_but_told(steps, x, as_advance, options.distances);
    }
    return result;
}

ccd::mesh displacements(const two_frames& at) {
    ccd::mesh p = at.second;
    for (std::size_t v = 0; v < p.vertices.size(); ++v) {
        const auto &x = at.first.vertices[v], &y = at.second.vertices[v];
        p.vertices[v] = {y.x / 2 - x.x / 2, y.y / 2 - x.y / 2, y.z / 2 - x.z / 2};
    }
    return p;
}

TEST(FreeStep, IsFreeForBothFormsAtEveryScale) {
    for (const auto& shape : nasty_shapes::shapes) {
        SCOPED_TRACE(shape.name);
        const auto at = nasty_shapes::triangles(shape, 7);
        const ccd::mesh p = displacements(at);
        const auto result = expect_free_line(at.first, p);
        const double first =
            result.first_contact.outcome == outcome::collides ? result.first_contact.low : 1;
        EXPECT_LE(result.fraction, first);
        EXPECT_EQ(first<1, number_of(result.first_pairs)> 0);
        const auto with_gap = expect_free_line(at.first, p, {.conservative = 0.8});
        EXPECT_LE(with_gap.fraction, std::max(0.8 * first, first == 1 ? 1.0 : 0.0));
        expect_free_line(at.first, p, {.distances = {0.0625}});
    }
}

TEST(FreeStep, RefusesGroupsAndDisplacementsThatAreNotFinite) {
    const auto at = random_mixture(1);
    ccd::mesh p = displacements(at);
    ccd::mesh_steps steps(at.first);
    const std::vector<int> groups(p.vertices.size());
    EXPECT_THROW(ccd::free_step(steps, {at.first, p}, {.groups = groups}), std::invalid_argument);
    p.vertices[2].y = std::numeric_limits<double>::infinity();
    EXPECT_THROW(ccd::free_step(steps, {at.first, p}), std::invalid_argument);
}

TEST(FreeStep, MayOverflow) {
    constexpr double most = std::numeric_limits<double>::max();
    const ccd::mesh x{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.1, 0.1, 1}, {most, 0, 0}}, {{0, 1, 2}}};
    ccd::mesh p = x;
    for (auto& q : p.vertices) q = {0, 0, 0};
    p.vertices[3] = {0, 0, -most};
    p.vertices[4] = {most, 0, 0};
    const auto result = expect_free_line(x, p);
    EXPECT_LE(result.fraction, 1 / most);
    EXPECT_GT(result.fraction, 0);
}

/// Four vertices fall onto a plate while they slide along it, one of them lower than the others.
two_frames falling_onto_a_plate() {
    ccd::mesh before{{{-9, -9, 0}, {9, -9, 0}, {0, 9, 0}, {0, 0, 0.5}, {1, 0, 0.5}, {0, 1, 2}},
                     {{0, 1, 2}, {3, 4, 5}}};
    ccd::mesh after = before;
    for (std::size_t v = 3; v < 6; ++v) after.vertices[v] = {before.vertices[v].x + 1, 0, -0.25};
    return {before, after};
}

TEST(AdvanceByVertex, GoesAtLeastAsFarAsByGroups) {
    const auto expect_all = [](const two_frames& at, const char* what) {
        SCOPED_TRACE(what);
        std::vector<int> groups(at.first.vertices.size());
        std::iota(groups.begin(), groups.end(), 0);
        const auto by_groups = ccd::advance(at.first, at.second, {.groups = groups});
        const auto result = expect_free(at, {.each_vertex = true, .threads = 1});
        for (std::size_t v = 0; v < groups.size(); ++v)
            EXPECT_GE(result.fractions[v], by_groups.fractions[v]);
        EXPECT_EQ(result.positions,
                  ccd::advance(at.first, at.second, {.each_vertex = true, .threads = 3}).positions);
        expect_free(at, {.each_vertex = true, .distances = {0.0625}, .keep = 0.25});
        return std::reduce(result.fractions.begin(), result.fractions.end()) -
               std::reduce(by_groups.fractions.begin(), by_groups.fractions.end());
    };
    EXPECT_GT(expect_all(falling_onto_a_plate(), "plate"), 0);
    for (const auto& shape : nasty_shapes::shapes)
        expect_all(nasty_shapes::triangles(shape, 9), shape.name);
}

TEST(AdvanceByVertex, LimitsOnlyVerticesThatComeNear) {
    const auto [before, after] = falling_onto_a_plate();
    const auto result = expect_free({before, after}, {.each_vertex = true});
    EXPECT_GE(result.fractions[3], 0.59);
    EXPECT_GE(result.fractions[5], 0.79);
    EXPECT_LT(result.fractions[3], result.fractions[5]);
}

/// Regression: rounding moved vertices at rest behind the plane, which gave 0/0.
TEST(AdvanceByVertex, VerticesAtRestAreNotLimited) {
    for (const auto& points :
         {std::array<ccd::point<double>, 4>{
              {{0.1, -0.6, -0.1}, {0, -0.3, 0.8}, {-0.2, 0.7, -0.8}, {0.3, -0.1, 0.1}}},
          {{{0, 0.1, 0.8}, {0.3, 0.2, 0}, {0, -0.7, -0.4}, {0.3, 0, 0.2}}}}) {
        const ccd::mesh before{{points.begin(), points.end()}, {{0, 1, 2}}};
        ccd::mesh after = before;
        after.vertices[3].x = -1;
        const auto result = expect_free({before, after}, {.each_vertex = true});
        for (std::size_t v = 0; v < 3; ++v) EXPECT_EQ(result.fractions[v], 1);
        EXPECT_LT(result.fractions[3], 1);
    }
}

/// Regression: the distance overflows, and no contact was found.
TEST(AdvanceKeepingADistance, OverflowingDistancesAreKept) {
    constexpr double far = 1.4e308;
    const ccd::mesh before{{{-far, 0, 0}, {far, 0, 0}}, {}};
    const ccd::mesh after{{{far, 0, 0}, {-far, 0, 0}}, {}};
    const std::vector<double> thickness{1.5e308, 1.5e308};
    EXPECT_LT(expect_free({before, after}, {.distances = {0, thickness}, .keep = 0.1}).fraction,
              0.5);
}

TEST(Advance, RefusesNullPositions) {
    ccd::mesh_steps steps({}, {}, 3);
    const double at[9] = {};
    EXPECT_THROW(ccd::advance(steps, {nullptr, at, 3}), std::invalid_argument);
    EXPECT_THROW(ccd::advance(steps, {at, nullptr, 3}), std::invalid_argument);
    EXPECT_THROW(ccd::free_step(steps, {at, nullptr, 3}), std::invalid_argument);
}

/// Two elements that rest at a distance near 1, in a random orientation and scale. The first one
/// slides along the other.
struct resting_contact {
    std::mt19937_64 random;
    double scale;
    ccd::point<double> axes[3];
    std::array<ccd::point<double>, 2> first;  // along the axes, in units of the scale
    std::size_t size;                         // of the first element
    ccd::mesh mesh;

    explicit resting_contact(std::uint64_t seed)
        : random(seed), scale(std::ldexp(1, static_cast<int>(seed % 41) - 20)), size(1) {
        const auto [a, b, c] = nasty_shapes::in_cube(random, 1);
        // The Cayley map of a random vector is a rotation.
        const double n = 1 + a * a + b * b + c * c;
        axes[0] = {(1 + a * a - b * b - c * c) / n, 2 * (a * b + c) / n, 2 * (a * c - b) / n};
        axes[1] = {2 * (a * b - c) / n, (1 - a * a + b * b - c * c) / n, 2 * (b * c + a) / n};
        axes[2] = {2 * (a * c + b) / n, 2 * (b * c - a) / n, (1 - a * a - b * b + c * c) / n};
        const double gap = 1 + 1e-6 * part();
        first = {{{part(), part(), gap}, {part(), 30, gap}}};
        mesh.vertices = {placed({-90, -80, 0}), placed({90, -80, 0}), placed({0, 90, 0})};
        if (seed % 3 == 0) {
            mesh.faces = {{0, 1, 2}};
        } else {
            mesh.vertices = {placed({-90, 0, 0}), placed({90, 0, 0})};
            mesh.edges = {{0, 1}};
            first[0].y = seed % 3 == 1 ? 0 : -30;  // a point on the line of the edge, or a rod
            size = seed % 3;
        }
        const auto count = static_cast<ccd::vertex_index>(mesh.vertices.size());
        if (size == 2) mesh.edges.push_back({count, count + 1});
        for (std::size_t i = 0; i < size; ++i) mesh.vertices.push_back(placed(first[i]));
    }
    double part() { return 2e-4 * static_cast<double>(random() % 10000) - 1; }
    ccd::point<double> placed(const ccd::point<double>& p) const {
        const auto& [x, y, z] = axes;
        return {scale * (p.x * x.x + p.y * y.x + p.z * z.x),
                scale * (p.x * x.y + p.y * y.y + p.z * z.y),
                scale * (p.x * x.z + p.y * y.z + p.z * z.z)};
    }
    /// The goal of a step: the first element slides by up to 1, to a gap near 1.
    ccd::mesh next_goal() {
        ccd::mesh goal = mesh;
        const double x = part(), y = size == 1 && mesh.faces.empty() ? 0 : part(),
                     gap = 1 + 9e-4 * part();
        for (std::size_t i = 0; i < size; ++i) {
            first[i] = {first[i].x + x, first[i].y + y, gap};
            goal.vertices[goal.vertices.size() - size + i] = placed(first[i]);
        }
        return goal;
    }
};

TEST(AdvanceKeepingADistance, RestingContactsSlideOn) {
    constexpr int contacts = 1000, slides = 10;
    for (const double keep : {0.0, ccd::advance_options().keep}) {
        int whole = 0, locked = 0;
        double least = 1;
        for (std::uint64_t seed = 1; seed <= contacts; ++seed) {
            resting_contact contact(seed);
            ccd::mesh_steps steps(contact.mesh);
            const double start = ccd::least_distance(contact.mesh).low;
            for (int i = 0; i < slides; ++i) {
                const ccd::mesh goal = contact.next_goal();
                const auto result = ccd::advance(steps, {contact.mesh, goal},
                                                 {.distances = {contact.scale}, .keep = keep});
                const ccd::vertex_rows way(contact.mesh.vertices, result.positions);
                const ccd::pair_distances kept{keep == 0 ? 0 : keep * start};
                EXPECT_EQ(number_of(steps.run(way, {.distances = kept}).pairs), 0U) << seed;
                whole += result.fraction == 1;
                locked += result.fraction < 1e-9;
                contact.mesh.vertices = result.positions;
                least = std::min(least, ccd::least_distance(contact.mesh).low / start);
            }
        }
        std::printf(
            "keep %.1f: %d of %d steps go the whole way, %d less than 1e-9; least distance "
            "%.4f of the first\n",
            keep, whole, contacts * slides, locked, least);
        EXPECT_TRUE(keep == 0 ? locked > contacts : whole == contacts * slides);
        EXPECT_GE(least, keep);
    }
}

TEST(AdvanceKeepingADistance, NearPairsKeepAShareOfTheirDistance) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        auto at = random_soup(seed, 24, 8);
        std::mt19937_64 random(seed);
        for (ccd::mesh* frame : {&at.first, &at.second})
            for (auto& q : frame->vertices)
                q = nasty_shapes::operator+(q, nasty_shapes::in_cube(random, 0.5));
        constexpr double wanted = 2, keep = 0.3;
        const auto result = expect_free(at, {.distances = {wanted}, .keep = keep});
        const auto near = ccd::near_pairs(at.first, {wanted});
        const ccd::vertex_rows moved(result.positions, result.positions);
        const ccd::vertex_rows rows(at.first, at.second);
        std::size_t tested = 0;
        ccd::for_each_kind([&]<ccd::kind K>() {
            for (const auto& pair : near.pairs.of<K>()) {
                const auto before = nearness_of(query_of(rows, pair));
                if (before.touches()) continue;
                const double after = nearness_of(query_of(moved, pair)).distance;
                EXPECT_GE(after, keep * before.distance * (1 - 1e-6));
                ++tested;
            }
        });
        EXPECT_GT(tested, 0U);
    }
    const auto at = random_mixture(1);
    for (const double bad : {-0.1, 1.0, std::nan("")})
        EXPECT_THROW(ccd::advance(at.first, at.second, {.keep = bad}), std::invalid_argument);
}

}  // namespace
