// Steps of bodies, compared with a decision of every pair, and scenes made by hand.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <ccd/bodies/steps.hpp>
#include <ccd/step.hpp>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <iostream>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "tests/ccd/bodies/positions.hpp"
#include "tests/ccd/step/brute_force.hpp"
#include "tests/support/scaled.hpp"

namespace {

using ccd::affine_motion;
using ccd::body_motion;
using ccd::body_step_options;
using ccd::body_step_result;
using ccd::body_steps;
using ccd::first_time;
using ccd::kind;
using ccd::mesh;
using ccd::outcome;
using ccd::quaternion;
using ccd::resting;
using ccd::rigid_motion;
using motions = std::vector<body_motion>;

mesh box(double x, double y, double z) {
    mesh m;
    for (int i = 0; i < 8; ++i)
        m.vertices.push_back({(i & 1) != 0 ? x : -x, (i & 2) != 0 ? y : -y, (i & 4) != 0 ? z : -z});
    for (const auto& [a, b, c, d] : {std::array{0u, 1u, 3u, 2u},
                                     {4u, 5u, 7u, 6u},
                                     {0u, 1u, 5u, 4u},
                                     {2u, 3u, 7u, 6u},
                                     {0u, 2u, 6u, 4u},
                                     {1u, 3u, 7u, 5u}}) {
        m.faces.push_back({a, b, c});
        m.faces.push_back({a, c, d});
    }
    return m;
}

struct scene {
    std::vector<mesh> bodies;
    motions moving;
};

/// Bodies of triangles, rods and points with coordinates on a small grid or anywhere.
class random_scenes {
  public:
    /// --gtest_random_seed=N selects another sequence.
    explicit random_scenes(unsigned seed, int least_spread = 2)
        : random_(seed + 100 * static_cast<unsigned>(GTEST_FLAG_GET(random_seed))),
          least_spread_(least_spread) {}

    scene next() {
        on_grid_ = random_() % 3 != 0;
        spread_ = least_spread_ * (1 + static_cast<int>(random_() % 4));
        scene s;
        const std::size_t most = random_() % 8 == 0 ? 20 : 5;
        for (std::size_t b = 2 + random_() % (most - 1); b > 0; --b) {
            s.bodies.push_back(body());
            s.moving.push_back(motion());
        }
        return s;
    }

  private:
    unsigned below(std::size_t n) { return static_cast<unsigned>(random_() % n); }
    double number(int most) {
        if (!on_grid_) return most * (std::ldexp(static_cast<double>(random_()), -63) - 1);
        return static_cast<double>(static_cast<int>(below(static_cast<std::size_t>(2 * most + 1))) -
                                   most);
    }
    ccd::point<double> position(int most) { return {number(most), number(most), number(most)}; }
    mesh body() {
        mesh m;
        const unsigned vertices = below(10) == 0 ? 0 : 1 + below(8);
        for (unsigned i = 0; i < vertices; ++i) m.vertices.push_back(position(2));
        if (vertices == 0) return m;
        const auto any = [&] { return below(vertices); };
        for (unsigned i = below(5); i > 0; --i) m.faces.push_back({any(), any(), any()});
        for (unsigned i = below(3); i > 0; --i) m.edges.push_back({any(), any()});
        return m;
    }
    quaternion rotation() { return {3 + number(2), number(2), number(2), number(2)}; }
    body_motion motion() {
        const auto p0 = position(spread_), p1 = position(spread_);
        switch (below(6)) {
            case 0:
                return resting{};
            case 2:
                return affine_motion{.p0 = p0, .p1 = p0};
            case 1: {
                affine_motion m{.p0 = p0, .p1 = p1};
                for (auto& row : m.a1)
                    for (double& x : row) x += number(1) / 2;
                return m;
            }
            default: {
                rigid_motion m{{}, {}, p0, p1, position(1)};
                do {
                    m.q0 = rotation();
                    m.q1 = rotation();
                } while (!ccd::fault_of(m).empty());
                return m;
            }
        }
    }

    std::mt19937_64 random_;
    int least_spread_;
    bool on_grid_ = true;
    int spread_ = 4;
};

/// The meshes of all bodies as one mesh, with vertices in the bodies' order.
mesh joined(const std::vector<mesh>& bodies) {
    mesh all;
    for (const mesh& m : bodies) {
        const auto first = static_cast<ccd::vertex_index>(all.vertices.size());
        all.vertices.insert(all.vertices.end(), m.vertices.begin(), m.vertices.end());
        for (auto f : m.faces) {
            for (auto& v : f) v += first;
            all.faces.push_back(f);
        }
        for (auto e : m.edges) {
            for (auto& v : e) v += first;
            all.edges.push_back(e);
        }
    }
    return all;
}

/// The result of a test of every pair of two bodies of which one moves.
body_step_result by_brute_force(const body_steps& steps, const scene& s,
                                const body_step_options& options) {
    body_step_result result;
    result.first_contact = {outcome::separate, 0, 0};
    brute_force::for_each_pair(joined(s.bodies), [&]<class Pair>(const Pair& pair) {
        constexpr kind K = ccd::kind_of<Pair>;
        const auto [a, b] = brute_force::elements_of(pair);
        const std::size_t i = steps.body_of(a[0]), j = steps.body_of(b[0]);
        if (i == j || (options.may_touch && !options.may_touch(std::min(i, j), std::max(i, j))))
            return;
        if (!ccd::moves(s.moving[i]) && !ccd::moves(s.moving[j])) return;
        const auto query = steps.query_of(pair, s.moving);
        const first_time time = ccd::time_within(query, options.distance, options.t_max);
        if (time.outcome == outcome::separate) return;
        result.pairs.of<K>().push_back(brute_force::as_reported(pair));
        result.times.of<K>().push_back(time);
    });
    return result;
}

template <kind K>
std::vector<std::pair<ccd::pair_of_kind<K>, std::pair<double, double>>> with_times(
    const body_step_result& r) {
    std::vector<std::pair<ccd::pair_of_kind<K>, std::pair<double, double>>> all;
    for (std::size_t i = 0; i < r.pairs.of<K>().size(); ++i)
        all.push_back({r.pairs.of<K>()[i], {r.times.of<K>()[i].low, r.times.of<K>()[i].high}});
    std::ranges::sort(all);
    return all;
}

void expect_result(const body_step_result& found, const body_step_result& expected) {
    first_time first{outcome::separate, 0, 0};
    ccd::pair_lists at_start, first_pairs;
    ccd::for_each_kind([&]<kind K>() {
        EXPECT_TRUE(with_times<K>(found) == with_times<K>(expected));
        EXPECT_TRUE(std::ranges::is_sorted(found.pairs.of<K>()));
        EXPECT_GE(found.candidates.of<K>(), found.pairs.of<K>().size());
        for (const first_time& t : expected.times.of<K>())
            if (!t.at_start() && (first.outcome == outcome::separate ||
                                  std::pair(t.low, t.high) < std::pair(first.low, first.high)))
                first = t;
    });
    EXPECT_EQ(found.first_contact, first);
    ccd::for_each_kind([&]<kind K>() {
        for (std::size_t i = 0; i < found.pairs.of<K>().size(); ++i) {
            const first_time& t = found.times.of<K>()[i];
            if (t.at_start()) at_start.of<K>().push_back(found.pairs.of<K>()[i]);
            if (t == first) first_pairs.of<K>().push_back(found.pairs.of<K>()[i]);
        }
    });
    EXPECT_TRUE(found.touching_at_start == at_start);
    EXPECT_TRUE(found.first_pairs == first_pairs);
}

TEST(random_body_steps, report_the_pairs_and_times_of_brute_force) {
    random_scenes scenes(1);
    std::size_t bodies = 0, later = 0, at_start = 0;
    for (int i = 0; i < support::scaled(60); ++i) {
        SCOPED_TRACE("scene " + std::to_string(i));
        const scene s = scenes.next();
        bodies += s.bodies.size();
        body_steps steps(s.bodies);
        for (const body_step_options& options :
             {body_step_options{}, body_step_options{.distance = {0.5, 0.25}, .threads = 1},
              body_step_options{.t_max = 0.25,
              .may_touch = [](std::size_t a, std::size_t b) { return (a + b) % 2 == 1; }}}) {
            const auto found = steps.run(s.moving, options);
            expect_result(found, by_brute_force(steps, s, options));
            later += number_of(found.pairs) - number_of(found.touching_at_start);
            at_start += number_of(found.touching_at_start);
        }
        // The bodies stay: earlier steps change nothing.
        motions still(s.bodies.size(), resting{});
        EXPECT_EQ(number_of(steps.run(still).pairs), 0u);
        expect_result(steps.run(s.moving), by_brute_force(steps, s, {}));
    }
    EXPECT_GT(later, 0u);
    EXPECT_GT(at_start, 0u);
    std::cout << support::scaled(60) << " scenes of " << bodies << " bodies; pairs: " << later
              << " later, " << at_start << " at the start\n";
}

TEST(random_body_steps, advance_to_poses_that_are_free) {
    random_scenes scenes(2);
    std::size_t shortened = 0;
    for (int i = 0; i < support::scaled(30); ++i) {
        SCOPED_TRACE("scene " + std::to_string(i));
        const scene s = scenes.next();
        body_steps steps(s.bodies);
        for (const double conservative : {1.0, 0.5}) {
            const auto r = steps.advance(s.moving, {.conservative = conservative});
            const auto all = by_brute_force(steps, {s.bodies, r.motions}, {});
            ccd::for_each_kind([&]<kind K>() {
                for (const first_time& t : all.times.of<K>()) EXPECT_TRUE(t.at_start());
            });
            if (r.first_contact.outcome == outcome::separate) {
                EXPECT_EQ(r.fraction, 1);
                continue;
            }
            ++shortened;
            EXPECT_LE(r.fraction, conservative * r.first_contact.high);
            // At a tangential contact, rounding costs about its square root.
            EXPECT_GE(r.fraction, conservative * r.first_contact.low * (1 - 0x1p-20));
            for (std::size_t b = 0; b < r.motions.size(); ++b) {
                EXPECT_EQ(ccd::fault_of(r.motions[b]), "");
                EXPECT_EQ(r.motions[b].index(), s.moving[b].index());
            }
        }
    }
    EXPECT_GT(shortened, 0u);
}

/// True if the inside of an edge meets the inside of a face: by the common point of the edge and
/// the plane, in rationals.
bool cross(const std::array<std::array<support::rational, 3>, 5>& at) {
    using vector = std::array<support::rational, 3>;
    const auto minus = [](const vector& a, const vector& b) {
        return vector{a[0] - b[0], a[1] - b[1], a[2] - b[2]};
    };
    const auto product = [](const vector& a, const vector& b) {
        return vector{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                      a[0] * b[1] - a[1] * b[0]};
    };
    const auto dot = [](const vector& a, const vector& b) {
        return support::rational(a[0] * b[0] + a[1] * b[1] + a[2] * b[2]);
    };
    const auto& [p, q, a, b, c] = at;
    const vector n = product(minus(b, a), minus(c, a));
    const support::rational from = dot(n, minus(p, a)), to = dot(n, minus(q, a));
    if (from * to >= 0) return false;
    vector x = p;
    for (std::size_t k = 0; k < 3; ++k) x[k] += from / (from - to) * (q[k] - p[k]);
    return dot(product(minus(b, a), minus(x, a)), n) > 0 &&
           dot(product(minus(c, b), minus(x, b)), n) > 0 &&
           dot(product(minus(a, c), minus(x, c)), n) > 0;
}

std::vector<ccd::edge_face_pair> crossing_by_brute_force(const body_steps& steps, const scene& s) {
    std::vector<ccd::edge_face_pair> all;
    const mesh m = joined(s.bodies);
    const auto at_start = [&](ccd::vertex_index v) {
        const std::size_t b = steps.body_of(v);
        return support::position_at(s.moving[b], m.vertices[v], 0);
    };
    for (const ccd::edge& e : ccd::unique_edges(m.faces, m.edges))
        for (ccd::face f : ccd::unique_faces(m.faces)) {
            const std::size_t i = steps.body_of(e[0]), j = steps.body_of(f[0]);
            if (i == j || (!ccd::moves(s.moving[i]) && !ccd::moves(s.moving[j]))) continue;
            std::ranges::sort(f);
            if (cross({at_start(e[0]), at_start(e[1]), at_start(f[0]), at_start(f[1]),
                       at_start(f[2])}))
                all.push_back({e, f});
        }
    std::ranges::sort(all);
    return all;
}

/// Multiplies all lengths and quaternions.
void scale(scene& s, double lengths, double quaternions) {
    const auto scale_all = [](std::initializer_list<double*> numbers, double by) {
        for (double* x : numbers) *x *= by;
    };
    for (mesh& m : s.bodies)
        for (auto& v : m.vertices) scale_all({&v.x, &v.y, &v.z}, lengths);
    for (body_motion& m : s.moving) {
        if (auto* affine = std::get_if<affine_motion>(&m)) {
            for (auto* p : {&affine->p0, &affine->p1}) scale_all({&p->x, &p->y, &p->z}, lengths);
        } else if (auto* rigid = std::get_if<rigid_motion>(&m)) {
            for (auto* p : {&rigid->p0, &rigid->p1, &rigid->centre})
                scale_all({&p->x, &p->y, &p->z}, lengths);
            for (auto* q : {&rigid->q0, &rigid->q1})
                scale_all({&q->w, &q->x, &q->y, &q->z}, quaternions);
        }
    }
}

TEST(random_body_steps, report_the_edges_that_cross_faces_at_the_start) {
    random_scenes scenes(3, 1);
    std::size_t crossing = 0;
    for (int i = 0; i < support::scaled(150); ++i) {
        SCOPED_TRACE("scene " + std::to_string(i));
        scene s = scenes.next();
        if (i % 5 == 0)
            scale(s, i % 2 == 0 ? 0x1p-1040 : 0x1p1010, i % 3 == 0 ? 0x1p-600 : 0x1p200);
        body_steps steps(s.bodies);
        const auto expected = crossing_by_brute_force(steps, s);
        crossing += expected.size();
        EXPECT_EQ(steps.run(s.moving, {.check_start = true}).crossing_at_start, expected);
        EXPECT_EQ(steps.advance(s.moving, {.step = {.check_start = true}}).crossing_at_start,
                  expected);
        EXPECT_TRUE(steps.run(s.moving).crossing_at_start.empty());
    }
    EXPECT_GT(crossing, 0u);
    std::cout << crossing << " edges cross faces\n";
}

// ---- Scenes made by hand ----

TEST(body_steps, report_a_needle_through_a_face_that_moves_with_it) {
    const mesh needle{{{0.25, 0.25, -1}, {0.25, 0.25, 1}}, {}, {{0, 1}}},
        triangle{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{2, 1, 0}}};
    body_steps steps({needle, triangle});
    const auto turn = ccd::screw({1, 2, 3}, {}, {4, 5, 6});
    const motions together{turn, turn};
    EXPECT_EQ(number_of(steps.run(together).pairs), 0u);
    const std::vector<ccd::edge_face_pair> expected{{{0, 1}, {2, 3, 4}}};
    EXPECT_EQ(steps.run(together, {.check_start = true}).crossing_at_start, expected);
    EXPECT_TRUE(steps
                    .run(together, {.check_start = true,
                                    .may_touch = [](std::size_t, std::size_t) { return false; }})
                    .crossing_at_start.empty());
    const auto free = steps.advance(together, {.step = {.check_start = true}});
    EXPECT_EQ(free.crossing_at_start, expected);
    EXPECT_EQ(free.fraction, 1);
}
TEST(body_steps, far_away_are_as_exact) {
    const mesh needle{{{0.25, 0.25, -1}, {0.25, 0.25, 1}}, {}, {{0, 1}}},
        triangle{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.25, 0.25, 1}}, {{2, 1, 0}}};
    body_steps steps({triangle, mesh{}, needle});
    for (const double far : {0.0, 0x1p54, 0x1p900}) {
        const affine_motion away{.p0 = {far, -far, far}, .p1 = {1, 2, 3}};
        const motions together(3, away);
        const auto found = steps.run(together, {.check_start = true});
        EXPECT_EQ(found.crossing_at_start, (std::vector<ccd::edge_face_pair>{{{4, 5}, {0, 1, 2}}}));
        // The vertex of no face rests at the needle's end.
        EXPECT_EQ(found.touching_at_start.vertex_edge.size(), 1u);
        EXPECT_EQ(number_of(found.pairs), 1u);
    }
}
TEST(body_steps, that_rest_on_each_other_do_not_cross_at_the_start) {
    // A turned box stands on another; rounded positions would cross. Then it is lower by 2^-52.
    const quaternion q{3, 1, 4, 1};
    body_steps steps({box(1, 1, 1), box(1, 1, 1)});
    for (const double depth : {0.0, 0x1p-52}) {
        const motions moving{
            rigid_motion{q, q, {0.1, 0.2, 0.3}, {0.1, 0.2, 0.3}, {}},
            rigid_motion{q, q, {0.1, 0.2, 0.3}, {9, 9, 9}, {0.5, 0.25, depth - 2}}};
        const auto found = steps.run(moving, {.check_start = true});
        EXPECT_EQ(number_of(found.touching_at_start) > 0, depth == 0);
        EXPECT_EQ(found.crossing_at_start.empty(), depth == 0);
    }
}

TEST(body_steps, of_a_box_that_turns_into_a_wall) {
    // A bar of half-length 4 turns by a quarter about z. A wall at y = 3 meets its tip.
    body_steps steps({box(4, 0.5, 0.5), box(9, 0.25, 9)});
    const motions moving{ccd::screw({0, 0, 1}, {0, 0, 0}, {0, 0, 0}),
                         affine_motion{.p0 = {0, 3.25, 0}, .p1 = {0, 3.25, 0}}};
    const auto found = steps.run(moving);
    EXPECT_EQ(number_of(found.touching_at_start), 0u);
    ASSERT_EQ(found.first_contact.outcome, outcome::collides);
    // 4 sin(a) + cos(a)/2 = 3 for the angle a = 2 atan(t).
    const double t = found.first_contact.high, sine = 2 * t / (1 + t * t),
                 cosine = (1 - t * t) / (1 + t * t);
    EXPECT_NEAR(4 * sine + 0.5 * cosine, 3, 1e-14);
    for (const auto& p : found.first_pairs.vertex_face) {
        EXPECT_EQ(steps.body_of(p.v), 0u);
        EXPECT_EQ(steps.body_of(p.f0), 1u);
    }
    const auto free = steps.advance(moving);
    EXPECT_NEAR(free.fraction, t, 1e-15);
    EXPECT_EQ(number_of(steps.run(free.motions).pairs), 0u);
    // The next step starts from there.
    const auto& end = std::get<rigid_motion>(free.motions[0]);
    EXPECT_EQ(steps.run(motions{rigid_motion{end.q1, end.q0, {}, {}, {}}, moving[1]}).first_contact,
              (first_time{outcome::separate, 0, 0}));
}
TEST(body_steps, without_rotation_are_those_of_one_mesh) {
    std::mt19937 random(1);
    const auto whole = [&] { return static_cast<double>(random() % 17) - 8; };
    for (int i = 0; i < support::scaled(30); ++i) {
        const std::vector<mesh> bodies{box(1, 1, 1), box(2, 1, 1), box(1, 3, 1)};
        motions moving;
        mesh before = joined(bodies), after = before;
        std::size_t v = 0;
        for (const mesh& m : bodies) {
            const ccd::point<double> p0{whole(), whole(), whole()}, p1{whole(), whole(), whole()};
            moving.push_back(rigid_motion{{}, {}, p0, p1, {}});
            for (std::size_t k = 0; k < m.vertices.size(); ++k, ++v) {
                const auto x = m.vertices[k];
                before.vertices[v] = {x.x + p0.x, x.y + p0.y, x.z + p0.z};
                after.vertices[v] = {x.x + p1.x, x.y + p1.y, x.z + p1.z};
            }
        }
        const std::vector<int> groups = ccd::connected_parts(before.faces, {}, v);
        const auto expected = ccd::step(
            before, after,
            {.times = true,
             .filter = {.groups = groups, .rule = ccd::pair_filter::group_rule::between_groups}});
        body_steps steps(bodies);
        const auto found = steps.run(moving);
        EXPECT_TRUE(found.pairs == expected.pairs);
        EXPECT_TRUE(found.times == expected.times);
        EXPECT_TRUE(found.touching_at_start == expected.touching_at_start);
        EXPECT_EQ(found.first_contact, expected.first_contact);
        EXPECT_TRUE(found.first_pairs == expected.first_pairs);
    }
}
TEST(body_steps, of_resting_bodies_are_not_tested) {
    body_steps steps({box(1, 1, 1), box(2, 2, 2), box(1, 1, 1)});
    std::size_t calls = 0;
    const auto count = [&](std::size_t a, std::size_t b) {
        EXPECT_LT(a, b);
        ++calls;
        return false;
    };
    const motions moving{resting{}, resting{}, affine_motion{.p0 = {9, 0, 0}, .p1 = {5, 0, 0}}};
    EXPECT_EQ(steps.run(moving, {.may_touch = count}).body_pairs, 0u);
    EXPECT_EQ(calls, 0u);
    const motions near{resting{}, resting{}, affine_motion{.p0 = {9, 0, 0}, .p1 = {3, 0, 0}}};
    EXPECT_EQ(steps.run(near, {.may_touch = count}).body_pairs, 0u);
    EXPECT_EQ(calls, 1u);
    const auto found = steps.run(near);
    EXPECT_EQ(found.body_pairs, 1u);
    EXPECT_EQ(found.first_contact, (first_time{outcome::collides, 1, 1}));
}
TEST(body_steps, at_extreme_scales_miss_nothing) {
    for (const double size : {0x1p-1060, 0x1p-500, 0x1p500, 0x1p1020}) {
        mesh m{{{size, 0, 0}, {0, size, 0}, {0, 0, size}}, {{0, 1, 2}}};
        body_steps steps({m, m});
        const motions moving{ccd::screw({0, 0, 1}, {}, {}), ccd::screw({0, 0, -1}, {}, {})};
        EXPECT_GT(number_of(steps.run(moving).pairs), 0u);
    }
}
// One pair, whose exact numbers have many thousand bits. Polls during its computation end it.
TEST(body_steps, are_stopped_within_a_pair) {
    body_steps steps(
        {mesh{{{0x1p-900, 3, 0x1p900}}, {}},
         mesh{{{0, 0x1p-800, 0x1p900}, {1, 0x1p850, 0}, {0x1p800, 0, 0x1p-700}}, {{0, 1, 2}}}});
    const motions moving{
        rigid_motion{{1, 0x1p-700, 0, 0x1p-20}, {1, 0, 0x1p-600, 0.5}, {}, {1, 0, 0x1p-900}, {}},
        ccd::screw({0x1p-500, 1, 0x1p-3}, {0x1p-900, 0, 1}, {0, 0, 1})};
    int polls = 0, last = 0;
    const body_step_options options{
        .distance = {0x1p-100, 0x1p200}, .threads = 1, .stop = [&] { return ++polls == last; }};
    const auto expected = steps.run(moving, options);
    EXPECT_EQ(expected.candidates.vertex_face, 1u);
    expect_result(expected,
                  by_brute_force(steps, {{steps.rest(0), steps.rest(1)}, moving}, options));
    const int all = polls;
    EXPECT_GT(all, 100);
    for (const int n : {1, 2, all / 2, all - 1, all}) {
        polls = 0;
        last = n;
        EXPECT_THROW(steps.run(moving, options), ccd::stopped);
        EXPECT_EQ(polls, n);
    }
    EXPECT_THROW(
        steps.run(moving, {.distance = options.distance, .stop = []() -> bool { throw 1; }}), int);
    expect_result(steps.run(moving, {.distance = options.distance}), expected);
    std::cout << all << " polls\n";
}
TEST(body_steps, refuse_bad_input) {
    const auto message = [](auto&& call) -> std::string {
        try {
            call();
        } catch (const std::invalid_argument& e) {
            return e.what();
        }
        return "";
    };
    body_steps steps({box(1, 1, 1), box(1, 1, 1)});
    const motions one(1), two(2);
    EXPECT_EQ(message([&] { steps.run(one); }),
              "ccd::body_steps: number of motions is 1; expected 2, one for each body");
    const motions half{rigid_motion{{1, 0, 0, 0}, {0, 1, 0, 0}, {}, {}, {}}, resting{}};
    EXPECT_EQ(message([&] { steps.run(half); }),
              "ccd::body_steps: motion of body 0: q0·q1 is 0; expected a number certainly > "
              "0, so that the piece turns by less than half a turn");
    EXPECT_EQ(message([&] {
                  steps.run(two, {.distance = {-1, 0}});
              }),
              "ccd::body_steps: distance is -1; expected a finite number >= 0");
    EXPECT_EQ(message([&] { steps.run(two, {.t_max = std::nan("")}); }),
              "ccd::body_steps: t_max is nan; expected a finite number");
    EXPECT_EQ(message([&] { steps.advance(two, {.conservative = 0}); }),
              "ccd::body_steps: conservative is 0; expected a number in (0, 1]");
    EXPECT_EQ(message([] {
                  body_steps({mesh{{{0, 0, 0}}, {{0, 1, 2}}}});
              }),
              "ccd::body_steps: body 0: vertex index of face 0 is 1; expected less than 1");
    EXPECT_EQ(message([] {
                  body_steps({mesh{{{0, NAN, 0}}, {}}});
              }),
              "ccd::body_steps: body 0: vertex 0 is not finite; expected finite coordinates");
    body_steps none({});
    EXPECT_EQ(none.bodies(), 0u);
    EXPECT_EQ(number_of(none.run({}).pairs), 0u);
}

}  // namespace
