// Certificates of steps and reasons of short steps, compared with exact rationals.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <boost/multiprecision/cpp_int.hpp>
#include <ccd/advance.hpp>
#include <ccd/certify.hpp>
#include <ccd/methods/transform.hpp>
#include <cmath>
#include <cstdint>
#include <random>
#include <stdexcept>
#include <vector>

#include "tests/ccd/contact/by_hand.hpp"
#include "tests/ccd/step/brute_force.hpp"

namespace {

using ccd::contact_motion;
using ccd::kind;
using namespace by_hand;
using rational = boost::multiprecision::cpp_rational;

template <class Query>
contact_motion motion_of(const Query& query) {
    return ccd::motion_after(query, ccd::find_first_contact(query));
}

TEST(Motion, OfContactsMadeByHand) {
    EXPECT_EQ(motion_of(over_triangle({0.25, 0.5, 1}, {0.25, 0.5, -1})),
              contact_motion::approaches);
    EXPECT_EQ(motion_of(over_triangle({0.25, 0.5, 1}, {0.25, 0.5, 0})), contact_motion::approaches);
    EXPECT_EQ(motion_of(over_triangle({0.25, 0.5, 1}, {0.25, 0.5, 0.5})), contact_motion::unknown);
    // In the triangle from the start on, and leaving it.
    EXPECT_EQ(motion_of(over_triangle({0.25, 0.5, 0}, {0.5, 0.25, 0})), contact_motion::slides);
    EXPECT_EQ(motion_of(over_triangle({0.25, 0.5, 0}, {0.25, 0.5, 1})), contact_motion::unknown);
    // The plane z = a x tilts with a = -s; z - a x = s²/4 or s²/8, zero at s = 0: t = 1/2 or 1/3.
    EXPECT_EQ(
        motion_of(vertex_face{from_to({0.25, 0.125, 0.5}, {0.75, 0.125, -0.5}), still({0, 0, 0}),
                              from_to({1, 0, 1}, {1, 0, -1}), still({0, 1, 0})}),
        contact_motion::touches);
    const vertex_face at_third{from_to({0.375, 0.125, 0.5}, {0.75, 0.125, -1}), still({0, 0, 0}),
                               from_to({1, 0, 1}, {1, 0, -2}), still({0, 1, 0})};
    EXPECT_EQ(ccd::time_of_impact(at_third), at_a_third);
    EXPECT_EQ(motion_of(at_third), contact_motion::touches);
    // The edge rotates about (0, 0, 0): v - a x as above, now in the plane of the motion.
    EXPECT_EQ(motion_of(vertex_edge{from_to({0.25, 0.5, 0}, {0.75, -0.5, 0}), still({0, 0, 0}),
                                    from_to({1, 1, 0}, {1, -1, 0})}),
              contact_motion::touches);
    EXPECT_EQ(motion_of(vertex_edge{from_to({0.5, 1, 0}, {0.5, -1, 0}), still({0, 0, 0}),
                                    still({1, 0, 0})}),
              contact_motion::approaches);
    EXPECT_EQ(motion_of(vertex_vertex{from_to({0, 0, 0}, {2, 0, 0}), still({1, 0, 0})}),
              contact_motion::approaches);
    EXPECT_EQ(
        motion_of(vertex_vertex{from_to({0, 0, 0}, {2, 0, 0}), from_to({0, 0, 0}, {2, 0, 0})}),
        contact_motion::slides);
}

using exact_point = std::array<rational, 3>;

exact_point position_at(const moving& p, const rational& t) {
    const auto between = [&](double a, double b) -> rational {
        return rational(a) + t * (rational(b) - rational(a));
    };
    return {between(p.t0.x, p.t1.x), between(p.t0.y, p.t1.y), between(p.t0.z, p.t1.z)};
}

/// The sign of the volume of the query's four points.
template <class Query>
int side_at(const Query& query, const rational& t) {
    const auto points = ccd::points_of(query);
    std::array<exact_point, 4> p;
    for (std::size_t i = 0; i < 4; ++i) p[i] = position_at(points[i], t);
    const auto minus = [](const exact_point& a, const exact_point& b) {
        return exact_point{a[0] - b[0], a[1] - b[1], a[2] - b[2]};
    };
    const exact_point a = minus(p[1], p[0]), b = minus(p[2], p[0]), c = minus(p[3], p[0]);
    const rational volume = a[0] * (b[1] * c[2] - b[2] * c[1]) -
                            a[1] * (b[0] * c[2] - b[2] * c[0]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
    return volume.sign();
}

struct tally {
    int touches = 0, approaches = 0;
};

template <class Query>
void expect_motion(const Query& query, const ccd::first_contact& contact, contact_motion found,
                   tally& seen) {
    if constexpr (ccd::cubic_query<Query>) {
        const ccd::first_time& time = contact.time;
        if (time.outcome != ccd::outcome::collides || time.at_start()) return;
        // Coordinates are small dyadic numbers, so that two roots are farther apart than this.
        const rational near = rational(1) / (boost::multiprecision::cpp_int(1) << 200);
        const bool exact = time.low == time.high;
        const rational low(time.low), high(time.high);
        const int before = side_at(query, exact ? rational(low - near) : low),
                  after = side_at(query, exact ? rational(high + near) : high);
        if (before * after < 0) {
            EXPECT_EQ(found, contact_motion::approaches);
        }
        if (found == contact_motion::touches && after != 0) {
            EXPECT_EQ(before, after);
        }
        if (found == contact_motion::approaches && before == after && before != 0) {
            EXPECT_NE(contact.normal_from, ccd::normal_source::cross_product);
        }
        seen.touches += found == contact_motion::touches;
        seen.approaches += found == contact_motion::approaches;
    }
}

// The plane z = a x tilts with a = -s, s = p t - q, and z - a x = c s² is zero at t = q/p only. A
// last place less in one coordinate moves the root, or makes two of it.
TEST(Motion, OfContactsNearDoubleRoots) {
    std::mt19937_64 random(1);
    const auto between = [&](int low, int high) {
        return low + static_cast<int>(random() % static_cast<std::uint64_t>(high - low + 1));
    };
    tally seen;
    for (int i = 0; i < 3000; ++i) {
        const int p = between(2, 9), q = between(1, p - 1);
        const double x0 = between(4, 12) / 32.0, c = between(1, 4) / 256.0, s0 = -q, s1 = p - q;
        vertex_face query{from_to({x0 + c * s0, 0.125, -x0 * s0}, {x0 + c * s1, 0.125, -x0 * s1}),
                          still({0, 0, 0}), from_to({1, 0, -s0}, {1, 0, -s1}), still({0, 1, 0})};
        if (i % 3 == 1) query.v.t1.z = std::nextafter(query.v.t1.z, -infinity);
        if (i % 3 == 2) query.v.t0.x = std::nextafter(query.v.t0.x, infinity);
        const ccd::first_contact contact = ccd::find_first_contact(query);
        expect_motion(query, contact, ccd::motion_after(query, contact), seen);
    }
    EXPECT_GT(seen.touches, 1000);
    EXPECT_GT(seen.approaches, 100);
}

/// The signed way of the contact points past each other along the normal, in long doubles.
void expect_depth(const ccd::passage& found) {
    const ccd::first_contact& c = found.contact;
    if (!c.sided || c.normal_from == ccd::normal_source::relative_velocity) {
        EXPECT_EQ(found.depth_error, infinity);
        return;
    }
    const long double past = -(long double)c.normal_velocity * (1 - (long double)c.time.low);
    EXPECT_GE(found.depth, 0);
    EXPECT_LE(std::abs(found.depth - std::max(past, 0.0L)), found.depth_error + 1e-18L);
    EXPECT_LE(found.depth_error, 1.01 * c.normal_velocity_error + 1e-14);
}

TEST(Certify, AgreesWithStepsAndExactRationals) {
    tally seen;
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
        const auto [before, after] = seed % 2 == 0 ? brute_force::random_soup(seed, 20, 8)
                                                   : brute_force::random_mixture(seed);
        const ccd::vertex_rows rows(before, after);
        const ccd::certificate found = ccd::certify(before, after);
        const ccd::step_result step =
            ccd::step(before, after, {.times = true, .check_start = true, .adjacent_rods = true});
        EXPECT_EQ(found.step.pairs, step.pairs);
        EXPECT_EQ(found.step.times, step.times);
        EXPECT_EQ(found.step.intersections_at_start.size(), step.intersections_at_start.size());
        EXPECT_EQ(found.contacts(),
                  ccd::number_of(step.pairs) - ccd::number_of(step.touching_at_start));
        EXPECT_EQ(found.is_free(),
                  ccd::number_of(step.pairs) == 0 && step.intersections_at_start.empty());
        ccd::for_each_kind([&]<kind K>() {
            const auto& pairs = step.pairs.of<K>();
            const auto& passages = found.passages.of<K>();
            ASSERT_EQ(passages.size(), pairs.size());
            for (std::size_t i = 0; i < pairs.size(); ++i) {
                const auto query = ccd::query_of(rows, pairs[i]);
                EXPECT_EQ(passages[i].contact, ccd::contact_at(query, step.times.of<K>()[i]));
                expect_motion(query, passages[i].contact, passages[i].motion, seen);
                expect_depth(passages[i]);
            }
        });
    }
    EXPECT_GT(seen.approaches, 300);
}

// A vertex falls through a triangle, by 2 lengths.
ccd::mesh triangle_and_point(double z) {
    return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.25, 0.25, z}}, {{0, 1, 2}}};
}

TEST(Certify, DepthOfAPointThatFallsThroughATriangle) {
    const ccd::certificate found = ccd::certify(triangle_and_point(0.5), triangle_and_point(-1.5));
    ASSERT_EQ(found.passages.vertex_face.size(), 1u);
    const ccd::passage& passage = found.passages.vertex_face[0];
    EXPECT_EQ(passage.contact.time, at(0.25));
    EXPECT_NEAR(passage.depth, 1.5, passage.depth_error);
    EXPECT_LE(passage.depth_error, 1e-14);
    EXPECT_EQ(&found.deepest(), &passage);
    EXPECT_FALSE(found.is_free());
    EXPECT_EQ(found.contacts(), 1u);
    const ccd::certificate free = ccd::certify(triangle_and_point(0.5), triangle_and_point(0.25));
    EXPECT_TRUE(free.is_free());
    EXPECT_EQ(free.deepest().depth_error, infinity);
}

TEST(Certify, FindsAdjacentRodsThatFoldOntoOrThroughEachOther) {
    const auto rods = [](double x, double y) {
        return ccd::mesh{{{0, 0, 0}, {4, 0, 0}, {x, y, 0}}, {}, {{0, 1}, {1, 2}}};
    };
    for (const auto& [x, y] : {std::pair(1.0, 0.0), std::pair(1.0, -1.0)}) {
        const ccd::certificate found = ccd::certify(rods(1, 1), rods(x, y));
        EXPECT_FALSE(found.is_free());
        ASSERT_EQ(found.step.pairs.vertex_edge.size(), 1u);
        EXPECT_EQ(found.step.pairs.vertex_edge[0], (ccd::vertex_edge_pair{2, 0, 1}));
        EXPECT_EQ(found.step.times.vertex_edge[0], at(y == 0 ? 1 : 0.5));
        EXPECT_LT(ccd::advance(rods(1, 1), rods(x, y)).fraction, 1);
    }
    EXPECT_TRUE(ccd::certify(rods(1, 1), rods(1, 0.25)).is_free());
}

/// Faces, of which one is degenerate, and rods with common vertices, moved on a grid of 840. So
/// positions at t = k / 840 are integers.
std::pair<ccd::mesh, ccd::mesh> adjacent_elements(std::uint64_t seed) {
    std::mt19937_64 random(seed);
    const auto coordinate = [&](std::uint64_t n) {
        return 840 * static_cast<double>(random() % n);
    };
    ccd::mesh before{{}, {{0, 1, 2}}, {{2, 3}, {3, 4}, {4, 5}, {3, 5}}};
    if (seed % 3 != 0) before.faces.push_back({1, 2, 3});
    if (seed % 3 == 1) before.faces.push_back({4, 4, 0});
    if (seed % 3 == 2) before.faces = {};
    const bool is_flat = seed % 2 == 0;
    const auto place = [&] {
        std::vector<ccd::point<double>> at;
        for (int i = 0; i < 6; ++i)
            at.push_back({coordinate(4), coordinate(4), is_flat ? 0 : coordinate(3)});
        return at;
    };
    before.vertices = place();
    ccd::mesh after = before;
    if (seed % 4 < 2) after.vertices = place();
    for (int i = 0; i < 2; ++i) after.vertices[random() % 6] = place()[0];
    return {before, after};
}

TEST(Certify, FreeStepsHaveNoIntersectionAtAnyTime) {
    int free = 0, folds = 0;
    for (std::uint64_t seed = 0; seed < 6000; ++seed) {
        const auto [before, after] = adjacent_elements(seed);
        const ccd::certificate found = ccd::certify(before, after);
        free += found.is_free();
        // Contacts of adjacent rods only: folds, which steps do not report by default.
        const bool is_fold = found.step.intersections_at_start.empty() &&
                             ccd::number_of(found.step.pairs) > 0 &&
                             ccd::number_of(ccd::step(before, after).pairs) == 0;
        if (!found.is_free() && !is_fold) continue;
        bool intersects = false;
        ccd::mesh between = before;
        for (int k = 0; k <= 840; k += is_fold || seed % 8 == 0 ? 1 : 35) {
            for (std::size_t v = 0; v < before.vertices.size(); ++v) {
                const auto at = [k](double x, double y) { return x + k * ((y - x) / 840); };
                const auto &p = before.vertices[v], &q = after.vertices[v];
                between.vertices[v] = {at(p.x, q.x), at(p.y, q.y), at(p.z, q.z)};
            }
            intersects = intersects || !ccd::is_free_of_intersections(between);
        }
        EXPECT_FALSE(intersects && found.is_free()) << seed;
        folds += intersects;
    }
    EXPECT_GT(free, 200);
    EXPECT_GT(folds, 20);
}

TEST(Certify, ConvertsFloatsExactly) {
    const std::vector<ccd::point<float>> before = {
        {0, 0, 0.1f}, {1, 0, 0.1f}, {0, 1, 0.1f}, {0.25f, 0.25f, 1}};
    std::vector<ccd::point<float>> after = before;
    after[3].z = 0.1f;
    const std::vector<ccd::face> faces = {{0, 1, 2}};
    ccd::mesh_steps steps(faces, {}, 4);
    EXPECT_EQ(ccd::certify(steps, before, after).step.pairs.vertex_face.size(), 1u);
    after[3].z = std::nextafter(0.1f, 1.0f);
    EXPECT_TRUE(ccd::certify(steps, before, after).is_free());
}

TEST(Certify, RefusesDistancesAndOtherMeshes) {
    const ccd::mesh m = triangle_and_point(1);
    EXPECT_THROW(ccd::certify(m, m, {.distances = {0.5}}), std::invalid_argument);
    EXPECT_THROW(ccd::step(m, m, {.adjacent_rods = true, .distances = {0.5}}),
                 std::invalid_argument);
    ccd::mesh other = m;
    other.faces.clear();
    EXPECT_THROW(ccd::certify(m, other), std::invalid_argument);
}

TEST(Reasons, NameThePairsThatLimitAStep) {
    const ccd::mesh before = triangle_and_point(0.5), after = triangle_and_point(-1.5);
    const ccd::vertex_rows rows(before, after);
    const ccd::advance_result free = ccd::advance(before, after);
    const auto all = ccd::reasons(rows, free.first_pairs, free.first_contact);
    ASSERT_EQ(all.size(), 1u);
    EXPECT_EQ(all[0].kind, kind::vertex_face);
    EXPECT_EQ(all[0].vertices, (std::array<ccd::vertex_index, 4>{3, 0, 1, 2}));
    EXPECT_EQ(all[0].time, at(0.25));
    EXPECT_EQ(all[0].motion, contact_motion::approaches);
    EXPECT_NEAR(all[0].normal_velocity, -2, all[0].normal_velocity_error);
    EXPECT_NEAR(all[0].at_start.distance, 0.5, all[0].at_start.distance_error);
    EXPECT_TRUE(ccd::reasons(rows, {}, free.first_contact).empty());
    EXPECT_THROW(ccd::reasons({rows.before, rows.after, 3}, free.first_pairs, free.first_contact),
                 std::invalid_argument);
}

TEST(Reasons, OfDistances) {
    const ccd::pair_distances distances{.all = 0.25};
    const auto reason_of = [&](const ccd::mesh& before, const ccd::mesh& after) {
        const ccd::step_result found =
            ccd::step(before, after, {.first_contact = true, .distances = distances});
        const auto all =
            ccd::reasons({before, after}, found.first_pairs, found.first_contact, distances);
        return all.size() == 1 ? all[0] : ccd::reason{};
    };
    const ccd::reason falls = reason_of(triangle_and_point(0.5), triangle_and_point(0.125));
    EXPECT_EQ(falls.motion, contact_motion::approaches);
    EXPECT_NEAR(falls.normal_velocity, -0.375, falls.normal_velocity_error);
    EXPECT_LE(falls.normal_velocity_error, 1e-6);
    // One point passes the other at distance 1/4, at t = 1/2.
    const ccd::mesh left = {{{-1, 0, 0.25}, {0, 0, 0}}, {}, {}};
    const ccd::mesh right = {{{1, 0, 0.25}, {0, 0, 0}}, {}, {}};
    const ccd::reason passes = reason_of(left, right);
    EXPECT_EQ(passes.kind, kind::vertex_vertex);
    EXPECT_EQ(passes.time, at(0.5));
    EXPECT_EQ(passes.motion, contact_motion::slides);
}

}  // namespace
