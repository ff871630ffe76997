// Steps that are certainly free: in a step to the returned positions, no pair touches except those
// that touched at the start. tests/soak has contacts a last place apart, distances and the plane.
#include <gtest/gtest.h>

#include <array>
#include <ccd/advance.hpp>
#include <cmath>
#include <numeric>

#include "ccd/step/advancing.hpp"
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

TEST(Advance, IsFreeInMeshesOfAllKinds) {
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
        const auto mixture = expect_free(random_mixture(seed));
        EXPECT_TRUE(goes_far(mixture))
            << seed << ": " << mixture.fraction << " of " << mixture.first_contact.low;
        EXPECT_LT(mixture.fraction, 1);
        EXPECT_TRUE(goes_far(expect_free(random_soup(seed, 30, 15)))) << seed;
    }
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

TEST(AdvanceByGroups, IsFreeInMeshesOfAllKinds) {
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
        const auto at = random_mixture(seed);
        const auto whole = expect_free(at);
        std::vector<int> groups(at.first.vertices.size());
        std::iota(groups.begin(), groups.end(), 0);
        for (const auto& by : {groups, ccd::connected_parts(at.first.faces, at.first.edges,
                                                            at.first.vertices.size())}) {
            const auto result = expect_free(at, {.groups = by});
            EXPECT_TRUE(goes_far(result));
            EXPECT_GE(std::reduce(result.fractions.begin(), result.fractions.end()),
                      0.999 * std::reduce(whole.fractions.begin(), whole.fractions.end()));
        }
    }
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
    const auto result = expect_free({before, after}, {.distances = {0.75}});
    EXPECT_EQ(result.near_at_start.vertex_face, (std::vector<ccd::vertex_face_pair>{{3, 0, 1, 2}}));
    EXPECT_EQ(result.touching_at_start, ccd::pair_lists());
    EXPECT_GE(result.fraction, 0.99 * 0.5);
    EXPECT_LT(result.fraction, 0.5);
}

}  // namespace
