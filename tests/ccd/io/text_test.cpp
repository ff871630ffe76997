// Numbers from text, bit for bit, and excerpts for messages.
#include "ccd/io/text.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <random>
#include <string>

#include "tests/support/files.hpp"

namespace {

using namespace ccd;
using namespace ccd::io;
using test_files::repeated;

std::uint64_t bits(double value) {
    return std::bit_cast<std::uint64_t>(value);
}

TEST(Numbers, QuotientsAreExact) {
    const auto quotient = [](const std::string& n, const std::string& d) {
        return parse_quotient(n, d, false).value;
    };
    EXPECT_EQ(quotient("3", "-4"), -0.75);
    EXPECT_EQ(quotient("-3", "-4"), 0.75);
    EXPECT_EQ(quotient("0007", "02"), 3.5);
    EXPECT_EQ(bits(quotient("0", "-5")), bits(0.0));
    EXPECT_EQ(quotient("18446744073709551616", "36893488147419103232"), 0.5);
    EXPECT_EQ(quotient("-9223372036854775808", "1"), -0x1p63);
    EXPECT_EQ(quotient("1", "9223372036854775808"), 0x1p-63);
}

TEST(Numbers, QuotientsReachTheEndsOfTheFormat) {
    // 2^1074 in decimal.
    std::string power = "1";
    for (int i = 0; i < 1074; ++i) {
        int carry = 0;
        for (auto digit = power.rbegin(); digit != power.rend(); ++digit) {
            const int doubled = 2 * (*digit - '0') + carry;
            *digit = static_cast<char>('0' + doubled % 10);
            carry = doubled / 10;
        }
        if (carry != 0) power.insert(power.begin(), '1');
    }
    EXPECT_EQ(parse_quotient("1", power, false).value, 0x1p-1074);
    EXPECT_EQ(parse_quotient("-3", power, false).value, -0x3p-1074);
    EXPECT_EQ(parse_quotient(power, power, false).value, 1);
    EXPECT_EQ(parse_quotient(power, "1", false).status, number_status::overflow);
    EXPECT_EQ(parse_quotient("1", power + "0", false).status, number_status::inexact);
    EXPECT_EQ(parse_quotient("1", power + "0", true).value, 0);
    EXPECT_EQ(parse_quotient("9", power + "0", true).value, 0x1p-1074);
    // Ties to even.
    EXPECT_EQ(parse_quotient("5", power + "0", true).value, 0);
    EXPECT_EQ(parse_quotient("15", power + "0", true).value, 0x2p-1074);
    EXPECT_EQ(parse_quotient("9007199254740993", "1", true).value, 9007199254740992.0);
    EXPECT_EQ(parse_quotient("9007199254740995", "1", true).value, 9007199254740996.0);
}

TEST(Numbers, RoundedQuotientsAgreeWithDecimals) {
    std::mt19937_64 random(7);
    for (int i = 0; i < 20000; ++i) {
        const std::string digits = std::to_string(random()) + std::to_string(random() % 1000);
        const int shift = static_cast<int>(random() % 345);
        const number quotient =
            parse_quotient(digits, std::string("1").append(repeated("0", shift)), true);
        const number decimal = parse_double(digits + "e-" + std::to_string(shift), false);
        ASSERT_EQ(quotient.status, number_status::ok);
        ASSERT_EQ(bits(quotient.value), bits(decimal.value)) << digits << "e-" << shift;
    }
}

TEST(Numbers, DoublesSurviveHexadecimalAndQuotient) {
    std::mt19937_64 random(8);
    for (int i = 0; i < 20000; ++i) {
        const double value = std::bit_cast<double>(random());
        if (!std::isfinite(value)) continue;
        char text[512];
        std::snprintf(text, sizeof text, "%a", value);
        ASSERT_EQ(bits(parse_double(text, false).value), bits(value)) << text;
        std::snprintf(text, sizeof text, "%.17g", value);
        ASSERT_EQ(bits(parse_double(text, false).value), bits(value)) << text;
        if (std::fabs(value) >= 0x1p52) {
            std::snprintf(text, sizeof text, "%.0f", value);
            ASSERT_EQ(bits(parse_quotient(text, "1", false).value), bits(value)) << text;
        }
    }
}

TEST(Numbers, Floats) {
    EXPECT_EQ(parse_double("1e-999", false).value, 0);
    EXPECT_EQ(parse_double("+0.1", false).value, 0.1);
    EXPECT_TRUE(std::signbit(parse_double("-0", false).value));
    EXPECT_EQ(parse_double("0x1.8p3", false).value, 12);
    EXPECT_EQ(parse_double("-0X.8P+1", false).value, -1);
    const auto expect_status = [](number_status status, std::initializer_list<const char*> texts) {
        for (const char* text : texts) EXPECT_EQ(parse_double(text, false).status, status) << text;
    };
    expect_status(number_status::overflow, {"-1e999", "0x1p1024"});
    expect_status(number_status::not_finite,
                  {"inf", "Infinity", "NaN", "-nan", "nan(ind)", "-nan(snan)", "1.#INF", "-1.#IND",
                   "+1.#QNAN0", "1.#SNAN", "1.#J"});
    expect_status(number_status::malformed, {"", "-", "+-1", "--1", "1x", "0x", "0xp1", "0x1p",
                                             "0x1q", "0x1.2.3", "1 2", "e5", "1e", "1,5"});
    expect_status(number_status::inexact, {"0x1p-1075", "0x1.00000000000008p0"});
    EXPECT_EQ(parse_double("0x1p-1075", true).value, 0);
    EXPECT_EQ(parse_double("0x1p-99999999999999", true).value, 0);
    EXPECT_EQ(parse_double("0x1.00000000000008p0", true).value, 1);
    EXPECT_EQ(parse_float("0.1").value, static_cast<double>(0.1F));
    EXPECT_EQ(parse_float("1e39").status, number_status::overflow);
    EXPECT_EQ(parse_float("0x1p-149").value, 0x1p-149);
    EXPECT_EQ(parse_float("0x1p-150").status, number_status::inexact);
}

TEST(Numbers, ExcerptsAreShortAndPrintable) {
    EXPECT_EQ(excerpt("a b"), "'a b'");
    EXPECT_EQ(excerpt(std::string("\0\n\x80", 3)), "'\\x00\\x0a\\x80'");
    const std::string garbage = excerpt(std::string(1000, '\7'));
    EXPECT_LE(garbage.size(), 42U);
    EXPECT_TRUE(garbage.ends_with("...'"));
}

}  // namespace
