// Decimals as tracked numbers, compared with rationals.
#include <gtest/gtest.h>

#include <algorithm>
#include <cfenv>
#include <cmath>
#include <errbound/binary128.hpp>
#include <errbound/decimal.hpp>
#include <errbound/small_floats.hpp>
#include <limits>
#include <random>
#include <string>
#include <type_traits>

#include "tests/support/long_double.hpp"
#include "tests/support/scaled.hpp"
#include "tests/support/special_values.hpp"

namespace {

using errbound::from_decimal;
using errbound::number_traits;
using errbound::sign_type;
using errbound::tracked;
using namespace errbound::literals;

/// x > 0 rounded to a multiple of the format's unit there: to nearest with ties to even, or up.
enum class direction { nearest, up };
template <class T>
rational rounded(const rational& x, direction to) {
    using traits = number_traits<T>;
    int end = static_cast<int>(msb(numerator(x))) - static_cast<int>(msb(denominator(x)));
    end += x >= power_of(2, end) ? 1 : 0;  // 2^(end - 1) <= x < 2^end
    const int unit = std::max(end, traits::min_exponent) - traits::digits;
    const rational units = x * power_of(2, -unit);
    whole_number n = numerator(units) / denominator(units);
    const rational rest = units - n, half(1, 2);
    if (to == direction::up ? rest != 0 : rest > half || (rest == half && n % 2 != 0)) ++n;
    return n * power_of(2, unit);
}

/// Reads the text of x and compares value and error with rationals. The error may exceed the
/// rounded distance by a thousandth.
template <class T, class Rule = errbound::tight>
void check_text(const std::string& text, const rational& x) {
    using traits = number_traits<T>;
    const auto read = from_decimal<tracked<T, Rule>>(text);
    const std::string shown = text.size() < 100 ? text : text.substr(0, 100) + "...";
    const rational size = abs(x);
    const rational nearest = size == 0 ? size : rounded<T>(size, direction::nearest);
    if (nearest > exactly(traits::largest())) {
        EXPECT_FALSE(traits::is_finite(read.error())) << shown;
        return;
    }
    ASSERT_TRUE(traits::is_finite(read.error())) << shown;
    const rational value = exactly(read.value()), off = abs(rational(value - x));
    ASSERT_EQ(value, x < 0 ? rational(-nearest) : nearest) << shown;
    const rational error = exactly(read.error());
    ASSERT_GE(error, off) << shown;
    if (std::is_same_v<Rule, errbound::safe>) return;  // its errors depend on the value's size
    const rational most = off + off / 1000;
    ASSERT_LE(error, off == 0 ? off : rounded<T>(most, direction::up)) << shown;
}

/// Random digits, with and without a point and an exponent, and their exact value.
struct random_decimal {
    std::string text;
    rational exact = 0;

    random_decimal(std::mt19937_64& random, int reach) {
        if (random() % 3 == 0) text += '-';
        const bool negative = !text.empty();
        const int digits = 1 + static_cast<int>(random() % (random() % 4 ? 25 : 100));
        const int point = static_cast<int>(random() % static_cast<unsigned>(digits + 1));
        int e = static_cast<int>(random() % static_cast<unsigned>(2 * reach + 1)) - reach;
        if (random() % 2) e = 0;
        whole_number all = 0;
        for (int i = 0; i < digits; ++i) {
            if (i == point) text += '.';
            const int digit = random() % 3 ? static_cast<int>(random() % 10) : 0;
            text += static_cast<char>('0' + digit);
            all = all * 10 + digit;
        }
        if (e != 0) text += "e" + std::to_string(e);
        exact = all * power_of(10, e - (digits - point));
        if (negative) exact = -exact;
    }
};

/// The digits of n·2^e, plus `units` of a place further right, and `more` digits.
std::string exact_text(const whole_number& n, int e, int units = 0, const std::string& more = "") {
    whole_number digits = e < 0 ? whole_number(n * numerator(power_of(5, -e)))
                                : whole_number(n << static_cast<unsigned>(e));
    if (units != 0) digits = 10 * digits + units;
    const int places = (units != 0) + static_cast<int>(more.size());
    return digits.str() + more + "e" + std::to_string(std::min(e, 0) - places);
}

/// Checks a number of the format, the midpoint above it and the neighbours of the midpoint, by all
/// their digits: up to 767 for double.
template <class T>
void check_midpoint(const whole_number& significand, int unit) {
    check_text<T>(exact_text(significand, unit), rational(significand) * power_of(2, unit));
    const whole_number n = 2 * significand + 1;
    const rational middle = rational(n) * power_of(2, unit - 1);
    const int places = std::max(1 - unit, 0);
    const rational step = power_of(10, -places - 1);
    check_text<T>(exact_text(n, unit - 1), middle);
    check_text<T>("-" + exact_text(n, unit - 1, 1), -(middle + step));
    check_text<T>(exact_text(n, unit - 1, -1), middle - step);
    check_text<T>(exact_text(n, unit - 1, 0, std::string(1000, '0') + "9"),
                  middle + 9 * power_of(10, -places - 1001));
}
template <class T>
void check_midpoints(int step) {
    using traits = number_traits<T>;
    std::mt19937_64 random(8);
    const whole_number first = whole_number(1) << static_cast<unsigned>(traits::digits - 1);
    const int least = traits::min_exponent - traits::digits;
    for (const int n : {0, 1, 2, 3}) check_midpoint<T>(n, least);
    for (int unit = least; unit <= traits::max_exponent - traits::digits; unit += step) {
        check_midpoint<T>(first, unit);
        check_midpoint<T>(2 * first - 1, unit);
        whole_number any = first;
        for (int bit = 0; bit < traits::digits - 1; ++bit)
            if (random() % 2 != 0) any |= whole_number(1) << static_cast<unsigned>(bit);
        check_midpoint<T>(any, unit);
    }
    check_midpoint<T>(first - 1, least);
    check_midpoint<T>(2 * first - 1, traits::max_exponent - traits::digits);
    check_midpoint<T>(2 * first - 2, traits::max_exponent - traits::digits);
}

template <class T, class Rule>
void check(int reach) {
    std::mt19937_64 random(6);
    for (int k = 0; k < support::scaled(1000); ++k) {
        const random_decimal d(random, reach);
        check_text<T, Rule>(d.text, d.exact);
    }
}

TEST(Decimals, AreTheNearestNumbers) {
    check<double, errbound::tight>(30);
    check<double, errbound::residual>(340);
    check<float, errbound::safe>(50);
    check<float, errbound::tight>(50);
    check<support::long_double, errbound::tight>(60);
    check<errbound::float16, errbound::sharp>(5);
    check<errbound::bfloat16, errbound::tight>(45);
    check<errbound::float8_e5m2, errbound::tight>(5);
    check<errbound::float8_e4m3, errbound::tight>(3);
#ifdef __SIZEOF_FLOAT128__
    check<errbound::float128, errbound::tight>(60);
#endif
}

// The decimals that are hardest to round: midpoints of two numbers, and their neighbours.
TEST(Decimals, NearMidpoints) {
    check_midpoints<double>(support::scaled(1) > 1 ? 1 : 37);
    check_midpoints<float>(1);
    check_midpoints<errbound::float16>(1);
    check_midpoints<errbound::bfloat16>(1);
    check_midpoints<errbound::float8_e5m2>(1);
    check_midpoints<errbound::float8_e4m3>(1);
    check_midpoints<support::long_double>(5000);
#ifdef __SIZEOF_FLOAT128__
    check_midpoints<errbound::float128>(9000);
#endif
}

TEST(Decimals, AtTheEndsOfTheRange) {
    using number = tracked<double>;
    constexpr double largest = std::numeric_limits<double>::max();
    constexpr double least = std::numeric_limits<double>::denorm_min();
    EXPECT_EQ(from_decimal<number>("1.7976931348623158e308").value(), largest);
    EXPECT_TRUE(std::isinf(from_decimal<number>("1.7976931348623159e308").error()));
    EXPECT_EQ(from_decimal<number>("4.9e-324").value(), least);
    const auto tiny = from_decimal<number>("-1e-99999999999");
    EXPECT_EQ(tiny.value(), 0);
    EXPECT_EQ(tiny.error(), least);
    EXPECT_TRUE(std::signbit(from_decimal<number>("-0").value()));
}

// Exponents with more than 6 digits were cut off: the values were 1, 1 and 0.1, exactly.
TEST(Decimals, WithManyZerosAndALargeExponent) {
    using number = tracked<double>;
    const auto zeros = [](std::size_t count) { return std::string(count, '0'); };
    EXPECT_TRUE(std::isinf(from_decimal<number>("0." + zeros(99999) + "1e1000000").error()));
    EXPECT_TRUE(std::isinf(from_decimal<number>("0." + zeros(999999) + "1e9999999").error()));
    const auto small = from_decimal<number>("1" + zeros(100000) + "e-1000000");
    EXPECT_EQ(small.value(), 0);
    EXPECT_GT(small.error(), 0);
    for (const std::string& one : {"0." + zeros(99999) + "1e100000", "1" + zeros(99999) + "e-99999",
                                   "1e" + zeros(100), "1." + zeros(100000)}) {
        const auto x = from_decimal<number>(one);
        EXPECT_EQ(x.value(), 1);
        EXPECT_EQ(x.error(), 0);
    }
    EXPECT_TRUE(std::isinf(from_decimal<number>("1e" + std::string(40, '9')).error()));
    EXPECT_EQ(from_decimal<number>("1e-" + std::string(40, '9')).value(), 0);
    const auto long_third = from_decimal<number>("0." + std::string(100000, '3'));
    EXPECT_EQ(long_third.value(), 1.0 / 3);
    EXPECT_LT(long_third.error(), 0x1p-55);
}

TEST(Decimals, AreConstantExpressions) {
    constexpr auto hard =
        from_decimal<tracked<double>>("2.47032822920623272088284396434110686182e-324");
    static_assert(hard.value() == 0);
    static_assert((1.7976931348623157e308_tracked).value() == std::numeric_limits<double>::max());
    static_assert((5.9604644775390625e-08_tracked).error() == 0);
    constexpr auto small = from_decimal<tracked<errbound::float16>>("0.1");
    static_assert(static_cast<float>(small.value()) == 0x1.998p-4F);
    constexpr auto wide = from_decimal<tracked<support::long_double>>("0.1");
    static_assert(wide.value() == 0.1L);
}

TEST(Decimals, OfNumbersOfTheTypeAreExact) {
    for (const char* text : {"0.5", "3", "100", "1e2", "-0.125e1", "0.000", "-0", "1e22",
                             "123456789012345", "1'000'000.25"})
        EXPECT_EQ(from_decimal<tracked<double>>(text).error(), 0) << text;
    EXPECT_GT(from_decimal<tracked<double>>("1.5e-1").error(), 0);
    EXPECT_EQ(from_decimal<tracked<double>>("-0.125e1").value(), -1.25);
}

TEST(Decimals, InexactLiteralsHaveErrors) {
    constexpr auto tenth = 0.1_tracked;
    static_assert(tenth.value() == 0.1);
    EXPECT_GT(tenth.error(), 0x1p-58);
    EXPECT_LT(tenth.error(), 0x1p-56);
    EXPECT_EQ(sign_of(tenth - tracked<double>(0.1)), sign_type::uncertain);
    EXPECT_EQ(sign_of(3_tracked - tracked<double>(3)), sign_type::zero);
    EXPECT_EQ((2.5e3_tracked).value(), 2500);
}

TEST(Decimals, OtherTextsHaveInfiniteErrors) {
    for (const char* text : {"", "-", ".", "e5", "1e", "1e+", "1.2.3", "1 ", " 1", "nan", "1e5x",
                             "0x", "1e99999999999", "'1", "1'", "1''0", "1'.5", "1.'5"}) {
        const auto x = from_decimal<tracked<double>>(text);
        EXPECT_EQ(sign_of(x), sign_type::uncertain) << text;
        EXPECT_FALSE(std::isfinite(x.error())) << text;
    }
}

/// Values are the same in every direction. Only rules that need rounding to nearest have infinite
/// errors. Literals are read by the compiler and are right in every direction.
TEST(Decimals, AreTheNearestInEveryRoundingDirection) {
    for (const int direction : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
        std::fesetround(direction);
        const auto read = from_decimal<tracked<double>>("353e-23");
        const auto sharp = from_decimal<tracked<double, errbound::sharp>>("353e-23");
        const auto half = from_decimal<tracked<errbound::float16, errbound::sharp>>("0.5");
        const auto wide = from_decimal<tracked<support::long_double>>("1e-4950");
        const auto beyond = from_decimal<tracked<support::long_double>>("1e5000");
        const auto tenth = 0.1_tracked;
        std::fesetround(FE_TONEAREST);
        EXPECT_EQ(read.value(), 353e-23);
        EXPECT_LE(read.error(), 0x1p-53 * 353e-23);
        EXPECT_EQ(sharp.value(), 353e-23);
        EXPECT_TRUE(std::isinf(sharp.error()));
        EXPECT_EQ(static_cast<double>(half.error()), 0);
        EXPECT_EQ(wide.value(), from_decimal<tracked<support::long_double>>("1e-4950").value());
        EXPECT_TRUE(std::isinf(beyond.error()));
        EXPECT_LT(tenth.error(), 0x1p-56);
    }
}

}  // namespace
