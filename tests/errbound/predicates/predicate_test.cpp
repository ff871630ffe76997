// The stages of predicates, on orient2d, orient3d, incircle and insphere: signs compared with
// determinants in integers, on inputs of all kinds and sizes; constants; types of points.
#include <array>
#include <cstddef>
#include <cstdint>
#include <errbound/predicates.hpp>
#include <limits>
#include <set>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "tests/errbound/predicates/predicate_check.hpp"

namespace {

using namespace predicate_check;

template <class T, class Entry>
void compare_in_all_stages(const Entry& entry) {
    const auto report = compare_entry<T>(entry, entry.surfaces[0]);
    for (const auto stage : {predicate_stage::static_filter, predicate_stage::short_integers,
                             predicate_stage::two_word_integers, predicate_stage::long_integers})
        EXPECT_GT(report[stage], 0u);
    if (entry.predicate.coordinate_bits(127) < 61) {
        EXPECT_GT(report[predicate_stage::exact_doubles], 0u);
        EXPECT_GT(report[predicate_stage::word_integers], 0u);
    }
}

template <class T>
class Predicates : public testing::Test {};
using number_types = testing::Types<float, double>;
TYPED_TEST_SUITE(Predicates, number_types);

// orient2d, orient3d, incircle and insphere
TYPED_TEST(Predicates, OfShewchukAreDecidedByAllStages) {
    [&]<std::size_t... I>(std::index_sequence<I...>) {
        (compare_in_all_stages<TypeParam>(std::get<I>(predicate_list::all)), ...);
    }
    (std::make_index_sequence<4>());
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
// The numbers in the theorems of their static filters.
static_assert(errbound::power_incircle.counts.roundings == 11 &&
              errbound::power_insphere.counts.roundings == 16 &&
              errbound::compare_distances2d.counts.roundings == 4 &&
              errbound::compare_distances3d.counts.roundings == 5 &&
              errbound::orient2d_line_line.counts.roundings == 9 &&
              errbound::orient3d_line_plane.counts.roundings == 17 &&
              errbound::compare_x_line_line.counts.roundings == 12);

// In constant expressions, in every stage.
static_assert(errbound::orient2d(point2{0, 0}, point2{1, 0}, point2{0, 1}) == sign_type::positive);
static_assert(errbound::orient2d(point2{0, 0}, point2{1, 1}, point2{2, 2}) == sign_type::zero);
static_assert(errbound::orient2d(point2{0, 0}, point2{0.1, 0.3}, point2{0x1p-90, 0x3p-90}) ==
              sign_type::positive);
static_assert(errbound::orient2d(point2{0, 0}, point2{1, 0x1p-1074}, point2{0x1p1000, 0x1p-74}) ==
              sign_type::zero);

/// Checks that no value of a semi-static filter differs from the exact one by more than its bound
/// and the last rounding. (Static filters: tests/soak.)
template <class T, std::size_t D, std::size_t N, class Predicate>
void attack(const Predicate&, surface s) {
    predicate_inputs::generator random(11);
    double worst = 0;
    for (const auto& family : predicate_inputs::families<T, D, N>)
        for (int i = 0; i < inputs_per_family(); ++i) {
            const auto p = family.make(random, s);
            const auto x =
                std::apply([](const auto&... q) { return Predicate::estimate(q...); }, p);
            if (!std::isfinite(x.value) || !std::isfinite(x.bound)) continue;
            // The determinant by the same expression, because its value counts.
            const rational right = std::apply(
                [](const auto&... q) { return Predicate::template value<rational>(q...); }, p);
            const rational error = abs(rational(rational(x.value) - right));
            const rational last =
                abs(rational(x.value)) * rational(errbound::number_traits<T>::unit_roundoff());
            ASSERT_LE(error, rational(x.bound) + last)
                << family.name << predicate_inputs::text_of(p);
            if (error > last)
                worst = std::max(
                    worst,
                    rational((error - last) / rational(x.bound)).template convert_to<double>());
        }
    EXPECT_GT(worst, 1e-4);  // the bound is not too large by many orders of magnitude
    std::printf("used up at most %.3f of the bound\n", worst);
}
/// A predicate of degree 6 with integer constants.
constexpr auto sextic =
    errbound::predicate<errbound::points<2, 2>>([](const auto& a, const auto& b) {
        const auto x = a[0] - b[0], y = a[1] - b[1];
        return 3 * (x * x * x) * (a[1] * b[0] * b[1]) - (a[0] * b[0] * a[1]) * (y * y * y) * 5;
    });
static_assert(errbound::insphere.has_semi_static_filter && sextic.has_semi_static_filter);
static_assert(!errbound::incircle.has_semi_static_filter &&
              !errbound::segment_intersects_triangle.has_semi_static_filter &&
              !errbound::power_insphere.has_semi_static_filter);

/// The masses of these are 0, or have too many bits for T.
template <int Factor>
constexpr auto heavy = errbound::predicate<errbound::points<2>>([](const auto& a) {
    return (Factor * (a[0] * a[0])) * (Factor * (a[0] * a[0])) * a[1] +
           a[1] * a[1] * a[1] * a[1] * a[1];
});
static_assert(heavy<0>.has_semi_static_filter);

TYPED_TEST(Predicates, SemiStaticFiltersNeedExactMasses) {
    const std::array<TypeParam, 2> p{2, 3};
    EXPECT_FALSE(std::isinf(heavy<100>.template estimate<>(p).bound));
    EXPECT_TRUE(std::isinf(heavy<1 << 30>.template estimate<>(p).bound));
    EXPECT_TRUE(std::isinf(heavy<0>.template estimate<>(p).bound));
}

TYPED_TEST(Predicates, SemiStaticBoundsHold) {
    attack<TypeParam, 2, 2>(sextic, surface::flat);
    attack<TypeParam, 3, 5>(errbound::insphere, surface::round);
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

TEST(Points, OfAnyType) {
    const double a[2] = {0, 0}, b[2] = {1, 0}, c[2] = {0, 1};
    const std::vector<double> v{0, 1};
    EXPECT_EQ(errbound::orient2d(a, b, c), sign_type::positive);
    EXPECT_EQ(errbound::orient2d(std::span(a), b, v), sign_type::positive);
    EXPECT_EQ(errbound::orient2d(+a, with_members{1, 0}, with_functions{0, 1}),
              sign_type::positive);
    EXPECT_EQ(errbound::orient2d(std::array{0.f, 0.f}, std::array{1.f, 0.f}, c),
              sign_type::positive);
}

TEST(Points, ThatAreNotFiniteAreUncertain) {
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

// Plain numbers, integer constants, terms of different degree.
constexpr auto discriminant = errbound::predicate<errbound::points<0, 0, 0>>(
    [](const auto& a, const auto& b, const auto& c) { return b * b - 4 * (a * c); });
constexpr auto above_parabola = errbound::predicate<errbound::points<2>>(
    [](const auto& p) { return p[1] - p[0] * p[0] + (1 - 3 * p[0]); });
static_assert(!discriminant.counts.mixed && above_parabola.counts.mixed);
static_assert(discriminant(1.0, 2.0, 1.0) == sign_type::zero);
static_assert(above_parabola(point2{0x1p600, 0x1p1000}) == sign_type::negative);
static_assert(above_parabola(point2{0x1p-600, -1}) == sign_type::negative);
static_assert(above_parabola(point2{-0x1p-1074, -1}) == sign_type::positive);

// Ways to pass on an uncertain sign that the compiler must accept: an answer that does not depend
// on it, at once or later; products of signs; a second evaluation.
constexpr auto in_box =
    errbound::predicate<errbound::points<2, 2, 2>>([](const auto& p, const auto& a, const auto& b) {
        sign_type inside = sign_type::positive;
        for (int i = 0; i < 2; ++i) {
            const sign_type low = sign_of(p[i] - a[i]), high = sign_of(b[i] - p[i]);
            if (low == sign_type::negative || high == sign_type::negative)
                return sign_type::negative;
            if (!certain(low) || !certain(high)) return sign_type::uncertain;
            inside = inside * low * high;
        }
        return inside;
    });
constexpr auto lexicographic =
    errbound::predicate<errbound::points<2, 2>>([](const auto& a, const auto& b) {
        const sign_type x = sign_of(a[0] - b[0]);
        return x == sign_type::zero ? sign_of(a[1] - b[1]) : x;
    });
constexpr auto by_product = errbound::predicate<errbound::points<0, 0>>(
    [](const auto& x, const auto& y) { return sign_of(x) * sign_of(x - y) * -sign_of(y - x); });
static_assert(in_box(point2{1, 1}, point2{0, 0}, point2{2, 1}) == sign_type::zero);
static_assert(in_box(point2{3, 1}, point2{0, 0}, point2{2, 1}) == sign_type::negative);
static_assert(lexicographic(point2{1, 1}, point2{1, 2}) == sign_type::negative);
static_assert(by_product(2.0, 1.0) == sign_type::positive);

/// It evaluates signs of several degrees, and the longest number does not have the highest.
constexpr auto cubic_if_real =
    errbound::predicate<errbound::points<0, 0, 0>>([](const auto& a, const auto& b, const auto& c) {
        using errbound::sign_of;
        const sign_type s = sign_of(b * b - 4 * a * c);
        if (s != sign_type::positive) return s;
        return sign_of(a * a * a - b * b * c);
    });
/// The constants leave no coordinates that fit two words.
constexpr auto with_many_constants = errbound::predicate<errbound::points<0, 0, 0, 0>>(
    [](const auto& a, const auto& b, const auto& c, const auto& d) {
        return (2 * (2 * (2 * (2 * (2 * a))))) * (b * c * d) - a * b * c * d;
    });
TYPED_TEST(Predicates, OfAnyDegreesAndConstants) {
    using T = TypeParam;
    const auto report = compare<T, 2, 2>(sextic, over_rationals(sextic), surface::flat);
    EXPECT_GT(report[predicate_stage::semi_static_filter], 0u);
    EXPECT_GT(report[predicate_stage::static_filter], 0u);
    compare<T, 2, 1>(above_parabola, over_rationals(above_parabola), surface::flat);
    compare<T, 1, 3>(discriminant, over_rationals(discriminant), surface::flat);
    compare<T, 1, 3>(cubic_if_real, over_rationals(cubic_if_real), surface::flat);
    compare<T, 1, 4>(with_many_constants, over_rationals(with_many_constants), surface::flat);
}

// The check of an expression took multiples of the largest int for zero.
TEST(Predicates, WithTheLargestConstants) {
    const auto order = errbound::predicate<errbound::points<0, 0>>(
        [](const auto& a, const auto& b) { return 2147483647 * a - 2147483647 * b; });
    EXPECT_EQ(order(1.0, 0.0), sign_type::positive);
    EXPECT_EQ(order(-0x1p1000, 0x1p-1000), sign_type::negative);
}

/// It has more sequences of signs than are counted, and the last number is longer.
constexpr auto behind_many_signs =
    errbound::predicate<errbound::points<3, 3>>([](const auto& a, const auto& b) {
        using errbound::sign_of;
        const auto d = [&](int i) { return (a[i] - b[i]) * (a[(i + 1) % 3] - b[i]); };
        const sign_type first = sign_of(a[0]);
        if (!certain(first)) return first;
        if (first == sign_type::positive) return sign_of(d(0) * d(1) * d(2) - d(1) * d(1) * d(0));
        const sign_type second = sign_of(d(0) * a[0] - d(1) * a[1]);
        if (!certain(second)) return second;
        for (const int i : {1, 2}) {
            const sign_type s = sign_of(d(i)), t = sign_of(b[i]);
            if (!certain(s)) return s;
            if (!certain(t)) return t;
        }
        return sign_of(d(2) * d(0) - d(1) * d(2));
    });
static_assert(!behind_many_signs.counts.complete);
TEST(Predicates, WithBranchesThatAreNotCounted) {
    compare<double, 3, 2>(behind_many_signs, over_rationals(behind_many_signs), surface::flat);
}

// Up to 32 numbers per uncertain one, each is also uncertain both without and after zeros.
TEST(ExpressionCheck, MakesEverySignUncertain) {
    using namespace errbound::filters;
    for (std::uint64_t count = 1; count <= counting_run::max_signs; count += 5) {
        std::set<std::uint64_t> uncertain[2];
        for (std::uint64_t supposition = 0; supposition < suppositions; ++supposition) {
            const auto fault = find_fault(supposition, [&](supposed_signs& signs) {
                for (std::uint64_t number = 1; number <= count; ++number) signs.sign(number);
                if (signs.unknown != 0) uncertain[supposition % 2].insert(signs.unknown);
                return sign_type::positive;
            });
            EXPECT_EQ(fault, expression_fault::none);
        }
        if (count <= 6 * 32) {
            EXPECT_EQ(uncertain[0].size(), count);
            EXPECT_EQ(uncertain[1].size(), count);
        }
        uncertain[0].merge(uncertain[1]);
        EXPECT_EQ(uncertain[0].size(), count);
    }
}

struct tracked_options : errbound::predicate_options {
    using tracked_rule = errbound::tight;
};
TEST(Options, SelectABoundRule) {
    const auto orient = errbound::predicate<errbound::points<2, 2, 2>, tracked_options>(
        [](const auto& a, const auto& b, const auto& c) { return errbound::forms::area(a, b, c); });
    const auto report = compare<double, 2, 3>(orient, over_rationals(orient), surface::flat);
    EXPECT_GT(report[predicate_stage::tracked], 0u);
}

}  // namespace
