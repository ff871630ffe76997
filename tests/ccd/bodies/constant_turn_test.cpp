// Rotation at constant angular velocity, compared with the true motion in 50 digits.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <ccd/bodies/constant_turn.hpp>
#include <ccd/curves.hpp>
#include <ccd/kind.hpp>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <random>
#include <string>

#include "tests/support/scaled.hpp"

namespace {

using ccd::constant_turn;
using ccd::enclosed_time;
using ccd::enclosed_time_of_impact;
using ccd::kind;
using ccd::outcome;
using ccd::quaternion;
using ccd::turning_point;
using digits = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<50>,
                                             boost::multiprecision::et_off>;
constexpr double infinity = std::numeric_limits<double>::infinity();

template <class Number>
struct space {
    using vector = std::array<Number, 3>;

    static vector of(const ccd::point<double>& p) {
        return {Number(p.x), Number(p.y), Number(p.z)};
    }
    static vector plus(const vector& a, const vector& b, const Number& scale = 1) {
        return {a[0] + scale * b[0], a[1] + scale * b[1], a[2] + scale * b[2]};
    }
    static vector minus(const vector& a, const vector& b) { return plus(a, b, Number(-1)); }
    static vector cross(const vector& a, const vector& b) {
        return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    }
    static Number dot(const vector& a, const vector& b) {
        return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    }
    static Number length(const vector& a) {
        using std::sqrt;
        return sqrt(dot(a, a));
    }
    /// The rotation of w + v.
    static vector rotated(const Number& w, const vector& v, const vector& x) {
        const Number weight = w * w + dot(v, v);
        const vector twice = cross(v, x), more = cross(v, twice);
        return plus(plus(x, twice, 2 * w / weight), more, 2 / weight);
    }
    static vector rotated(const quaternion& q, const vector& x) {
        return rotated(Number(q.w), of({q.x, q.y, q.z}), x);
    }

    static vector position(const constant_turn& m, const ccd::point<double>& rest,
                           const Number& t) {
        using std::cos, std::sin;
        vector x = rotated(m.from.q, minus(of(rest), of(m.centre)));
        if (m.angle != 0) {
            const vector axis = of(m.axis);
            const Number half = Number(m.angle) * t / 2, s = sin(half) / length(axis);
            x = rotated(cos(half), {s * axis[0], s * axis[1], s * axis[2]}, x);
        }
        return plus(x, plus(of(m.from.p), minus(of(m.end), of(m.from.p)), t));
    }
    static vector position(const ccd::rigid_motion& m, const ccd::point<double>& rest,
                           const Number& t) {
        const auto at = [&](double a, double b) { return (1 - t) * Number(a) + t * Number(b); };
        const vector v{at(m.q0.x, m.q1.x), at(m.q0.y, m.q1.y), at(m.q0.z, m.q1.z)};
        const vector x = rotated(at(m.q0.w, m.q1.w), v, minus(of(rest), of(m.centre)));
        return plus(x, {at(m.p0.x, m.p1.x), at(m.p0.y, m.p1.y), at(m.p0.z, m.p1.z)});
    }

    /// The signed volume, and true if the features' interiors meet where it is 0.
    struct state {
        Number volume;
        bool inside;
    };
    template <kind K>
    static state state_at(const std::array<turning_point, 4>& points, const Number& t) {
        std::array<vector, 4> p;
        for (std::size_t i = 0; i < 4; ++i) p[i] = position(*points[i].motion, points[i].rest, t);
        if constexpr (K == kind::vertex_face) {
            const vector n = cross(minus(p[2], p[1]), minus(p[3], p[1]));
            bool inside = true;
            for (const auto& [i, j] : {std::array{1, 2}, std::array{2, 3}, std::array{3, 1}}) {
                const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
                inside = inside && dot(cross(minus(p[b], p[a]), minus(p[0], p[a])), n) > 0;
            }
            return {dot(n, minus(p[0], p[1])), inside};
        } else {
            const vector a = minus(p[1], p[0]), b = minus(p[3], p[2]), d = minus(p[2], p[0]),
                         n = cross(a, b);
            const Number s = dot(cross(d, b), n), u = dot(cross(d, a), n), one = dot(n, n);
            return {dot(n, d), s > 0 && u > 0 && s < one && u < one};
        }
    }
    /// True if samples show a contact in [from, to].
    template <kind K>
    static bool samples_meet(const std::array<turning_point, 4>& points, double from, double to,
                             int samples) {
        state last = state_at<K>(points, Number(from));
        for (int i = 1; i <= samples; ++i) {
            const Number t = Number(from) + (Number(to) - Number(from)) * i / samples;
            const state now = state_at<K>(points, t);
            if (last.inside && now.inside && (last.volume > 0) != (now.volume > 0)) return true;
            last = now;
        }
        return false;
    }
};
using exactly = space<digits>;

class random_turns {
  public:
    explicit random_turns(unsigned seed) : random_(seed) {}

    double number(double most) { return std::uniform_real_distribution(-most, most)(random_); }
    ccd::point<double> point(double most) { return {number(most), number(most), number(most)}; }
    unsigned below(unsigned n) { return static_cast<unsigned>(random_() % n); }

    constant_turn next(double most_angle) {
        constant_turn m;
        m.from = {{number(1), number(1), number(1), number(1)}, point(2)};
        if (below(3) == 0) m.from.q = {};
        m.axis = below(4) == 0 ? ccd::point<double>{0, 0, 1} : point(1);
        if (below(8) == 0) m.axis = {m.axis.x * 0x1p-600, m.axis.y * 0x1p-600, m.axis.z * 0x1p-600};
        m.angle = number(most_angle);
        m.end = below(3) == 0 ? m.from.p : point(2);
        if (below(2) == 0) m.centre = point(1);
        return m;
    }

  private:
    std::mt19937_64 random_;
};

TEST(enclosures, contain_the_true_motion_and_are_tight) {
    random_turns random(1);
    double loosest = 0;
    for (int i = support::scaled(600); i > 0; --i) {
        const constant_turn m = random.next(8);
        const double from = random.below(2) == 0 ? 0 : std::abs(random.number(1));
        const double width = std::min(1 - from, std::abs(random.number(1.57)) / std::abs(m.angle));
        const double to = random.below(4) == 0 ? from + width / 1024 : from + width;
        if (!(from < to)) continue;
        const ccd::enclosing_motion near = ccd::enclose(m, from, to);
        ASSERT_LT(near.angle, infinity);
        EXPECT_EQ(ccd::fault_of(near.motion), "");
        const auto rest = random.point(3);
        const digits radius =
            exactly::length(exactly::minus(exactly::of(rest), exactly::of(m.centre)));
        const digits bound = digits(near.angle) * radius + digits(near.shift);
        digits largest = 0;
        // A point on the axis does not move, so its bound is not tight: take the distance from it.
        const auto x =
            exactly::rotated(m.from.q, exactly::minus(exactly::of(rest), exactly::of(m.centre)));
        const digits from_axis = exactly::length(exactly::cross(x, exactly::of(m.axis))) /
                                 exactly::length(exactly::of(m.axis));
        for (int k = 0; k <= 32; ++k) {
            const digits s = digits(k) / 32, t = digits(from) + s * (digits(to) - digits(from));
            const digits distance = exactly::length(exactly::minus(
                exactly::position(m, rest, t), exactly::position(near.motion, rest, s)));
            ASSERT_LE(distance, bound) << i << ' ' << k;
            largest = std::max(largest, distance);
        }
        if (std::abs(m.angle) * (to - from) > 0.01)
            loosest =
                std::max(loosest, static_cast<double>(digits(near.angle) * from_axis / largest));
    }
    EXPECT_LT(loosest, 1.3);
}

TEST(enclosures, of_translations_and_of_the_ends_are_exact) {
    const constant_turn m{{{0.1, 0.2, 0.3, 0.4}, {1, 2, 3}}, {0, 0, 1}, 0, {0.1, 0.2, 0.3}, {}};
    const auto whole = ccd::enclose(m, 0, 1);
    EXPECT_EQ(whole.angle, 0);
    EXPECT_EQ(whole.shift, 0);
    EXPECT_EQ(whole.motion, (ccd::rigid_motion{m.from.q, m.from.q, m.from.p, m.end, {}}));
    EXPECT_EQ(ccd::enclose({{}, {0, 0, 1}, 3, {}, {}}, 0, 1).angle, infinity);  // over a quarter
}

// A tip 5 from the axis z, and the plane x = c.
enclosed_time tip_and_plane(double angle, double c, const ccd::enclosure_options& options = {}) {
    const constant_turn spin{{}, {0, 0, 1}, angle, {}, {}}, still{};
    return enclosed_time_of_impact(ccd::vertex_face_of<turning_point>{{&spin, {5, 0, 0}},
                                                                      {&still, {c, -99, -99}},
                                                                      {&still, {c, 99, -99}},
                                                                      {&still, {c, 0, 99}}},
                                   options);
}

TEST(constant_turns, meet_a_plane_at_the_true_time) {
    for (const double angle : {1.5, -2.0, 3.0, 12.0, 300.0, -1e4})
        for (const double c : {3.0, -2.5, 4.9999, 0.0}) {
            const digits at = acos(digits(c) / 5) / abs(digits(angle));
            const enclosed_time found = tip_and_plane(angle, c);
            if (at > 1) {
                EXPECT_EQ(found.outcome, outcome::separate) << angle << ' ' << c;
                continue;
            }
            ASSERT_EQ(found.outcome, outcome::collides) << angle << ' ' << c;
            EXPECT_LE(digits(found.low), at);
            EXPECT_GE(digits(found.high), at);
            EXPECT_LE(found.high - found.low, 0x1p-30);
        }
    EXPECT_EQ(tip_and_plane(12, -5.0001).outcome, outcome::separate);
    EXPECT_EQ(tip_and_plane(1e4, 5.0001, {.max_pieces = 1 << 20}).outcome, outcome::separate);
}

TEST(constant_turns, near_the_edge_of_a_face) {
    // The tip rises with time, and meets the plane x = 3 at acos(3/5)/1.5, at the height z.
    const constant_turn spin{{}, {0, 0, 1}, 1.5, {0, 0, 2}, {}}, still{};
    const digits z = 2 * acos(digits(3) / 5) / digits(1.5);
    int certain = 0;
    for (double off = 0x1p-2; off > 0x1p-56; off /= 2)
        for (const double side : {-1.0, 1.0}) {
            const double edge = static_cast<double>(z) + side * off;
            const enclosed_time found =
                enclosed_time_of_impact(ccd::vertex_face_of<turning_point>{{&spin, {5, 0, 0}},
                                                                           {&still, {3, -99, edge}},
                                                                           {&still, {3, 99, edge}},
                                                                           {&still, {3, 0, 99}}});
            const bool touches = digits(edge) <= z;
            EXPECT_NE(found.outcome, touches ? outcome::separate : outcome::collides) << off;
            certain += found.outcome != outcome::uncertain;
        }
    EXPECT_GE(certain, 70);
}

TEST(constant_turns, that_graze_are_uncertain) {
    // The tip is in the plane x = -5 only at half a turn: whether it touches depends on no
    // rounding.
    const enclosed_time found = tip_and_plane(6, -5);
    EXPECT_EQ(found.outcome, outcome::uncertain);
    EXPECT_LE(digits(found.low), boost::math::constants::pi<digits>() / 6);
    EXPECT_GT(found.low, 0.5);
    // Contact at the start is exact.
    const enclosed_time start = tip_and_plane(6, 5);
    EXPECT_EQ(start.outcome, outcome::collides);
    EXPECT_EQ(start.high, 0);
}

TEST(constant_turns, without_rotation_are_exact) {
    random_turns random(2);
    int hits = 0;
    for (int i = support::scaled(300); i > 0; --i) {
        std::array<constant_turn, 2> m{random.next(0), random.next(0)};
        std::array<ccd::body_motion, 2> same;
        for (std::size_t b = 0; b < 2; ++b)
            same[b] =
                ccd::rigid_motion{m[b].from.q, m[b].from.q, m[b].from.p, m[b].end, m[b].centre};
        const auto v = random.point(2), a = random.point(3), b = random.point(3),
                   c = random.point(3);
        const enclosed_time found = enclosed_time_of_impact(
            ccd::vertex_face_of<turning_point>{{&m[0], v}, {&m[1], a}, {&m[1], b}, {&m[1], c}});
        const ccd::first_time expected = time_of_impact(ccd::vertex_face_of<ccd::body_point>{
            {&same[0], v}, {&same[1], a}, {&same[1], b}, {&same[1], c}});
        ASSERT_EQ(found.outcome, expected.outcome);
        hits += found.outcome == outcome::collides;
        EXPECT_EQ(found.low, expected.low);
        EXPECT_EQ(found.high, expected.high);
    }
    EXPECT_GT(hits, 0);
}

struct tally {
    int hits = 0, uncertain = 0, all = 0;
};

template <kind K>
enclosed_time decided(const std::array<turning_point, 4>& p) {
    if constexpr (K == kind::vertex_face)
        return enclosed_time_of_impact(ccd::vertex_face_of<turning_point>{p[0], p[1], p[2], p[3]});
    else
        return enclosed_time_of_impact(ccd::edge_edge_of<turning_point>{p[0], p[1], p[2], p[3]});
}

template <kind K>
tally compare_with_samples(unsigned seed, int queries) {
    random_turns random(seed);
    tally count;
    for (; count.all < queries; ++count.all) {
        const std::array<constant_turn, 2> m{random.next(7),
                                             random.next(random.below(2) == 0 ? 0 : 7)};
        std::array<turning_point, 4> p;
        for (std::size_t i = 0; i < 4; ++i)
            p[i] = {&m[i < ccd::kind_traits<K>::first_vertices ? 0 : 1], random.point(3)};
        const enclosed_time found = decided<K>(p);
        const double free = found.outcome == outcome::separate ? 1 : found.low;
        EXPECT_FALSE(space<long double>::samples_meet<K>(p, 0, free, 500)) << count.all;
        count.uncertain += found.outcome == outcome::uncertain;
        if (found.outcome != outcome::collides) continue;
        ++count.hits;
        EXPECT_LE(found.high - found.low, 0x1p-20) << count.all;
        if (found.high > 0) {
            EXPECT_TRUE(exactly::samples_meet<K>(p, found.low, found.high, 4)) << count.all;
        }
    }
    return count;
}

TEST(random_constant_turns, agree_with_samples_of_the_true_motion) {
    const int queries = support::scaled(400);
    for (const auto& [hits, uncertain, all] : {compare_with_samples<kind::vertex_face>(3, queries),
                                               compare_with_samples<kind::edge_edge>(4, queries)}) {
        EXPECT_GE(hits, all / 20);
        EXPECT_LE(uncertain, all / 100);
        RecordProperty("hits", hits);
        RecordProperty("uncertain", uncertain);
    }
}

TEST(constant_turns, of_a_vertex_and_an_edge_are_uncertain_or_separate) {
    const constant_turn spin{{}, {0, 0, 1}, 2, {}, {}}, still{};
    const auto query = [&](double height) {
        return enclosed_time_of_impact(ccd::vertex_edge_of<turning_point>{
            {&spin, {5, 0, 0}}, {&still, {3, 4, -1}}, {&still, {3, 4, height}}});
    };
    EXPECT_EQ(query(-0.25).outcome, outcome::separate);
    EXPECT_EQ(query(1).outcome, outcome::uncertain);
    EXPECT_LT(std::abs(query(1).low - std::acos(0.6) / 2), 1e-9);
    const enclosed_time start = enclosed_time_of_impact(
        ccd::vertex_vertex_of<turning_point>{{&spin, {5, 0, 0}}, {&still, {5, 0, 0}}});
    EXPECT_EQ(start.outcome, outcome::collides);
    EXPECT_EQ(start.high, 0);
}

TEST(constant_turns, that_are_invalid_or_too_costly_are_uncertain) {
    EXPECT_EQ(ccd::fault_of(constant_turn{}), "");
    EXPECT_EQ(ccd::fault_of({{}, {0, 0, 0}, 1, {}, {}}),
              "axis is 0; expected a direction, since the angle is not 0");
    EXPECT_EQ(ccd::fault_of({{}, {0, 0, 1}, infinity, {}, {}}),
              "angle is not finite; expected a finite number");
    EXPECT_EQ(ccd::fault_of({{}, {0, infinity, 1}, 1, {}, {}}),
              "axis is not finite; expected finite numbers");
    EXPECT_NE(ccd::fault_of({{{0, 0, 0, 0}, {}}, {0, 0, 1}, 1, {}, {}}), "");
    EXPECT_EQ(tip_and_plane(infinity, 3).outcome, outcome::uncertain);
    EXPECT_EQ(tip_and_plane(1e300, 3).outcome, outcome::uncertain);
    EXPECT_EQ(tip_and_plane(3, std::nan("")).outcome, outcome::uncertain);
    EXPECT_EQ(tip_and_plane(3, 3, {.max_pieces = 1}).outcome, outcome::uncertain);
    EXPECT_EQ(tip_and_plane(3, 3, {.max_pieces = 1}).low, 0);
}

}  // namespace
