// The rule `affine`: errors of one source cancel, whatever the limit on terms. Programs that share
// inputs stay within their bounds at every corner of the ranges of the inputs.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <errbound/multiprecision.hpp>
#include <errbound/rules/affine.hpp>
#include <errbound/tracked.hpp>
#include <limits>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/scaled.hpp"
#include "tests/support/special_values.hpp"

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

/// Programs whose numbers share sources, on tracked numbers and on the rationals at the corners of
/// their ranges.
template <class Rule>
class shared_programs {
    using number = tracked<double, Rule>;
    static constexpr std::size_t inputs = 4;

  public:
    explicit shared_programs(std::uint64_t seed) : random_(seed) {}

    void run(int programs) {
        for (int k = 0; k < programs && !testing::Test::HasFatalFailure(); ++k) {
            start();
            for (int step = 0; step < 12; ++step) {
                grow();
                if (numbers_.size() == inputs) continue;
                check("program " + std::to_string(k) + " step " + std::to_string(step));
                if (testing::Test::HasFatalFailure()) return;
            }
        }
    }

  private:
    void start() {
        numbers_.clear();
        exact_.assign(std::size_t{1} << inputs, {});
        const int spread = random_() % 3 == 0 ? 300 : 3;
        for (std::size_t i = 0; i < inputs; ++i) {
            const auto below = [&](int n) { return static_cast<int>(random_() % unsigned(n)); };
            const double value = std::ldexp(static_cast<double>(random_() >> 11) - 0x1p52,
                                            below(2 * spread) - spread - 52);
            const double error = below(4) == 0 ? 0 : std::ldexp(std::abs(value), -5 * below(10));
            numbers_.push_back(number::within(value, error));
            for (std::size_t corner = 0; corner < exact_.size(); ++corner)
                exact_[corner].push_back(exactly(value) +
                                         ((corner >> i & 1) != 0 ? 1 : -1) * exactly(error));
        }
    }
    /// Combines two of the latest values, except for divisions by zero.
    void grow() {
        const std::size_t n = numbers_.size();
        const std::size_t i = random_() % n, j = random_() % 2 ? n - 1 : random_() % n;
        const auto operation = random_() % 7;
        const int e = static_cast<int>(random_() % 9) - 4;
        if (operation == 4)
            for (const auto& x : exact_)
                if (x[j] == 0) return;
        const auto apply = [&](const auto& x, const auto& y, const auto& scaled) {
            if (operation == 4) return x / y;
            return operation < 2 ? x + y : operation < 4 ? x - y : operation == 5 ? scaled : x * y;
        };
        numbers_.push_back(apply(numbers_[i], numbers_[j], scale(numbers_[i], e)));
        for (auto& x : exact_)
            x.push_back(apply(x[i], x[j], rational(x[i] * exactly(std::ldexp(1.0, e)))));
    }
    void check(const std::string& what) const {
        const number& x = numbers_.back();
        const sign_type sign = sign_of(x);
        if (!std::isfinite(x.value()) || !std::isfinite(x.error())) {
            ASSERT_EQ(sign, sign_type::uncertain) << what;
            return;
        }
        for (const auto& corner : exact_) {
            const rational& exact = corner.back();
            ASSERT_LE(boost::multiprecision::abs(exactly(x.value()) - exact), exactly(x.error()))
                << what << " value " << x.value() << " error " << x.error();
            ASSERT_TRUE(sign == sign_type::uncertain || sign == errbound::sign_of(exact)) << what;
        }
    }

    std::mt19937_64 random_;
    std::vector<number> numbers_;
    std::vector<std::vector<rational>> exact_;  // by corner
};

TYPED_TEST(Affine, BoundsHoldIfSourcesAreShared) {
    shared_programs<TypeParam>(1).run(support::scaled(1500));
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
