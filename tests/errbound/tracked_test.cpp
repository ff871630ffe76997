// The tracked scalar against rationals, by every rule, number type and rounding direction: bounds
// that hold and are tight, exact zeros, underflow, overflow and NaN.
#include <gtest/gtest.h>

#include <cfenv>
#include <cmath>
#include <cstdint>
#include <errbound/errbound.hpp>
#include <errbound/explain/explain.hpp>
#include <errbound/multiprecision.hpp>
#include <errbound/validation/rule_list.hpp>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "tests/support/long_double.hpp"
#include "tests/support/random_programs.hpp"
#include "tests/support/scaled.hpp"

namespace {

using errbound::sign_type;
using errbound::tracked;
using support::check;
using support::sample;

template <class T, class Rule>
void run_programs(int programs, std::uint64_t seed) {
    const auto draw = [](std::mt19937_64& random) { return special_value<T>(random); };
    support::random_programs<T, Rule, decltype(draw)>(seed, draw).run(programs);
}
/// In directed rounding, overflow may end at the largest finite number (rules/tight.hpp). Numbers
/// stay smaller.
template <class Rule>
void run_directed_programs(int programs, std::uint64_t seed) {
    const double most = std::sqrt(std::numeric_limits<double>::max());
    const auto draw = [most](std::mt19937_64& random) {
        double x = special_value<double>(random);
        while (std::abs(x) > most) x = special_value<double>(random);
        return x;
    };
    support::random_programs<double, Rule, decltype(draw)> programs_below(seed, draw);
    programs_below.stay_below(most);
    programs_below.run(programs);
}

const int programs = support::scaled(20000);

template <class Rule>
class TrackedBy : public testing::Test {};
using rules = testing::Types<errbound::tight, errbound::safe, errbound::sharp, errbound::interval,
                             errbound::residual, errbound::affine, errbound::affine_of<2>,
                             errbound::relative, errbound::explained<errbound::tight>>;
TYPED_TEST_SUITE(TrackedBy, rules);

TYPED_TEST(TrackedBy, BoundsHoldInRandomPrograms) {
    run_programs<double, TypeParam>(programs, 1);
    run_programs<float, TypeParam>(programs, 3);
    run_programs<support::long_double, TypeParam>(programs / 10, 5);
}

TEST(Tracked, BoundsHoldInEveryRoundingDirection) {
    for (const int direction : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
        ASSERT_EQ(std::fesetround(direction), 0);
        run_directed_programs<errbound::tight>(programs / 4, 7);
        run_directed_programs<errbound::safe>(programs / 4, 8);
        std::fesetround(FE_TONEAREST);
    }
}

/// Checks ab + c at the ends of the ranges of a and b.
template <class Rule>
void check_fused(double a, double of_a, double b, double of_b, double c) {
    using number = tracked<double, Rule>;
    const number fused = fma(number::within(a, of_a), number::within(b, of_b), number(c));
    for (const int i : {-1, 1})
        for (const int j : {-1, 1}) {
            const rational exact =
                (exactly(a) + i * exactly(of_a)) * (exactly(b) + j * exactly(of_b)) + exactly(c);
            check(sample<number>{fused, exact}, std::string(Rule::name) + " fma");
            if (testing::Test::HasFatalFailure()) return;
        }
}

TEST(Tracked, FusedProductsThatUnderflowHoldInEveryRoundingDirection) {
    // In downward rounding the result lost an η, each product of the bound one, and σa(|b| + σb)
    // lost a part of an earlier one: more than the 3η that the bound had.
    const double a = 0x1.fffffe2956eccp-496, of_a = 0x1.fbf7f923257e1p-500;
    const double b = 0x1.000000f3acfffp-527, of_b = 0x1.fffffffffffffp-580;
    const double c = -0x1.0000000858757p-1022;
    for (const int direction : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO, FE_TONEAREST}) {
        std::mt19937_64 random(1);
        const auto between_1_and_2 = [&] {
            return 1 + std::ldexp(static_cast<double>(random() >> 12), -52);
        };
        ASSERT_EQ(std::fesetround(direction), 0);
        check_fused<errbound::tight>(a, of_a, b, of_b, c);
        for (int i = 0; i < programs / 4; ++i) {
            // a·σb is about η, σa·b is up to 2^50 η, and c nearly cancels ab.
            const double x = std::ldexp(between_1_and_2(), -496 - static_cast<int>(random() % 3));
            const double y = std::ldexp(between_1_and_2(), -527);
            const double of_x =
                std::ldexp(between_1_and_2(), -500 - static_cast<int>(random() % 50));
            const double of_y = std::ldexp(between_1_and_2(), -580);
            volatile double product = x * y;
            check_fused<errbound::tight>(x, of_x, y, of_y, -product);
            check_fused<errbound::safe>(x, of_x, y, of_y, -product);
        }
        std::fesetround(FE_TONEAREST);
    }
}

// Huge errors became small in some rounding directions.
TEST(Tracked, SafeWithinAHugeErrorIsUncertain) {
    for (const int direction : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO, FE_TONEAREST}) {
        ASSERT_EQ(std::fesetround(direction), 0);
        const auto huge = tracked<double, errbound::safe>::within(0x1p1000, 0x1p1019);
        const auto large = tracked<double, errbound::safe>::within(0x1p1000, 0x1p971);
        std::fesetround(FE_TONEAREST);
        EXPECT_GE(huge.error(), 0x1p1019) << direction;
        EXPECT_EQ(sign_of(huge), sign_type::uncertain) << direction;
        EXPECT_GE(large.error(), 0x1p971) << direction;
        EXPECT_EQ(sign_of(large), sign_type::positive) << direction;
    }
}

/// x·y − z and x·y·z + x in straight lines, which a compiler that contracts would fuse; z is the
/// rounded x·y or near it.
template <class T, class Rule>
void check_straight_lines(std::uint64_t seed) {
    using number = tracked<T, Rule>;
    constexpr std::size_t count = 2000;
    std::mt19937_64 random(seed);
    std::vector<T> x(count), y(count), z(count);
    for (std::size_t i = 0; i < count; ++i) {
        const auto draw = [&] { return std::ldexp(T(random() >> 11), -50) - T(4); };
        x[i] = draw();
        y[i] = draw();
        volatile T product = x[i] * y[i];
        z[i] = product;
        if (random() % 2) z[i] = std::nextafter(z[i], T(random() % 9) - 4);
    }
    std::vector<number> difference(count), from_product(count), sum(count);
    for (std::size_t i = 0; i < count; ++i) {
        difference[i] = number(x[i]) * number(y[i]) - number(z[i]);
        from_product[i] = number(x[i] * y[i]) - number(z[i]);
        sum[i] = number(x[i]) * number(y[i]) * number(z[i]) + number(x[i]);
    }
    // Only values: if no bound uses the product too, the compiler has the most freedom.
    std::vector<T> value(count), value_from_product(count);
    for (std::size_t i = 0; i < count; ++i)
        value[i] = (number(x[i]) * number(y[i]) - number(z[i])).value();
    for (std::size_t i = 0; i < count; ++i)
        value_from_product[i] = (number(x[i] * y[i]) - number(z[i])).value();
    for (std::size_t i = 0; i < count; ++i) {
        const rational a = exactly(x[i]), b = exactly(y[i]), c = exactly(z[i]);
        volatile T product = x[i] * y[i];
        const std::string what = std::string(Rule::name) + " line " + std::to_string(i);
        check<number>({difference[i], a * b - c}, what);
        check<number>({from_product[i], exactly(T(product)) - c}, what);
        check<number>({sum[i], a * b * c + a}, what);
        for (const T v :
             {difference[i].value(), from_product[i].value(), value[i], value_from_product[i]})
            ASSERT_EQ(v, product - z[i]) << what;
        if (testing::Test::HasFatalFailure()) return;
    }
}

TYPED_TEST(TrackedBy, ProductsAreRoundedSeparately) {
    check_straight_lines<double, TypeParam>(11);
    check_straight_lines<float, TypeParam>(12);
}

// A bound of one operation on exact, normal numbers is at most 1.01·ε|v|.
TEST(Tracked, BoundsOfOneOperationAreTight) {
    std::mt19937_64 random(9);
    for (int k = 0; k < 10000; ++k) {
        const double x = std::ldexp(static_cast<double>(random() >> 11), -53) + 1;
        const double y = std::ldexp(static_cast<double>(random() >> 11), -50) + 1;
        const tracked<double> a = x, b = y;
        for (const auto& c : {a + b, a - b, a * b, a / b})
            ASSERT_LE(c.error(), 1.01 * 0x1p-52 * std::abs(c.value()));
    }
}

TEST(Tracked, ExactZeroHasTheSignZero) {
    const tracked<double> x = 0.1, zero = x * tracked<double>(0);
    EXPECT_EQ(sign_of(tracked<double>()), sign_type::zero);
    EXPECT_EQ(sign_of(zero), sign_type::zero);
    EXPECT_EQ(sign_of(tracked<double>(3) - tracked<double>(3)), sign_type::zero);
    EXPECT_EQ(sign_of(tracked<double, errbound::safe>(0) * tracked<double, errbound::safe>(0.1)),
              sign_type::zero);
    // Only the value is zero.
    EXPECT_EQ(sign_of((x + x) + x - tracked<double>(0.1 + 0.1 + 0.1)), sign_type::uncertain);
    // A value that equals its bound may belong to zero.
    EXPECT_EQ(sign_of(tracked<double>::within(1.0, 1.0)), sign_type::uncertain);
}

/// Scales numbers of every size, from subnormal to nearly infinite, by powers of two.
template <class T>
void check_steps() {
    constexpr int most = std::numeric_limits<T>::max_exponent;
    std::mt19937_64 random(7);
    for (int i = 0; i < support::scaled(100000); ++i) {
        const T m = static_cast<T>(random()) * (random() % 2 == 0 ? T(1) : T(-1));
        const int at = static_cast<int>(random() % (2 * most)) - most - 64;
        const T x = std::ldexp(i % 3 == 0 ? T(3) : m, at);
        const int e = static_cast<int>(random() % (5 * most)) - (5 * most) / 2;
        ASSERT_EQ(errbound::detail::scaled_by_steps(x, e), std::ldexp(x, e)) << x << " " << e;
        if (x == 0 || !std::isfinite(x)) continue;
        ASSERT_EQ(errbound::detail::exponent_by_steps(x), errbound::number_traits<T>::exponent(x));
    }
    for (const int e : {std::numeric_limits<int>::min(), std::numeric_limits<int>::max()})
        ASSERT_EQ(errbound::detail::scaled_by_steps(T(1.5), e), std::ldexp(T(1.5), e));
}

TEST(Tracked, ScalingInConstantExpressionsRoundsOnce) {
    check_steps<float>();
    check_steps<double>();
    static_assert(errbound::number_traits<double>::scale(1.5, -1075) == 0x1p-1074);
    static_assert(errbound::number_traits<double>::scale(1.25, -1074) == 0x1p-1074);
}

template <class Rule>
void check_range() {
    using number = tracked<double, Rule>;
    const double huge = std::numeric_limits<double>::max();
    const double infinity = std::numeric_limits<double>::infinity();
    const number nan(std::numeric_limits<double>::quiet_NaN());
    for (const number& x : {number(huge) * number(huge), number(huge) + number(huge),
                            number(-huge) - number(huge), number(infinity), number(-infinity), nan,
                            number(0) * number(infinity), scale(number(huge), 1)})
        EXPECT_EQ(sign_of(x), sign_type::uncertain) << Rule::name << " " << x.value();
    // If a bound is promised, underflow to zero or to the smallest number has no sign.
    if constexpr (!std::same_as<Rule, errbound::none>) {
        EXPECT_EQ(sign_of(number(1e-200) * number(1e-200)), sign_type::uncertain);
        EXPECT_EQ(sign_of(number(1e-162) * number(3e-162)), sign_type::uncertain);
        EXPECT_EQ(sign_of(scale(number(1.5), -1075)), sign_type::uncertain);
    }
}

TEST(Tracked, OverflowAndUnderflowAreUncertain) {
    using namespace errbound;
    for_each_rule(rule_types<tight, safe, sharp, interval, residual, affine, relative, none>(),
                  []<class Rule>() { check_range<Rule>(); });
}

TEST(Tracked, SafeHasInfiniteErrorsAfterTooManyOperations) {
    tracked<double, errbound::safe> x = 1.0;
    for (int i = 0; i < 29; ++i) x *= x;
    EXPECT_TRUE(std::isfinite(x.error()));
    for (int i = 0; i < 40; ++i) x *= x;  // 2^69 operations
    EXPECT_TRUE(std::isinf(x.error()));
    const tracked<double, errbound::safe> c = 0.1;
    EXPECT_EQ(sign_of(x * (c - c)), sign_type::uncertain);
    EXPECT_EQ(sign_of(x), sign_type::uncertain);
    // The limit of operations is 1/ε.
    using single = tracked<float, errbound::safe>;
    EXPECT_TRUE(std::isfinite(single::from_bound(1, {1, 1 << 23}).error()));
    EXPECT_TRUE(std::isinf(single::from_bound(1, {1, (1 << 23) + 1}).error()));
}

TEST(Tracked, SomeRulesDetermineMoreSignsThanTheirErrorsDo) {
    using errbound::interval;
    using errbound::residual;
    // The value is less than the error, but the correction is known to second order.
    const tracked<double, residual> a = 0.1, b = 0.3;
    const auto x = (a + a) + a - b;
    EXPECT_LE(std::abs(x.value()), 2 * x.error());
    EXPECT_EQ(sign_of(x), sign_type::positive);
    EXPECT_EQ(sign_of((a + b) - a - b), sign_type::zero);
    EXPECT_EQ(sign_of(-x), sign_type::negative);
    // A certain sign of an interval that reaches far beyond twice its value.
    const auto wide =
        tracked<double, interval>::within(1, 0.9) * tracked<double, interval>::within(1, 0.9);
    EXPECT_GT(wide.error(), wide.value());
    EXPECT_EQ(sign_of(wide), sign_type::positive);
    EXPECT_EQ(sign_of(-wide), sign_type::negative);
    const tracked<double, interval> three = 3, eighth = 0.125;
    EXPECT_EQ((three * eighth - three / tracked<double, interval>(4)).error(), 0);
    EXPECT_EQ(sign_of(three * eighth * tracked<double, interval>(8) - three), sign_type::zero);
}

// Near underflow the remainder of a division is unknown. The quotient's rounding error then counts
// with the divisor's error, which matters if that is as large as the divisor.
TEST(Tracked, ResidualCountsAnUnknownRemainderWithTheDivisorsError) {
    using number = tracked<double, errbound::residual>;
    // The value of large + y − large is y rounded to 2^-1000; the correction may be half of it.
    const auto sum = [](double y, double z) {
        const double large = 0x1p-948;
        return sample<number>{(number(large) + number(y)) - number(large) + number(z),
                              exactly(y) + exactly(z)};
    };
    const auto a = sum(0x1.8p-1001, -0x1.71a1f58d0fac6p-1001);
    const auto b = sum(0x1.051eb851eb852p-1001, -0x1.d1eb851eb851fp-1002);
    const sample<number> quotient{a.number / b.number, a.exact / b.exact};
    check(quotient, "quotient");
    for (int i = -40; i <= 40; ++i) {
        const double near = quotient.number.value() + i * 0x1p-54;
        check<number>({quotient.number - number(near), quotient.exact - exactly(near)},
                      std::to_string(i));
    }
}

TEST(Tracked, QuotientsAreUncertainIfTheDivisorMayBeZero) {
    const auto b = tracked<double>::within(1e-3, 1e-3);
    EXPECT_EQ(sign_of(tracked<double>(1) / b), sign_type::uncertain);
    EXPECT_EQ(sign_of(tracked<double>(1) / tracked<double>(0)), sign_type::uncertain);
    EXPECT_EQ(sign_of(tracked<double>(0) / tracked<double>(3)), sign_type::zero);
}

TEST(Tracked, WorksInConstantExpressions) {
    constexpr tracked<double> a = 3, b = 0.25;
    static_assert(sign_of(a * b - a) == sign_type::negative);
    static_assert(compare(a, b) == sign_type::positive);
    constexpr tracked<float, errbound::safe> c = 2.0F;
    static_assert(sign_of(c * c) == sign_type::positive);
    static_assert(sizeof(tracked<double, errbound::none>) == sizeof(double));
}

TEST(Tracked, InexactConversionsAreNotExact) {
    // 2^24 + 1 is no float: the difference is not certainly zero.
    EXPECT_EQ(sign_of(tracked<float>(16777217) - tracked<float>(16777216)), sign_type::uncertain);
    EXPECT_EQ(sign_of(tracked<double>(16777217) - tracked<double>(16777216)), sign_type::positive);
    EXPECT_EQ(sign_of(tracked<double>::within(1.0, -1.0)), sign_type::uncertain);
    EXPECT_EQ(sign_of(tracked<double, errbound::safe>::within(1.0, -1.0)), sign_type::uncertain);
    static_assert(errbound::is_exact_number<rational>);
    static_assert(!errbound::is_exact_number<boost::multiprecision::int128_t>);
}

}  // namespace
