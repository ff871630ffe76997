// Tests of the oracle: instants, intervals and distances that can be checked by hand, and its
// shortcuts.
#include "tests/support/oracle.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "tests/support/first_time_faults.hpp"
#include "tests/support/query_families.hpp"
#include "tests/support/scaled.hpp"

namespace {

using ccd::first_time;
using ccd::outcome;
using ccd::point;
using oracle::interval;
using oracle::shortcuts;
using moving = ccd::moving_point<double>;

moving rest(double x, double y, double z) {
    return {{x, y, z}, {x, y, z}};
}
double before(double t) {
    return std::nextafter(t, 0);
}
double after(double t) {
    return std::nextafter(t, std::numeric_limits<double>::max());
}
template <class Query>
bool touches(const Query& q, const interval& when) {
    const bool with = oracle::collides(q, shortcuts::on, when);
    EXPECT_EQ(oracle::collides(q, shortcuts::off, when), with);
    return with;
}
template <class Query>
bool near(const Query& q, double d, const interval& when = interval()) {
    const bool with = oracle::within(q, d, 0, shortcuts::on, when);
    EXPECT_EQ(oracle::within(q, d, 0, shortcuts::off, when), with);
    return with;
}

// Expects contact at `t` and at no other time, with intervals of all forms that end or begin there.
template <class Query>
void expect_contact_only_at(double t, const Query& q) {
    EXPECT_TRUE(touches(q, {}));
    EXPECT_TRUE(touches(q, interval::instant(t)));
    EXPECT_FALSE(touches(q, interval::instant(before(t))));
    EXPECT_FALSE(touches(q, interval::instant(after(t))));
    EXPECT_TRUE(touches(q, {0, t}));
    EXPECT_TRUE(touches(q, {t, 1}));
    EXPECT_FALSE(touches(q, {.high = t, .with_high = false}));
    EXPECT_FALSE(touches(q, {.low = t, .with_low = false}));
    EXPECT_TRUE(touches(q, {before(t), after(t), false, false}));
    EXPECT_FALSE(touches(q, {before(t), t, false, false}));
    EXPECT_FALSE(touches(q, {t, after(t), false, false}));
}

// Two edges, of which one rotates, so that they touch without crossing, at s = 0.
ccd::edge_edge<double> grazing(double s0, double s1) {
    return {{{-4, 0, s0}, {-4, 0, s1}},
            {{4, 0, -s0}, {4, 0, -s1}},
            {{4 * s0, -1, 0}, {4 * s1, -1, 0}},
            {{4 * s0, 1, 0}, {4 * s1, 1, 0}}};
}

TEST(instants, contact_at_one_double) {
    expect_contact_only_at(0.5,
                           ccd::vertex_vertex<double>{rest(0, 0, 0), {{1, 2, 3}, {-1, -2, -3}}});
    expect_contact_only_at(
        0.25, ccd::vertex_edge<double>{{{0, 1, 0}, {0, -3, 0}}, rest(-1, 0, 0), rest(1, 0, 0)});
    expect_contact_only_at(
        0.25, ccd::vertex_face<double>{
                  {{0, 0, 1}, {0, 0, -3}}, rest(-1, -1, 0), rest(1, -1, 0), rest(0, 1, 0)});
    expect_contact_only_at(
        0.75,
        ccd::edge_edge<double>{
            rest(-1, 0, 0), rest(1, 0, 0), {{0, -1, 3}, {0, -1, -1}}, {{0, 1, 3}, {0, 1, -1}}});
    expect_contact_only_at(0.5, grazing(-1, 1));
}

TEST(instants, contact_between_neighbouring_doubles) {
    for (const double s1 : {2.0, 6.0}) {  // at 1/3 and 1/7
        const auto q = grazing(-1, s1);
        const double near_t = 1 / (1 + s1);
        const double low = std::fma(near_t, 1 + s1, -1) > 0 ? before(near_t) : near_t;
        EXPECT_FALSE(touches(q, {0, low}));
        EXPECT_TRUE(touches(q, {low, after(low), false, false}));
        EXPECT_FALSE(touches(q, {after(low), 1}));
    }
}

TEST(instants, contact_throughout_shows_where_nothing_changes) {
    // A vertex in the triangle's plane, inside it from t = 1/2 on.
    const ccd::vertex_face<double> q{
        {{-2, 0.5, 0}, {2, 0.5, 0}}, rest(0, 0, 0), rest(4, 0, 0), rest(0, 4, 0)};
    EXPECT_FALSE(touches(q, {.high = 0.5, .with_high = false}));
    EXPECT_TRUE(touches(q, interval::instant(0.5)));
    EXPECT_TRUE(touches(q, {0.5, 0.625, false, false}));
    EXPECT_TRUE(touches(q, {0.6, 0.7, false, false}));
    EXPECT_FALSE(touches(q, {0.1, 0.2, false, false}));
}

TEST(instants, times_below_the_least_double) {
    // w moves from 2^-1074 to -2^900: contact at about 2^-1974.
    const ccd::vertex_vertex<double> q{rest(0, 0, 0), {{0x1p-1074, 0, 0}, {-0x1p900, 0, 0}}};
    EXPECT_FALSE(touches(q, interval::instant(0)));
    EXPECT_TRUE(touches(q, {0, 0x1p-1074, false, false}));
}

TEST(instants, no_time_at_all) {
    const ccd::vertex_vertex<double> q{rest(1, 1, 1), rest(1, 1, 1)};
    EXPECT_TRUE(touches(q, interval::instant(0.5)));
    EXPECT_FALSE(touches(q, {0, 0, true, false}));
    EXPECT_FALSE(touches(q, {0.5, 0.5, false, true}));
}

// Within distance d, and not within the next smaller double.
template <class Query>
void expect_distance(double d, const Query& q, const interval& when = interval()) {
    EXPECT_TRUE(near(q, d, when));
    EXPECT_TRUE(near(q, after(d), when));
    EXPECT_FALSE(near(q, before(d), when));
}

TEST(distance, of_a_vertex_that_passes) {
    const ccd::vertex_vertex<double> q{rest(0, 0, 0), {{-12, 3, 4}, {12, 3, 4}}};
    expect_distance(5, q);
    expect_distance(5, q, interval::instant(0.5));
    expect_distance(13, q, interval::instant(0));
    EXPECT_FALSE(near(q, 5, {.high = 0.5, .with_high = false}));
    EXPECT_TRUE(oracle::within(q, 2, 3));
    // Sums that are not doubles.
    EXPECT_TRUE(oracle::within(q, 5, 0x1p-1074, shortcuts::on, {.high = 0.5, .with_high = false}));
    EXPECT_FALSE(oracle::within(q, before(5), 0x1p-60));
}

TEST(distance, from_faces_and_edges) {
    const auto from_face = [](double d, moving v, moving f2) {
        expect_distance(d, ccd::vertex_face<double>{v, rest(0, 0, 0), rest(8, 0, 0), f2});
    };
    from_face(3, rest(1, 2, 3), rest(0, 8, 0));      // inside
    from_face(5, rest(3, -3, 4), rest(0, 8, 0));     // f0 f1
    from_face(13, rest(11, -4, 12), rest(0, 8, 0));  // f1
    from_face(5, rest(5, 3, 4), rest(2, 0, 0));      // a segment
    const auto from_x = [](double d, moving b0, moving b1) {
        expect_distance(d, ccd::edge_edge<double>{rest(-4, 0, 0), rest(4, 0, 0), b0, b1});
    };
    from_x(3, rest(1, -2, 3), rest(1, 2, 3));    // crossing
    from_x(5, rest(1, 3, 4), rest(1, 6, 8));     // an end and an inside
    from_x(5, rest(-9, 3, 4), rest(9, 3, 4));    // parallel, side by side
    from_x(13, rest(7, 4, 12), rest(9, 4, 12));  // parallel, apart
}

TEST(faults, of_brackets) {
    const auto q = grazing(-1, 2);  // at 1/3
    const double low = 1 / 3.0, high = after(low);
    const auto fault = [&](double a, double b, double t_max = 1) {
        return support::fault_of(q, first_time{outcome::collides, a, b}, t_max);
    };
    EXPECT_EQ(fault(low, high), "");
    EXPECT_EQ(fault(low, high, high), "");
    EXPECT_EQ(fault(low, high, low), "it is outside [0, t_max]");
    EXPECT_EQ(fault(before(low), low), "it does not hold between");
    EXPECT_EQ(fault(high, after(high)), "it holds at low or before");
    EXPECT_EQ(fault(before(low), high), "the ends are not adjacent");
    EXPECT_EQ(fault(high, low), "it is outside [0, t_max]");
    EXPECT_EQ(fault(low, low), "it does not hold at that instant");
    EXPECT_EQ(support::fault_of(q, first_time{outcome::separate}), "there is one");
    EXPECT_EQ(support::fault_of(q, first_time{outcome::separate}, low), "");
    EXPECT_EQ(support::fault_of(q, first_time{outcome::separate}, -1), "");
    EXPECT_EQ(support::fault_of(q, first_time{}), "it is uncertain");
}

TEST(families, distance_0_is_contact) {
    query_families::for_some_queries(
        support::scaled(30), 5, [](const auto& q, const std::string& text) {
            for (const interval when : {interval{}, interval{0, 0.5, true, false},
                                        interval{0.25, 0.75, false, false}, interval::instant(0.5)})
                EXPECT_EQ(oracle::within(q, 0, 0, shortcuts::on, when),
                          oracle::collides(q, shortcuts::on, when))
                    << text;
        });
}

TEST(families, shortcuts_change_nothing) {
    query_families::for_some_queries(
        support::scaled(180), 1, [](const auto& q, const std::string& text) {
            EXPECT_EQ(oracle::collides(q, shortcuts::on), oracle::collides(q, shortcuts::off))
                << text;
        });
    query_families::for_some_queries(
        support::scaled(6), 5, [](const auto& q, const std::string& text) {
            for (const double d : {0.0, 0.125, 1.0})
                for (const interval when : {interval{}, interval{0.25, 0.75, false, false}}) {
                    SCOPED_TRACE(std::to_string(d) + " " + text);
                    near(q, d, when);  // expects the same with and without
                }
        });
}

}  // namespace
