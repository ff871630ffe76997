// Predicates against rationals: every stage alone is right or uncertain, and all together are
// right, on inputs of all kinds and sizes. ERRBOUND_PREDICATE_INPUTS: inputs per predicate and
// family.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <boost/multiprecision/gmp.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <errbound/multiprecision.hpp>
#include <errbound/predicate_batch.hpp>
#include <errbound/predicates.hpp>
#include <limits>
#include <span>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "predicate_inputs.hpp"

namespace {

using errbound::predicate_stage;
using errbound::sign_type;
using predicate_inputs::surface;
using rational = boost::multiprecision::number<boost::multiprecision::gmp_rational,
                                               boost::multiprecision::et_off>;

int inputs_per_family() {
    const char* const text = std::getenv("ERRBOUND_PREDICATE_INPUTS");
    return text == nullptr ? 4000 : std::atoi(text);
}

/// By Laplace expansion along the last column.
template <std::size_t N>
rational determinant(const std::array<std::array<rational, N>, N>& m) {
    if constexpr (N == 1) {
        return m[0][0];
    } else {
        rational sum = 0;
        for (std::size_t i = 0; i < N; ++i) {
            std::array<std::array<rational, N - 1>, N - 1> minor;
            for (std::size_t row = 0; row + 1 < N; ++row)
                for (std::size_t column = 0; column + 1 < N; ++column)
                    minor[row][column] = m[row < i ? row : row + 1][column];
            const rational term = m[i][N - 1] * determinant(minor);
            sum += (i + N - 1) % 2 == 0 ? term : rational(-term);
        }
        return sum;
    }
}

/// What the predicates are: determinants of the points' coordinates, for the round ones their
/// squared lengths, and 1. (The signs are those of the head of errbound/predicates.hpp.)
template <class T, std::size_t D, std::size_t N>
sign_type flat_sign(const predicate_inputs::points<T, D, N>& p) {
    std::array<std::array<rational, N>, N> m;
    for (std::size_t i = 0; i < N; ++i) {
        for (std::size_t k = 0; k < D; ++k) m[i][k] = p[i][k];
        m[i][D] = 1;
    }
    return errbound::sign_of(determinant(m));
}
template <class T, std::size_t D, std::size_t N>
sign_type round_sign(const predicate_inputs::points<T, D, N>& p) {
    std::array<std::array<rational, N>, N> m;
    for (std::size_t i = 0; i < N; ++i) {
        m[i][D] = 0;
        for (std::size_t k = 0; k < D; ++k) {
            m[i][k] = p[i][k];
            m[i][D] += m[i][k] * m[i][k];
        }
        m[i][D + 1] = 1;
    }
    return errbound::sign_of(determinant(m));
}

/// The same expression over rationals, all by itself.
struct rational_options : errbound::predicate_options {
    using exact_type = rational;
};
template <class Shape, class F, class Options>
auto over_rationals(const errbound::predicate_type<Shape, F, Options>&) {
    return [](const auto& points) {
        return std::apply(
            [](const auto&... p) {
                return errbound::predicate_type<Shape, F, rational_options>().by(
                    predicate_stage::long_integers, p...);
            },
            points);
    };
}

std::string replay(const auto& points) {
    std::string text;
    char number[40];
    for (const auto& p : points)
        for (const auto x : p) {
            std::snprintf(number, sizeof number, " %a", static_cast<double>(x));
            text += number;
        }
    return text;
}

template <class T, std::size_t D, std::size_t N, class Predicate, class Exact>
errbound::predicate_report compare(const Predicate& predicate, const Exact& exact, surface s) {
    predicate_inputs::generator random(7);
    errbound::predicate_report report;
    std::uint64_t all = 0;
    for (const auto& family : predicate_inputs::families<T, D, N>)
        for (int i = 0; i < inputs_per_family(); ++i, ++all) {
            const auto p = family.make(random, s);
            const sign_type right = exact(p);
            std::apply(
                [&](const auto&... q) {
                    ASSERT_EQ(predicate(report, q...), right) << family.name << replay(p);
                    for (std::size_t k = 0; k < errbound::predicate_stage_count; ++k) {
                        const sign_type found = predicate.by(static_cast<predicate_stage>(k), q...);
                        ASSERT_TRUE(found == right || found == sign_type::uncertain)
                            << family.name << ", stage " << k << replay(p);
                    }
                },
                p);
            if (testing::Test::HasFatalFailure()) return report;
        }
    std::uint64_t decided = 0;
    for (const std::uint64_t n : report.decided) decided += n;
    EXPECT_EQ(decided, all);
    return report;
}
/// The same, where the inputs are degenerate in all the ways that take all stages.
template <class T, std::size_t D, std::size_t N, class Predicate, class Exact>
void compare_in_all_stages(const Predicate& predicate, const Exact& exact, surface s) {
    const auto report = compare<T, D, N>(predicate, exact, s);
    for (const auto stage : {predicate_stage::static_filter, predicate_stage::short_integers,
                             predicate_stage::two_word_integers, predicate_stage::long_integers})
        EXPECT_GT(report[stage], 0u);
    if (Predicate::coordinate_bits(127) < 61) {
        EXPECT_GT(report[predicate_stage::exact_doubles], 0u);
        EXPECT_GT(report[predicate_stage::word_integers], 0u);
    }
}

template <class T>
class Predicates : public testing::Test {};
using number_types = testing::Types<float, double>;
TYPED_TEST_SUITE(Predicates, number_types);

TYPED_TEST(Predicates, Orient2d) {
    compare_in_all_stages<TypeParam, 2, 3>(errbound::orient2d, flat_sign<TypeParam, 2, 3>,
                                           surface::flat);
}
TYPED_TEST(Predicates, Orient3d) {
    compare_in_all_stages<TypeParam, 3, 4>(errbound::orient3d, flat_sign<TypeParam, 3, 4>,
                                           surface::flat);
}
TYPED_TEST(Predicates, Incircle) {
    compare_in_all_stages<TypeParam, 2, 4>(errbound::incircle, round_sign<TypeParam, 2, 4>,
                                           surface::round);
}
TYPED_TEST(Predicates, Insphere) {
    compare_in_all_stages<TypeParam, 3, 5>(errbound::insphere, round_sign<TypeParam, 3, 5>,
                                           surface::round);
}
TYPED_TEST(Predicates, OfTheirOwnExpression) {
    using T = TypeParam;
    const auto run = [](const auto& predicate, auto dimension, auto count, surface s) {
        compare<T, dimension(), count()>(predicate, over_rationals(predicate), s);
    };
    const std::integral_constant<std::size_t, 2> two;
    const std::integral_constant<std::size_t, 3> three;
    const std::integral_constant<std::size_t, 4> four;
    const std::integral_constant<std::size_t, 5> five;
    const std::integral_constant<std::size_t, 6> six;
    const std::integral_constant<std::size_t, 8> eight;
    run(errbound::power_incircle, three, four, surface::round);
    run(errbound::power_insphere, four, five, surface::round);
    run(errbound::compare_distances2d, two, three, surface::round);
    run(errbound::compare_distances3d, three, three, surface::round);
    run(errbound::segments_intersect3d, three, four, surface::flat);
    run(errbound::segment_intersects_triangle, three, five, surface::flat);
    run(errbound::orient2d_line_line, two, six, surface::flat);
    run(errbound::orient3d_line_plane, three, eight, surface::flat);
    run(errbound::compare_x_line_line, two, eight, surface::flat);
}

using point2 = std::array<double, 2>;
using point3 = std::array<double, 3>;

TEST(Signs, AreThoseOfThePicture) {
    using enum sign_type;
    EXPECT_EQ(errbound::orient2d(point2{0, 0}, point2{1, 0}, point2{0.5, 1}), positive);
    const point3 a{0, 0, 0}, b{1, 0, 0}, c{0, 1, 0}, above{0, 0, 1}, below{0, 0, -1};
    EXPECT_EQ(errbound::orient3d(a, b, c, below), positive);
    EXPECT_EQ(errbound::orient3d(a, b, c, above), negative);
    EXPECT_EQ(errbound::incircle(point2{0, 0}, point2{1, 0}, point2{0, 1}, point2{0.9, 0.9}),
              positive);
    EXPECT_EQ(errbound::incircle(point2{0, 0}, point2{1, 0}, point2{0, 1}, point2{1, 1}), zero);
    EXPECT_EQ(errbound::insphere(a, b, c, below, point3{0.25, 0.25, -0.25}), positive);
    EXPECT_EQ(errbound::insphere(a, b, c, below, point3{1, 1, 1}), negative);
    // Unit circles at three corners of a square of side 2, and points with weights at the fourth:
    // the orthogonal circle has its center in the middle and 1 for its squared radius.
    const auto power = [](double weight) {
        return errbound::power_incircle(point3{0, 0, 1}, point3{2, 0, 1}, point3{0, 2, 1},
                                        point3{2, 2, weight});
    };
    EXPECT_EQ(power(1), zero);
    EXPECT_EQ(power(1.5), positive);
    EXPECT_EQ(power(0.5), negative);
    EXPECT_EQ(errbound::compare_distances2d(point2{0, 0}, point2{1, 0}, point2{0, 2}), negative);
    EXPECT_EQ(errbound::compare_distances3d(a, above, b), zero);
}

TEST(Signs, OfSegments) {
    using enum sign_type;
    const auto at = [](const point3& a, const point3& b, const point3& c, const point3& d) {
        const sign_type s = errbound::segments_intersect3d(a, b, c, d);
        EXPECT_EQ(errbound::segments_intersect3d(d, c, a, b), s);
        EXPECT_EQ(errbound::segments_intersect3d(b, a, c, d), s);
        return s;
    };
    EXPECT_EQ(at({-1, 0, 1}, {1, 0, 1}, {0, -1, 1}, {0, 1, 1}), positive);
    EXPECT_EQ(at({-1, 0, 1}, {1, 0, 1}, {0, -1, 2}, {0, 1, 2}), negative);
    EXPECT_EQ(at({-1, 0, 1}, {1, 0, 1}, {0, 0, 1}, {0, 1, 1}), zero);  // a T
    EXPECT_EQ(at({-1, 0, 1}, {1, 0, 1}, {2, -1, 1}, {2, 1, 1}), negative);
    EXPECT_EQ(at({-1, 0, 1}, {1, 0, 1}, {2, 0, 1}, {2, 1, 1}), negative);  // end on the line
    EXPECT_EQ(at({0, 0, 0}, {2, 2, 2}, {1, 1, 1}, {3, 3, 3}), zero);       // overlap
    EXPECT_EQ(at({0, 0, 0}, {2, 2, 2}, {2, 2, 2}, {3, 3, 3}), zero);
    EXPECT_EQ(at({0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}), negative);
    EXPECT_EQ(at({1, 2, 3}, {1, 2, 3}, {1, 2, 3}, {1, 2, 3}), zero);  // points
    EXPECT_EQ(at({1, 1, 1}, {1, 1, 1}, {0, 0, 0}, {2, 2, 2}), zero);
    EXPECT_EQ(at({1, 1, 2}, {1, 1, 2}, {0, 0, 0}, {2, 2, 2}), negative);
}

TEST(Signs, OfSegmentAndTriangle) {
    using enum sign_type;
    const auto at = [](const point3& p, const point3& q, const point3& c = {0, 4, 0}) {
        const point3 a{0, 0, 0}, b{4, 0, 0};
        const sign_type s = errbound::segment_intersects_triangle(p, q, a, b, c);
        EXPECT_EQ(errbound::segment_intersects_triangle(q, p, c, b, a), s);
        EXPECT_EQ(errbound::segment_intersects_triangle(p, q, b, c, a), s);
        return s;
    };
    EXPECT_EQ(at({1, 1, -1}, {1, 1, 1}), positive);
    EXPECT_EQ(at({3, 3, -1}, {3, 3, 1}), negative);
    EXPECT_EQ(at({1, 1, 1}, {1, 1, 2}), negative);
    EXPECT_EQ(at({1, 1, 0}, {1, 1, 2}), zero);    // an end inside
    EXPECT_EQ(at({2, 2, -1}, {2, 2, 1}), zero);   // an edge
    EXPECT_EQ(at({4, 0, -1}, {4, 0, 1}), zero);   // a corner
    EXPECT_EQ(at({1, 1, 0}, {1.5, 1, 0}), zero);  // in the plane, inside
    EXPECT_EQ(at({-1, 1, 0}, {9, 1, 0}), zero);
    EXPECT_EQ(at({5, 5, 0}, {9, 1, 0}), negative);
    EXPECT_EQ(at({1, -1, 0}, {1, 1, 0}, {8, 0, 0}), zero);  // the triangle is a segment
    EXPECT_EQ(at({1, -1, 1}, {1, 1, 1}, {8, 0, 0}), negative);
    EXPECT_EQ(at({1, 1, 0}, {1, 1, 0}), zero);  // the segment is a point
    EXPECT_EQ(at({1, 1, 1}, {1, 1, 1}), negative);
}

TEST(Signs, OfImplicitPoints) {
    using enum sign_type;
    const point2 a{0, 0}, b{3, 3}, c{0, 2}, d{2, 0};  // they meet at (1, 1)
    const auto side = [&](const point2& q, const point2& r) {
        const sign_type s = errbound::orient2d_line_line(a, b, c, d, q, r);
        EXPECT_EQ(errbound::orient2d_line_line(a, b, d, c, q, r), s);
        EXPECT_EQ(errbound::orient2d(point2{1, 1}, q, r), s);
        return s;
    };
    EXPECT_EQ(side({5, 1}, {5, 2}), positive);
    EXPECT_EQ(side({5, 1}, {9, 1}), zero);
    EXPECT_EQ(side({5, 1}, {5, 0}), negative);
    EXPECT_EQ(errbound::orient2d_line_line(a, b, point2{1, 0}, point2{2, 1}, c, d), zero);
    EXPECT_EQ(errbound::compare_x_line_line(a, b, c, d, a, b, c, point2{4, 0}), negative);
    EXPECT_EQ(errbound::compare_x_line_line(a, b, c, d, point2{1, 5}, point2{1, 7}, c, b), zero);
    const point3 p{1, 1, -3}, q{1, 1, 9}, r{0, 0, 2}, s{1, 0, 2}, t{0, 1, 2};  // at (1, 1, 2)
    for (const point3& u : {point3{0, 0, 0}, point3{0, 0, 3}, point3{0, 0, 2}})
        EXPECT_EQ(errbound::orient3d_line_plane(p, q, r, s, t, point3{1, 0, 2}, point3{0, 1, 2}, u),
                  errbound::orient3d(point3{1, 1, 2}, point3{1, 0, 2}, point3{0, 1, 2}, u));
}

// The constants next to Shewchuk's A-filters (1997), in units of 2^-53: 3 + 16e, 7 + 56e, 10 + 96e
// and 16 + 224e.
constexpr double e = 0x1p-53;
static_assert(errbound::orient2d.static_constant<double> < 1.0001 * (3 + 16 * e) * e);
static_assert(errbound::orient3d.static_constant<double> < 1.0001 * (7 + 56 * e) * e);
static_assert(errbound::incircle.static_constant<double> < 1.0001 * (10 + 96 * e) * e);
static_assert(errbound::insphere.static_constant<double> < 1.0001 * (16 + 224 * e) * e);
static_assert(errbound::orient2d.counts.roundings == 3 &&
              errbound::orient3d.counts.roundings == 7 &&
              errbound::incircle.counts.roundings == 10 &&
              errbound::insphere.counts.roundings == 15);

// In constant expressions, in every stage.
static_assert(errbound::orient2d(point2{0, 0}, point2{1, 0}, point2{0, 1}) == sign_type::positive);
static_assert(errbound::orient2d(point2{0, 0}, point2{1, 1}, point2{2, 2}) == sign_type::zero);
static_assert(errbound::orient2d(point2{0, 0}, point2{0.1, 0.3}, point2{0x1p-90, 0x3p-90}) ==
              sign_type::positive);
static_assert(errbound::orient2d(point2{0, 0}, point2{1, 0x1p-1074}, point2{0x1p1000, 0x1p-74}) ==
              sign_type::zero);

/// No value is further from the exact one than its bound and the last rounding.
template <class T, std::size_t D, std::size_t N, class Predicate>
void attack(const Predicate&, surface s) {
    predicate_inputs::generator random(11);
    double worst = 0;
    for (const auto& family : predicate_inputs::families<T, D, N>)
        for (int i = 0; i < inputs_per_family(); ++i) {
            const auto p = family.make(random, s);
            const auto x =
                std::apply([](const auto&... q) { return Predicate::filtered(q...); }, p);
            if (!std::isfinite(x.value) || !std::isfinite(x.bound())) continue;
            auto exact = p;  // the determinant by the same expression: its value, not its sign
            const rational right = std::apply(
                [](const auto&... q) { return Predicate::template value<rational>(q...); }, exact);
            const rational error = abs(rational(rational(x.value) - right));
            const rational last =
                abs(rational(x.value)) * rational(errbound::number_traits<T>::unit_roundoff());
            ASSERT_LE(error, rational(x.bound()) + last) << family.name << replay(p);
            if (error > last)
                worst = std::max(
                    worst,
                    rational((error - last) / rational(x.bound())).template convert_to<double>());
        }
    EXPECT_GT(worst, 0.01);  // the bound is no more than it needs to be by orders of magnitude
    std::printf("used up at most %.3f of the bound\n", worst);
}
TYPED_TEST(Predicates, ConstantsHold) {
    attack<TypeParam, 2, 3>(errbound::orient2d, surface::flat);
    attack<TypeParam, 3, 4>(errbound::orient3d, surface::flat);
    attack<TypeParam, 2, 4>(errbound::incircle, surface::round);
    attack<TypeParam, 3, 5>(errbound::insphere, surface::round);
    attack<TypeParam, 3, 4>(errbound::power_incircle, surface::round);
    attack<TypeParam, 4, 5>(errbound::power_insphere, surface::round);
}

struct with_members {
    double x, y;
};
class with_functions {
  public:
    with_functions(double x, double y) : x_(x), y_(y) {}
    double x() const { return x_; }
    double y() const { return y_; }

  private:
    double x_, y_;
};

TEST(Points, AreWhatUsersHave) {
    const double a[2] = {0, 0}, b[2] = {1, 0}, c[2] = {0, 1};
    const std::vector<double> v{0, 1};
    EXPECT_EQ(errbound::orient2d(a, b, c), sign_type::positive);
    EXPECT_EQ(errbound::orient2d(std::span(a), b, v), sign_type::positive);
    EXPECT_EQ(errbound::orient2d(+a, with_members{1, 0}, with_functions{0, 1}),
              sign_type::positive);
    EXPECT_EQ(errbound::orient2d(std::array{0.f, 0.f}, std::array{1.f, 0.f}, c),
              sign_type::positive);
}

TEST(Points, ThatAreNotFinite) {
    for (const double bad :
         {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(),
          std::numeric_limits<double>::quiet_NaN()})
        for (std::size_t i = 0; i < 6; ++i) {
            std::array<double, 6> x{0.5, 1, 4, 2, 3, 9};
            x[i] = bad;
            const point2 a{x[0], x[1]}, b{x[2], x[3]}, c{x[4], x[5]};
            errbound::predicate_report report;
            EXPECT_EQ(errbound::orient2d(a, b, c), sign_type::uncertain);
            EXPECT_EQ(errbound::orient2d(report, a, b, c), sign_type::uncertain);
            EXPECT_EQ(report.undecided, 1u);
            for (std::size_t k = 0; k < errbound::predicate_stage_count; ++k)
                EXPECT_EQ(errbound::orient2d.by(static_cast<predicate_stage>(k), a, b, c),
                          sign_type::uncertain);
        }
}

// Plain numbers, whole constants, terms of different degree.
constexpr auto discriminant = errbound::predicate<errbound::points<0, 0, 0>>(
    [](const auto& a, const auto& b, const auto& c) { return b * b - 4 * (a * c); });
constexpr auto above_parabola = errbound::predicate<errbound::points<2>>(
    [](const auto& p) { return p[1] - p[0] * p[0] + (1 - 3 * p[0]); });
static_assert(!discriminant.counts.mixed && above_parabola.counts.mixed);
static_assert(discriminant(1.0, 2.0, 1.0) == sign_type::zero);
static_assert(above_parabola(point2{0x1p600, 0x1p1000}) == sign_type::negative);
static_assert(above_parabola(point2{0x1p-600, -1}) == sign_type::negative);
static_assert(above_parabola(point2{-0x1p-1074, -1}) == sign_type::positive);

TYPED_TEST(Predicates, OfAnyDegree) {
    using T = TypeParam;
    compare<T, 2, 1>(above_parabola, over_rationals(above_parabola), surface::flat);
    predicate_inputs::generator random(5);
    for (int i = 0; i < inputs_per_family(); ++i) {
        const auto p = predicate_inputs::stretched<T, 1, 3>(random, surface::flat);
        const T a = p[0][0], b = p[1][0], c = p[2][0];
        EXPECT_EQ(discriminant(a, b, c),
                  errbound::sign_of(rational(rational(b) * b - rational(4) * a * c)));
    }
}

struct tracked_options : errbound::predicate_options {
    using tracked_rule = errbound::tight;
};
TEST(Options, NameABoundRule) {
    const auto orient = errbound::predicate<errbound::points<2, 2, 2>, tracked_options>(
        [](const auto& a, const auto& b, const auto& c) { return errbound::forms::area(a, b, c); });
    const auto report = compare<double, 2, 3>(orient, flat_sign<double, 2, 3>, surface::flat);
    EXPECT_GT(report[predicate_stage::tracked], 0u);
}

template <class T, std::size_t D, class Predicate, std::size_t... I>
void compare_batch(const Predicate& predicate, surface s, std::index_sequence<I...>) {
    constexpr std::size_t N = sizeof...(I);
    predicate_inputs::generator random(3);
    for (const auto& family : predicate_inputs::families<T, D, N>) {
        const std::size_t count = 1000;  // not a whole number of blocks
        std::array<std::vector<std::array<T, D>>, N> points;
        std::array<std::array<std::vector<T>, D>, N> arrays;
        for (std::size_t i = 0; i < count; ++i) {
            const auto p = family.make(random, s);
            for (std::size_t k = 0; k < N; ++k) {
                points[k].push_back(p[k]);
                for (std::size_t d = 0; d < D; ++d) arrays[k][d].push_back(p[k][d]);
            }
        }
        const auto as_arrays = [&](std::size_t k) {
            errbound::coordinate_arrays<T, D> a{{}, count};
            for (std::size_t d = 0; d < D; ++d) a.coordinates[d] = arrays[k][d].data();
            return a;
        };
        std::vector<sign_type> one_by_one(count), batch(count), of_arrays(count);
        for (std::size_t i = 0; i < count; ++i) one_by_one[i] = predicate(points[I][i]...);
        errbound::batch_signs(predicate, batch, points[I]...);
        errbound::batch_signs(predicate, of_arrays, as_arrays(I)...);
        EXPECT_EQ(batch, one_by_one) << family.name;
        EXPECT_EQ(of_arrays, one_by_one) << family.name;
    }
}
TYPED_TEST(Predicates, InBatches) {
    using T = TypeParam;
    compare_batch<T, 2>(errbound::orient2d, surface::flat, std::make_index_sequence<3>());
    compare_batch<T, 3>(errbound::orient3d, surface::flat, std::make_index_sequence<4>());
    compare_batch<T, 2>(errbound::incircle, surface::round, std::make_index_sequence<4>());
    compare_batch<T, 3>(errbound::insphere, surface::round, std::make_index_sequence<5>());
    compare_batch<T, 3>(errbound::segments_intersect3d, surface::flat,
                        std::make_index_sequence<4>());
}
TEST(Batches, OfOnePointAgainstMany) {
    std::vector<point2> points;
    for (int i = 0; i < 200; ++i) points.push_back({i * 0.5, 50.0 - i});
    std::vector<sign_type> signs(points.size());
    errbound::batch_signs(errbound::orient2d, signs, errbound::every<point2>{{0, 0}},
                          errbound::every<point2>{{1, 0}}, points);
    for (std::size_t i = 0; i < points.size(); ++i)
        EXPECT_EQ(signs[i], i < 50    ? sign_type::positive
                            : i == 50 ? sign_type::zero
                                      : sign_type::negative);
}

}  // namespace
