// Decimals as tracked numbers, against rationals.
#include <gtest/gtest.h>

#include <cfenv>
#include <cmath>
#include <errbound/decimal.hpp>
#include <random>
#include <string>

#include "tests/support/any_format.hpp"
#include "tests/support/long_double.hpp"
#include "tests/support/scaled.hpp"

namespace {

using errbound::from_decimal;
using errbound::number_traits;
using errbound::sign_type;
using errbound::tracked;
using namespace errbound::literals;

/// Random digits, with and without a point and an exponent, and what they stand for.
struct random_decimal {
    std::string text;
    rational exact = 0;

    random_decimal(std::mt19937_64& random, int reach) {
        if (random() % 3 == 0) text += '-';
        const bool negative = !text.empty();
        const int digits = 1 + static_cast<int>(random() % (random() % 4 ? 6 : 30));
        const int point = static_cast<int>(random() % static_cast<unsigned>(digits + 1));
        int e = static_cast<int>(random() % static_cast<unsigned>(2 * reach + 1)) - reach;
        if (random() % 2) e = 0;
        for (int i = 0; i < digits; ++i) {
            if (i == point) text += '.';
            const int digit = random() % 3 ? static_cast<int>(random() % 10) : 0;
            text += static_cast<char>('0' + digit);
            exact = exact * 10 + digit;
        }
        if (e != 0) text += "e" + std::to_string(e);
        for (int place = e - (digits - point); place != 0; place += place < 0 ? 1 : -1)
            exact = place < 0 ? rational(exact / 10) : rational(exact * 10);
        if (negative) exact = -exact;
    }
};

template <class T, class Rule>
void check(int reach) {
    using traits = number_traits<T>;
    std::mt19937_64 random(6);
    int known = 0;
    const int count = support::scaled(3000);
    for (int k = 0; k < count; ++k) {
        const random_decimal d(random, reach);
        const auto x = from_decimal<tracked<T, Rule>>(d.text);
        if (!traits::is_finite(x.error())) {
            ASSERT_EQ(sign_of(x), sign_type::uncertain) << d.text;
            continue;
        }
        ++known;
        const rational off = exactly_of(x.value()) - d.exact;
        ASSERT_LE(boost::multiprecision::abs(off), exactly_of(x.error())) << d.text;
    }
    EXPECT_GT(known, count / 4);
}

TEST(Decimals, AreWithinTheirBounds) {
    check<double, errbound::tight>(30);
    check<double, errbound::residual>(320);
    check<float, errbound::safe>(40);
    check<support::long_double, errbound::interval>(60);
    check<errbound::float16, errbound::sharp>(5);
    check<errbound::bfloat16, errbound::tight>(20);
    check<errbound::float8_e4m3, errbound::tight>(3);
}

TEST(Decimals, WhatTheTypeHoldsIsExact) {
    for (const char* text : {"0.5", "3", "100", "1e2", "-0.125e1", "1.5e-1", "0.000", "-0", "1e22",
                             "123456789012345", "0x", "1'000'000.25"}) {
        const auto x = from_decimal<tracked<double>>(text);
        if (std::string(text) == "1.5e-1") {
            EXPECT_GT(x.error(), 0);
        } else if (std::string(text) == "0x") {
            EXPECT_FALSE(std::isfinite(x.error()));
        } else {
            EXPECT_EQ(x.error(), 0) << text;
        }
    }
    EXPECT_EQ(from_decimal<tracked<double>>("-0.125e1").value(), -1.25);
}

TEST(Decimals, ATenthIsNotTheDoubleNearestToIt) {
    constexpr auto tenth = 0.1_tracked;
    static_assert(tenth.value() == 0.1);
    EXPECT_GT(tenth.error(), 0x1p-58);
    EXPECT_LT(tenth.error(), 0x1p-56);
    EXPECT_EQ(sign_of(tenth - tracked<double>(0.1)), sign_type::uncertain);
    EXPECT_EQ(sign_of(3_tracked - tracked<double>(3)), sign_type::zero);
    EXPECT_EQ((2.5e3_tracked).value(), 2500);
}

TEST(Decimals, WhatIsNoneIsUnknown) {
    for (const char* text :
         {"", "-", ".", "e5", "1e", "1e+", "1.2.3", "1 ", " 1", "nan", "1e5x", "1e99999999999",
          "1e-99999999999", "'1", "1'", "1''0", "1'.5", "1.'5"}) {
        const auto x = from_decimal<tracked<double>>(text);
        EXPECT_EQ(sign_of(x), sign_type::uncertain) << text;
        EXPECT_FALSE(std::isfinite(x.error())) << text;
    }
}

/// Reading is exact only to nearest. What the compiler has read is right in every direction.
TEST(Decimals, AreUnknownInAnotherRoundingDirection) {
    for (const int direction : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
        std::fesetround(direction);
        const auto read = from_decimal<tracked<double>>("353e-23");
        const auto half = from_decimal<tracked<errbound::float16>>("0.5");
        const auto tenth = 0.1_tracked;
        std::fesetround(FE_TONEAREST);
        EXPECT_FALSE(std::isfinite(read.error()));
        EXPECT_FALSE(std::isfinite(static_cast<double>(half.error())));
        EXPECT_LT(tenth.error(), 0x1p-56);
    }
}

}  // namespace
