// Derivatives of first times: by hand, and compared with differences of roots in 1,300-bit
// arithmetic.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <boost/multiprecision/gmp.hpp>
#include <ccd/contact.hpp>
#include <ccd/methods/transform.hpp>
#include <ccd/plane.hpp>
#include <cmath>
#include <cstddef>
#include <string>
#include <type_traits>
#include <vector>

#include "tests/ccd/contact/by_hand.hpp"
#include "tests/support/query_families.hpp"
#include "tests/support/scaled.hpp"

namespace {

namespace mp = boost::multiprecision;
using namespace by_hand;
using ccd::kind;
using ccd::time_derivative;

template <class Query>
time_derivative derivative(const Query& query) {
    return derivative_of(query, find_first_contact(query));
}
void expect_near(const ccd::moving_point<double>& found, point t0, point t1, double error) {
    const auto near = [error](const point& p, const point& q) {
        EXPECT_NEAR(p.x, q.x, error);
        EXPECT_NEAR(p.y, q.y, error);
        EXPECT_NEAR(p.z, q.z, error);
    };
    near(found.t0, t0);
    near(found.t1, t1);
}

TEST(time_derivatives, of_a_vertex_that_falls_on_a_face) {
    // t = h/(h + 3) for a vertex that falls from height h = 1 to −3 through the face's plane.
    const auto found = derivative(over_triangle({0.25, 0.5, 1}, {0.25, 0.5, -3}));
    EXPECT_LE(found.error, 1e-15);
    const double start = 3.0 / 16, end = 1.0 / 16;
    expect_near(found.by[0], {0, 0, start}, {0, 0, end}, found.error);
    expect_near(found.by[1], {0, 0, -start / 4}, {0, 0, -end / 4}, found.error);
    expect_near(found.by[3], {0, 0, -start / 2}, {0, 0, -end / 2}, found.error);
    // From the other side, a greater height is nearer to the face.
    expect_near(derivative(over_triangle({0.25, 0.5, -1}, {0.25, 0.5, 3})).by[0], {0, 0, -start},
                {0, 0, -end}, found.error);
}
TEST(time_derivatives, at_the_end_of_the_step_are_those_of_longer_motion) {
    const auto found = derivative(over_triangle({0.25, 0.5, 1}, {0.25, 0.5, 0}));
    expect_near(found.by[0], {0, 0, 0}, {0, 0, 1}, found.error);
    EXPECT_LE(found.error, 2e-15);
}
TEST(time_derivatives, of_a_vertex_and_an_edge_in_the_plane) {
    const ccd::plane::vertex_edge query{
        {{0.25, 1}, {0.25, -1}}, {{0, 0}, {0, 0}}, {{1, 0}, {1, 0}}};
    const auto found = derivative(query);
    EXPECT_LE(found.error, 1e-15);
    expect_near(found.by[0], {0, 0.25, 0}, {0, 0.25, 0}, found.error);
    expect_near(found.by[1], {0, -0.1875, 0}, {0, -0.1875, 0}, found.error);
    EXPECT_EQ(found.by[3], (ccd::moving_point<double>{}));
}
TEST(time_derivatives, are_undefined_where_the_time_is_not_differentiable) {
    const auto undefined = [](const auto& query) {
        const auto contact = find_first_contact(query);
        EXPECT_NE(contact.time.outcome, ccd::outcome::separate);
        EXPECT_EQ(derivative_of(query, contact), time_derivative{});
    };
    undefined(over_triangle({0.25, 0.5, 0}, {0.25, 0.5, -1}));  // at the start
    undefined(over_triangle({0, 0.75, 1}, {0.5, 0.75, -1}));    // on an edge
    undefined(over_triangle({0, 1, 1}, {0, 1, -1}));            // on a corner
    undefined(over_triangle({-0.25, 0, 0}, {0.75, 1, 0}));      // in the face's plane
    undefined(over_triangle({infinity, 0, 0}, {0, 0, 0}));
    // Edges that touch without crossing: a double root.
    undefined(edge_edge{still({-1, 0, 0}), still({1, 0, 0}), from_to({0, 0, 1}, {0, -2, -1}),
                        from_to({0, 2, -1}, {0, 0, 1})});
    // A sliver whose normal has no known direction.
    undefined(vertex_face{from_to({0.5, 0x1p-1060, 1}, {0.5, 0x1p-1060, -2}), still({0, 0, 0}),
                          still({1, 0, 0}), still({0.5, 0x1p-1058, 0})});
    // A vertex and an edge outside the plane z = 1, and two vertices.
    undefined(vertex_edge{from_to({0, 1, 1}, {0, -1, 1}), still({-1, 0, 1}),
                          from_to({1, 0, 0}, {1, 0, 2})});
    undefined(vertex_vertex{from_to({0, 0, 0}, {2, 0, 0}), still({1, 0, 0})});
    undefined(ccd::plane::vertex_edge{{{-1, 0}, {3, 0}}, {{0, 0}, {0, 0}}, {{1, 0}, {1, 0}}});
    EXPECT_EQ(derivative(over_triangle({2, 2, 1}, {2, 2, -1})), time_derivative{});
    const auto query = over_triangle({-3, -3, 5}, {-3, -3, 0});
    EXPECT_EQ(derivative_of(query, contact_at(query, ccd::time_within(query, {4.5, 0}))),
              time_derivative{});
}

// ---- Comparison with differences ----

using real = mp::number<mp::gmp_float<400>, mp::et_off>;
using rational = mp::number<mp::gmp_rational, mp::et_off>;

/// A value and its derivative in time.
struct jet {
    real value, slope;

    friend jet operator+(const jet& a, const jet& b) {
        return {a.value + b.value, a.slope + b.slope};
    }
    friend jet operator-(const jet& a, const jet& b) {
        return {a.value - b.value, a.slope - b.slope};
    }
    friend jet operator*(const jet& a, const jet& b) {
        return {a.value * b.value, a.value * b.slope + a.slope * b.value};
    }
};

template <class S>
using coordinates = std::array<std::array<std::array<S, 3>, 2>, 4>;  // point, end, axis

template <class S, class Query>
coordinates<S> coordinates_of(const Query& query) {
    coordinates<S> all{};
    std::size_t i = 0;
    for (const auto& p : points_of(query))
        all[i++] = {{{S(p.t0.x), S(p.t0.y), S(p.t0.z)}, {S(p.t1.x), S(p.t1.y), S(p.t1.z)}}};
    return all;
}

/// The polynomial that vanishes at contacts: six times the volume of the four points, or twice the
/// area of the three points in the plane.
template <class S>
S contact_polynomial(kind k, const std::array<std::array<S, 3>, 4>& at) {
    const auto minus = [&](std::size_t i, std::size_t axis) { return at[i][axis] - at[0][axis]; };
    const auto area = [&](std::size_t i, std::size_t j, std::size_t x, std::size_t y) {
        return minus(i, x) * minus(j, y) - minus(i, y) * minus(j, x);
    };
    if (k == kind::vertex_edge) return area(1, 2, 0, 1);
    return minus(3, 2) * area(1, 2, 0, 1) + minus(3, 0) * area(1, 2, 1, 2) +
           minus(3, 1) * area(1, 2, 2, 0);
}
jet polynomial_at(kind k, const coordinates<real>& x, const real& t) {
    std::array<std::array<jet, 3>, 4> at;
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const real way = x[i][1][axis] - x[i][0][axis];
            at[i][axis] = {x[i][0][axis] + t * way, way};
        }
    return contact_polynomial(k, at);
}
real root_near(kind k, const coordinates<real>& x, real t, int steps) {
    for (int i = 0; i < steps; ++i) {
        const jet y = polynomial_at(k, x, t);
        t -= y.value / y.slope;
    }
    return t;
}

/// True if the polynomial has a multiple root in the bracket, or is zero.
template <class Query>
bool has_multiple_root(const Query& query, const ccd::first_time& time) {
    const auto x = coordinates_of<rational>(query);
    const auto value = [&](int t) {
        std::array<std::array<rational, 3>, 4> at;
        for (std::size_t i = 0; i < 4; ++i)
            for (std::size_t axis = 0; axis < 3; ++axis)
                at[i][axis] = x[i][0][axis] + t * (x[i][1][axis] - x[i][0][axis]);
        return contact_polynomial(ccd::kind_of<Query>, at);
    };
    // a t³ + b t² + c t + d, by its values at −1, 0, 1 and 2.
    const rational d = value(0), even = (value(1) + value(-1)) / 2,
                   odd = (value(1) - value(-1)) / 2;
    const rational b = even - d, a = (value(2) - d - 4 * b - 2 * odd) / 6, c = odd - a;
    const auto inside = [&](const rational& root) {
        return rational(time.low) <= root && root <= rational(time.high);
    };
    if (a == 0 && b == 0) return c == 0 && d == 0;
    if (a == 0) return c * c == 4 * b * d && inside(-c / (2 * b));
    const rational left = b * b - 3 * a * c, right = c * c - 3 * b * d, mixed = b * c - 9 * a * d;
    if (mixed * mixed != 4 * left * right) return false;
    return inside(left == 0 ? rational(-b / (3 * a)) : rational(-mixed / (2 * left)));
}

/// Compares a defined derivative with central differences of the root. Each difference moves the
/// root by about 2^-600 of t and of the distance to the nearest extremum, so the differences are
/// right to some 600 bits.
template <class Query>
std::string fault_of(const Query& query, const ccd::first_time& time,
                     const time_derivative& found) {
    constexpr kind k = ccd::kind_of<Query>;
    auto x = coordinates_of<real>(query);
    const real low(time.low), high(time.high);
    const real t = root_near(k, x, (low + high) / 2, 12);
    if (t < low || t > high) return "no simple root in the bracket";
    const real slope = polynomial_at(k, x, t).slope, step = ldexp(real(1), -600);
    const real bend = polynomial_at(k, x, t + t * step).slope - slope;
    const real to_extremum = bend == 0 ? t : real(abs(slope / bend) * t * step);
    const real move = step * (to_extremum < t ? to_extremum : t);
    for (std::size_t i = 0; i < 4; ++i) {
        const auto claimed = coordinates_of<double>(ccd::vertex_vertex<double>{found.by[i], {}})[0];
        for (std::size_t end = 0; end < 2; ++end)
            for (std::size_t axis = 0; axis < 3; ++axis) {
                if (k == kind::vertex_edge && (axis == 2 || i == 3)) {
                    if (claimed[end][axis] != 0) return "a derivative across the plane";
                    continue;
                }
                const real at = x[i][end][axis];
                const real h = move / (abs(real(claimed[end][axis])) + found.error);
                x[i][end][axis] = at + h;
                const real after = root_near(k, x, t, 1);
                x[i][end][axis] = at - h;
                const real before = root_near(k, x, t, 1);
                x[i][end][axis] = at;
                if (abs((after - before) / (2 * h) - real(claimed[end][axis])) > real(found.error))
                    return "component " + std::to_string(axis) + " by point " + std::to_string(i) +
                           " at t = " + std::to_string(end);
            }
    }
    return "";
}

double largest_component(const time_derivative& found) {
    double largest = 0;
    for (const auto& p : found.by)
        for (const auto& q : {p.t0, p.t1})
            largest = std::max({largest, std::abs(q.x), std::abs(q.y), std::abs(q.z)});
    return largest;
}

struct counts {
    int defined = 0, multiple = 0, plain = 0;
    std::vector<double> plain_errors;  // relative, of defined derivatives of plain queries
};

template <class Query>
void check(const Query& query, const std::string& text, counts& count) {
    constexpr kind k = ccd::kind_of<Query>;
    const auto contact = ccd::find_first_contact(query);
    if (contact.time.outcome != ccd::outcome::collides) return;
    const auto found = derivative_of(query, contact);
    const bool inside =
        k != kind::vertex_vertex && contact.features.kind == k && !contact.time.at_start();
    const bool multiple = inside && has_multiple_root(query, contact.time);
    count.multiple += multiple;
    if (!inside || multiple) {
        EXPECT_EQ(found, time_derivative{}) << text;
        return;
    }
    const bool plain = text.starts_with("contact ") || text.starts_with("uniform ");
    count.plain += plain;
    if (!found.is_defined()) return;
    ++count.defined;
    EXPECT_EQ(fault_of(query, contact.time, found), "") << text;
    if (plain) count.plain_errors.push_back(found.error / largest_component(found));
}

TEST(time_derivative_families, are_within_their_errors_of_differences) {
    counts count;
    query_families::for_some_queries(
        support::scaled(50), 29, [&]<class Query>(const Query& query, const std::string& text) {
            if constexpr (std::is_same_v<Query, vertex_edge>) {
                const auto in_plane = [](const point& p) { return point{p.x, p.y, 0}; };
                check(ccd::transformed_points(query, in_plane), text, count);
                const auto& z = query.v.t0.z;
                if (z != query.v.t1.z || z != query.e0.t0.z || z != query.e1.t1.z) {
                    EXPECT_EQ(derivative(query), time_derivative{}) << text;
                }
            } else {
                check(query, text, count);
            }
        });
    RecordProperty("defined", count.defined);
    RecordProperty("multiple_roots", count.multiple);
    EXPECT_GE(count.defined, support::scaled(2000));
    EXPECT_GE(count.multiple, support::scaled(200) / 20);
    EXPECT_GE(static_cast<double>(count.plain_errors.size()), 0.99 * count.plain);
    ASSERT_GT(count.plain_errors.size(), 0U);
    std::ranges::sort(count.plain_errors);
    EXPECT_LT(count.plain_errors[count.plain_errors.size() / 2], 1e-13);
}

}  // namespace
