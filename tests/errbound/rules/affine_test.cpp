// The rule `affine`: errors of one source cancel, whatever the limit on terms, and bounds hold.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <errbound/rules/affine.hpp>
#include <errbound/tracked.hpp>
#include <limits>
#include <random>
#include <thread>
#include <vector>

#include "tests/support/random_programs.hpp"
#include "tests/support/scaled.hpp"

namespace {

using errbound::affine;
using errbound::affine_of;
using errbound::sign_type;
using errbound::tracked;

template <class Rule>
class Affine : public testing::Test {};
using limits = testing::Types<affine_of<1>, affine_of<2>, affine_of<5>, affine>;
TYPED_TEST_SUITE(Affine, limits);

TYPED_TEST(Affine, ADifferenceOfANumberAndItselfIsZero) {
    using number = tracked<double, TypeParam>;
    number x = number::within(0.1, 1e-3), y = 0.7;
    for (int i = 0; i < 30; ++i) {
        EXPECT_EQ((x - x).value(), 0);
        EXPECT_EQ((x - x).error(), 0) << i;
        EXPECT_EQ(sign_of(x - x), sign_type::zero);
        const number copy = x;
        EXPECT_EQ(sign_of(-x + copy), sign_type::zero);
        EXPECT_LE((x / x).error(), 0x1p-50);
        x = x * y + number::within(1, 1e-5);
        EXPECT_GT(x.error(), 0);
        EXPECT_LE(x.bound().count, x.bound().terms.size());
    }
}

TYPED_TEST(Affine, InfiniteErrorsDoNotCancel) {
    using number = tracked<double, TypeParam>;
    const double infinity = std::numeric_limits<double>::infinity();
    const number unknown = number::within(1, infinity), huge(0x1p1023), x = number::within(2, 1);
    for (const number& y : {unknown - unknown, unknown - x, unknown * x, x / unknown, huge + huge,
                            huge * x, huge * x - huge * x, x / (x - number(2)),
                            number::within(1, -1), number::within(0x1p1023, 0x1.8p1023) * x})
        EXPECT_EQ(sign_of(y), sign_type::uncertain) << y.value() << " " << y.error();
    EXPECT_EQ(sign_of(unknown * number(0)), sign_type::zero);
}

// In each program of numbers near 1, later numbers share sources.
TYPED_TEST(Affine, BoundsHoldIfSourcesAreShared) {
    const auto draw = [](std::mt19937_64& random) {
        return std::ldexp(static_cast<double>(random() >> 11) - 0x1p52,
                          static_cast<int>(random() % 7) - 55);
    };
    support::random_programs<double, TypeParam, decltype(draw)>(1, draw).run(
        support::scaled(20000));
}

TEST(AffineTerms, OfAnInputCancel) {
    using number = tracked<double, affine>;
    const number x = number::within(3, 0.5), y = number::within(0.25, 0x1p-20);
    const number twice = (x + y) - (x - y);
    EXPECT_EQ(twice.value(), 0.5);
    EXPECT_GE(twice.error(), 0x1p-19);
    EXPECT_LE(twice.error(), 1.001 * 0x1p-19);
    // 1 − (1 − x)(1 + x) = x².
    const number square = number(1) - (number(1) - x) * (number(1) + x);
    EXPECT_GE(square.error(), 3 + 0.25);
    EXPECT_LE(square.error(), 1.001 * (3 + 0.25));
    // Rounding errors remain: x/3·3 − x has none of x's error.
    const number third = x / number(3) * number(3) - x;
    EXPECT_LE(third.error(), 0x1p-50);
    EXPECT_GT(third.error(), 0);
    EXPECT_EQ((number(1) / number(3) * number(0)).error(), 0);
}

TEST(AffineTerms, OfExactOperationsDoNotExist) {
    using number = tracked<double, affine>;
    const number x = number(3) * number(0.125) + number(1e15) - number(0.5) / number(4);
    EXPECT_EQ(x.error(), 0);
    EXPECT_EQ(x.bound().count, 0U);
    const number y = number(0.1) + number(0.2);
    EXPECT_EQ(y.bound().count, 1U);
    EXPECT_EQ((y + y).bound().count, 1U);
    EXPECT_EQ(scale(y, -3).bound().count, 1U);
    EXPECT_LE(y.error(), 0x1p-54);
}

TEST(AffineTerms, ThatExceedTheLimitAreMergedExceptTheLargest) {
    using number = tracked<double, affine_of<4>>;
    const number x = number::within(1, 1e-3);
    number sum = x;
    for (int i = 0; i < 100; ++i) sum += number::within(0.1, 1e-9);
    EXPECT_EQ(sum.bound().count, 4U);
    // x kept its source.
    EXPECT_LE((sum - x).error(), 1.01e-7);
    EXPECT_GE((sum - x).error(), 1e-7);
}

TEST(AffineTerms, OfThreadsDiffer) {
    using number = tracked<double, affine>;
    std::vector<number> made(8);
    std::vector<std::thread> threads;
    for (number& x : made)
        threads.emplace_back([&x] {
            for (int i = 0; i < 1000; ++i) x = number::within(1, 0.25);
        });
    for (std::thread& t : threads) t.join();
    for (const number& x : made)
        for (const number& y : made) EXPECT_EQ((x - y).error() == 0, &x == &y);
    // Terms of several threads, in any order.
    number sum = made[3];
    for (const std::size_t i : std::vector<std::size_t>{7, 0, 5, 1}) sum += made[i] * number(0.1);
    EXPECT_EQ(sign_of(sum - sum), sign_type::zero);
    for (std::size_t i = 1; i < sum.bound().count; ++i)
        EXPECT_LT(sum.bound().terms[i - 1].source, sum.bound().terms[i].source);
}

TEST(AffineTerms, HaveNoSourceInConstantExpressions) {
    using number = tracked<double, affine>;
    constexpr number x = number::within(1, 0.25);
    constexpr number none = x - x, positive = x * x + number(0.1);
    static_assert(sign_of(none) == sign_type::uncertain);
    static_assert(sign_of(positive) == sign_type::positive);
    EXPECT_GE(none.error(), 0.5);
    EXPECT_LE(none.error(), 0.51);
    // Their errors have a source in numbers that are computed at run time.
    const number y = positive + number(1);
    EXPECT_EQ(sign_of(y - y), sign_type::zero);
    EXPECT_GE((y - positive).error(), 0.5);
}

}  // namespace
