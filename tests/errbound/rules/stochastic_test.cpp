// The rule `stochastic` promises no bound. Its samples are neighbours of the result and right on
// average, and its estimates usually reach the error.
#include <gtest/gtest.h>

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <errbound/functions.hpp>
#include <errbound/rules/stochastic.hpp>
#include <errbound/small_floats.hpp>
#include <errbound/tracked.hpp>
#include <limits>
#include <random>

#include "tests/support/long_double.hpp"
#include "tests/support/scaled.hpp"

namespace {

using errbound::sign_type;
using errbound::stochastic;
using errbound::stochastic_of;
using errbound::tracked;
using number = tracked<double, stochastic>;
using oracle = boost::multiprecision::cpp_bin_float_quad;  // of 113 bits on every processor

static_assert(!errbound::promises_bound<stochastic>);
static_assert(errbound::meaning_of_error<stochastic> == errbound::error_meaning::estimate);
static_assert(!errbound::promises_bound<errbound::none>);
static_assert(errbound::promises_bound<errbound::tight>);

TEST(Stochastic, HasTheValuesOfPlainArithmetic) {
    const number a = 0.1, b = 0.3, c = 0.7;
    EXPECT_EQ((a * a - b * c / a + sqrt(b)).value(), 0.1 * 0.1 - 0.3 * 0.7 / 0.1 + std::sqrt(0.3));
}

TEST(Stochastic, ExactOperationsDoNotScatter) {
    const number x = number(3) * number(0.125) + number(5) / number(4) - scale(number(0.1), 2);
    const number exact = number(3) * number(0.125) + number(5) / number(4);
    EXPECT_EQ(exact.error(), 0);
    EXPECT_EQ(sign_of(exact), sign_type::positive);
    EXPECT_EQ(sign_of(exact - exact), sign_type::zero);
    EXPECT_GT(x.error(), 0);
}

TEST(Stochastic, EqualOperationsHaveEqualSamples) {
    const number a = 0.1, b = 0.3;
    for (const number& zero :
         {a * b - b * a, (a + b) - (b + a), (a - b) + (b - a), (-a) * b + a * b, a / b + a / -b}) {
        EXPECT_EQ(sign_of(zero), sign_type::zero);
        EXPECT_EQ(zero.error(), 0);
    }
    // So do repeated runs.
    const auto run = [&] { return (a * b + a / b).bound().samples; };
    EXPECT_EQ(run(), run());
}

/// The samples of one operation are the neighbours of the exact result, and their mean is that
/// result.
template <class Operation>
void expect_right_on_average(const Operation& operation) {
    using eight = tracked<double, stochastic_of<8>>;
    std::mt19937_64 random(1);
    const auto draw = [&] { return 1 + std::ldexp(static_cast<double>(random() >> 12), -52); };
    double sum = 0;
    const int count = support::scaled(4000);
    for (int i = 0; i < count; ++i) {
        const double x = draw(), y = draw();
        const double v = operation(x, y);
        const oracle exact = operation(oracle(x), oracle(y));
        const double ulp = std::nextafter(v, 1e300) - v;
        const eight result = operation(eight(x), eight(y));
        for (const double sample : result.bound().samples) {
            const auto off = static_cast<double>((oracle(sample) - exact) / ulp);
            ASSERT_LT(std::abs(off), 1);
            sum += off;
        }
    }
    // Deviations have the mean 0 and a variance of at most 1/4; the limit is six standard
    // deviations.
    EXPECT_LE(std::abs(sum) / (8 * count), 6 * 0.5 / std::sqrt(8.0 * count));
}

TEST(Stochastic, SamplesAreRightOnAverage) {
    expect_right_on_average([](auto x, auto y) { return x + y; });
    expect_right_on_average([](auto x, auto y) { return x - y * decltype(x)(0.5); });
    expect_right_on_average([](auto x, auto y) { return x / y; });
}

TEST(Stochastic, EstimatesAreOfTheErrorsSize) {
    std::mt19937_64 random(2);
    int enough = 0, far = 0;
    const int count = support::scaled(400);
    for (int i = 0; i < count; ++i) {
        number sum = 0;
        oracle exact = 0;
        for (int k = 0; k < 200; ++k) {
            const double x = std::ldexp(static_cast<double>(random() >> 11), -53) - 0.25;
            sum += number(x);
            exact += x;
        }
        const double off = std::abs(static_cast<double>(exact - sum.value()));
        enough += sum.error() >= off;
        far += sum.error() > 1000 * off;
    }
    // The share is 95 % by design for normal distributions; the limits only exclude nonsense.
    EXPECT_GE(enough, 0.8 * count);
    EXPECT_LE(far, 0.2 * count);
    // Cancellation is seen.
    const number x = number(0.1) * number(0.1), y = (number(1) + x) - number(1);
    EXPECT_GT((y - x).error(), 0);
    EXPECT_EQ(sign_of(y), sign_type::positive);
}

TEST(Stochastic, InputsAreSpread) {
    const number x = number::within(1, 0.1), y = number::within(1, 0.09);
    EXPECT_EQ(sign_of(x - x), sign_type::zero);
    EXPECT_NE((x - y).error(), 0);
    EXPECT_EQ((x - number::within(1, 0.1)).error(), 0);  // the same in each run, on each thread
    for (const double sample : x.bound().samples) EXPECT_LE(std::abs(sample - 1), 0.1000001);
    EXPECT_FALSE(std::isfinite(number::within(1, -1).error()));
}

TEST(Stochastic, ResultsThatAreNotFiniteAreUncertain) {
    const number huge(std::numeric_limits<double>::max());
    for (const number& x :
         {huge + huge, huge * huge, huge * huge - huge * huge,
          number(std::numeric_limits<double>::quiet_NaN()), number(1) / number(0)}) {
        EXPECT_FALSE(std::isfinite(x.error()));
        EXPECT_EQ(sign_of(x), sign_type::uncertain);
    }
}

TEST(Stochastic, DependsOnTheSeed) {
    using other = tracked<double, stochastic_of<3, 1>>;
    int differ = 0;
    for (int i = 1; i <= 20; ++i)
        differ +=
            (number(0.1) * number(i)).bound().samples != (other(0.1) * other(i)).bound().samples;
    EXPECT_GT(differ, 5);
}

TEST(Stochastic, OfOtherTypes) {
    const auto check = []<class T>(T) {
        using small = tracked<T, stochastic>;
        // These have all digits of T. Products of doubles would be exact in binary128.
        const small tenth(T(T(1) / T(10))), most(T(T(7) / T(10)));
        small sum(T(0));
        for (int i = 0; i < 30; ++i) sum += tenth * most;
        EXPECT_GT(static_cast<double>(sum.error()), 0);
        EXPECT_EQ(sign_of(sum - sum), sign_type::zero);
    };
    check(0.0F);
    check(support::long_double(0));
    check(errbound::float16(0.0F));
    check(errbound::float8_e4m3(0.0F));
}

}  // namespace
