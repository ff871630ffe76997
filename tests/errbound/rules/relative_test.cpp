// The rule `relative`: counts of factors, also in sums of unlike signs.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <errbound/multiprecision.hpp>
#include <errbound/rules/relative.hpp>
#include <errbound/small_floats.hpp>
#include <errbound/tracked.hpp>
#include <random>

#include "tests/support/scaled.hpp"
#include "tests/support/special_values.hpp"

namespace {

using errbound::relative;
using errbound::sign_type;
using errbound::tracked;
using number = tracked<double, relative>;

double between_half_and_2(std::mt19937_64& random) {
    return 0.5 + 1.5 * std::ldexp(static_cast<double>(random() >> 11), -53);
}

/// |value − exact| <= error <= (1 + slack)·count·u·|value|.
void expect_count(const number& x, const rational& exact, double count) {
    EXPECT_LE(boost::multiprecision::abs(exactly(x.value()) - exact), exactly(x.error()));
    EXPECT_LE(x.error(), 1.00001 * count * 0x1p-53 * std::abs(x.value()));
    EXPECT_EQ(sign_of(x), errbound::sign_of(exact));
}

TEST(Relative, ProductsHaveACountForEachRounding) {
    std::mt19937_64 random(1);
    const int count = std::min(support::scaled(10000), 10000);
    number product = between_half_and_2(random);
    rational exact = exactly(product.value());
    for (int i = 1; i < count; ++i) {
        // The product does not overflow or underflow.
        double x = between_half_and_2(random);
        if ((product.value() > 1) == (x > 1)) x = 1 / x;
        product *= number(x);
        exact *= exactly(x);
    }
    EXPECT_LE(product.bound().factors, count - 1);
    EXPECT_GE(product.bound().factors, 0.9 * (count - 1));
    expect_count(product, exact, count - 1);
}

TEST(Relative, SumsOfOneSignCountTheirDepth) {
    std::mt19937_64 random(2);
    const int count = support::scaled(10000);
    number sum = -between_half_and_2(random);
    rational exact = exactly(sum.value());
    for (int i = 1; i < count; ++i) {
        const double x = between_half_and_2(random);
        sum -= number(x) * number(0.1);
        exact -= exactly(x) * exactly(0.1);
    }
    expect_count(sum, exact, count);
    EXPECT_EQ(sign_of(sum), sign_type::negative);
}

TEST(Relative, ExactOperationsHaveTheCountZero) {
    EXPECT_EQ((number(3) * number(0.125) + number(5) / number(4)).bound().factors, 0);
    EXPECT_EQ(scale(number(0.1), -4).bound().factors, 0);
    EXPECT_EQ((number(0.1) + number(0.2)).bound().factors, 1);
    EXPECT_EQ((number(0.1) * number(0.2) / number(0.3)).bound().factors, 2);
    EXPECT_EQ((number(1e300) - number(1e300)).error(), 0);
    EXPECT_EQ(sign_of(number(0.1) - number(0.1)), sign_type::zero);
    // Sterbenz's lemma: this difference of exact numbers is exact.
    EXPECT_EQ((number(0.3) - number(0.2)).bound().factors, 0);
}

TEST(Relative, CancellationMakesCountsLarger) {
    const number x = number(1) + number(0.1) * number(0.1);  // 2 factors
    const number left = x - number(1);
    EXPECT_EQ(sign_of(left), sign_type::positive);
    EXPECT_GE(left.error(), 2 * 0x1p-53);
    EXPECT_LE(left.error(), 1.02 * (2 * 0x1p-53 * 1.01));
    EXPECT_NEAR(left.bound().factors, 202, 3);
    // If all digits cancel, the error is infinite, also for x − x.
    EXPECT_EQ(sign_of(x - x), sign_type::uncertain);
    EXPECT_EQ(sign_of(x - number(1.01)), sign_type::uncertain);
    EXPECT_FALSE(std::isfinite((x - x).error()));
    EXPECT_EQ(sign_of((x - x) + number(1)), sign_type::uncertain);
    EXPECT_EQ(sign_of(number(1) / (x - x)), sign_type::uncertain);
}

TEST(Relative, UnderflowIsUncertain) {
    EXPECT_EQ(sign_of(number(1e-160) * number(1e-160)), sign_type::uncertain);
    EXPECT_EQ(sign_of(number(1e-300) / number(1e10)), sign_type::uncertain);
    EXPECT_EQ(sign_of(scale(number(1.5), -1075)), sign_type::uncertain);
    EXPECT_EQ(sign_of(number(0x1p-1074) + number(0x1p-1074)), sign_type::positive);
    EXPECT_EQ(scale(number(1.5), -1073).error(), 0);
    EXPECT_EQ(sign_of(number(1e200) * number(1e200)), sign_type::uncertain);
}

TEST(Relative, InputsMayBeRelativelyUncertain) {
    const number x = number::within(3, 0.03);
    EXPECT_GE(x.error(), 0.03);
    EXPECT_LE(x.error(), 0.0304);
    EXPECT_EQ(sign_of(x), sign_type::positive);
    // Relative errors add in products.
    EXPECT_NEAR((x * x * x / x).error() / 9, 0.04, 0.002);
    EXPECT_EQ(sign_of(number::within(1, 1)), sign_type::uncertain);
    EXPECT_EQ(sign_of(number::within(1, -1)), sign_type::uncertain);
    EXPECT_EQ(sign_of(number::within(0, 1e-9)), sign_type::uncertain);
}

/// Counts exceed the integers of a small type.
TEST(Relative, CountsOfSmallTypesAreDoubles) {
    using half = tracked<errbound::float16, relative>;
    half x = errbound::float16(1.0009765625), product = errbound::float16(1);
    for (int i = 0; i < 5000; ++i) {
        product *= x;
        if (product.value() > 2) product = scale(product, -1);
    }
    EXPECT_GE(product.bound().factors, 4000);
    EXPECT_EQ(sign_of(product), sign_type::uncertain);  // beyond e^(7/4)
}

// k·w was rounded to a subnormal number, which loses up to half of the smallest one: a sixth here.
TEST(Relative, SubnormalCounts) {
    const double value = std::ldexp(1.0, 1000), count = std::ldexp(1.2, -1020);
    EXPECT_GE(relative::error<double>(value, {count}), std::ldexp(1.2, -1020 - 53 + 1000));
}

TEST(Relative, WorksInConstantExpressions) {
    constexpr number x = 0.1, y = x * x / number(3) - number(7);
    static_assert(sign_of(y) == sign_type::negative);
    static_assert(sizeof(number) == 2 * sizeof(double));
    // The sign bit of a size was not cleared: −0 made a negative count.
    constexpr number near_zero = number::within(-0.0, 1);
    static_assert(sign_of(near_zero) == sign_type::uncertain);
    static_assert(sign_of(near_zero + number(0)) == sign_type::uncertain);
}

}  // namespace
