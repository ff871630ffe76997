// Tracked numbers as decimals, read back as rationals: every printed digit is certain, and value
// and radius hold the number.
#include <gtest/gtest.h>

#include <cfenv>
#include <charconv>
#include <cmath>
#include <errbound/detail/printf_decimal.hpp>
#include <errbound/printing.hpp>
#include <errbound/small_floats.hpp>
#include <iomanip>
#include <limits>
#include <random>
#include <sstream>
#include <string>

#include "tests/support/long_double.hpp"
#include "tests/support/scaled.hpp"
#include "tests/support/special_values.hpp"

namespace {

using errbound::tracked;

/// The value of a decimal, and the place of its last digit.
struct read_decimal {
    rational value;
    int last_place = 0;

    explicit read_decimal(const std::string& text) {
        const std::size_t e = text.find('e'), point = text.find('.');
        std::string digits = text.substr(0, e);
        if (e != std::string::npos) last_place = std::stoi(text.substr(e + 1));
        if (point != std::string::npos) {
            last_place -= static_cast<int>(digits.size() - point) - 1;
            digits.erase(point, 1);
        }
        const bool negative = digits[0] == '-';
        if (negative) digits.erase(0, 1);
        EXPECT_EQ(digits.find_first_not_of("0123456789"), std::string::npos) << text;
        digits.erase(0, std::min(digits.find_first_not_of('0'), digits.size() - 1));
        value = rational(whole_number(digits)) * power_of(10, last_place);
        if (negative) value = -value;
    }
};

template <class T>
T read_back(const std::string& text) {
    if constexpr (std::same_as<T, float>)
        return std::strtof(text.c_str(), nullptr);
    else if constexpr (std::same_as<T, double>)
        return std::strtod(text.c_str(), nullptr);
    else
        return std::strtold(text.c_str(), nullptr);
}

template <class T>
void check(T value, T error) {
    const auto x = tracked<T>::within(value, error);
    const std::string text = certain_digits(x);
    if (!std::isfinite(static_cast<long double>(x.error()))) {
        ASSERT_EQ(text, "unknown");
        return;
    }
    const read_decimal read(text);
    const rational off = boost::multiprecision::abs(rational(read.value - exactly(value)));
    const auto what = [&] { return text + " for " + with_radius(x); };
    if (error == T(0)) {
        ASSERT_LE(off, power_of(10, read.last_place)) << what();
        using printed = errbound::detail::printed_type<T>;
        ASSERT_EQ(read_back<printed>(text), static_cast<printed>(value)) << what();
    } else {
        ASSERT_LE(off + exactly(error), power_of(10, read.last_place)) << what();
        // Two more digits would not be certain.
        ASSERT_GT(exactly(error) * 220, power_of(10, read.last_place)) << what();
    }
}

template <class T>
class Printing : public testing::Test {};
using numbers = testing::Types<float, double, support::long_double, errbound::float16,
                               errbound::bfloat16, errbound::float8_e5m2, errbound::float8_e4m3>;
TYPED_TEST_SUITE(Printing, numbers);

TYPED_TEST(Printing, EveryDigitIsCertain) {
    using T = TypeParam;
    using traits = errbound::number_traits<T>;
    std::mt19937_64 random(1);
    const int count = support::scaled(std::numeric_limits<T>::max_exponent > 2000 ? 300 : 20000);
    for (int k = 0; k < count && !testing::Test::HasFatalFailure(); ++k) {
        const T value = special_value<T>(random);
        T error = traits::abs(special_value<T>(random));
        if (random() % 4 != 0)
            error = traits::scale(traits::abs(value), -static_cast<int>(random() % 70)) *
                    T(1 + static_cast<int>(random() % 5));
        check(value, error);
    }
}

TYPED_TEST(Printing, EveryDigitIsCertainNextToPowersOfTen) {
    using T = TypeParam;
    using traits = errbound::number_traits<T>;
    std::mt19937_64 random(3);
    // Only every seventh power for long doubles: some C libraries take milliseconds to print one.
    const T step(traits::max_exponent > 2000 ? 1e7 : 10);
    for (T power(1); power < traits::largest() / T(16); power = power * step) {
        for (int k = 0; k < 8 && !testing::Test::HasFatalFailure(); ++k) {
            const T below = power * (T(1) - T(k % 4) * traits::unit_roundoff());
            const int halvings = static_cast<int>(random() % 90);
            check(below, traits::scale(below, -halvings));
            check(T(-1) / below, traits::scale(T(1) / below, -halvings));
        }
    }
}

TYPED_TEST(Printing, ValueAndRadiusHoldTheNumber) {
    using T = TypeParam;
    using printed = errbound::detail::printed_type<T>;
    using traits = errbound::number_traits<T>;
    std::mt19937_64 random(2);
    for (int k = 0; k < support::scaled(3000); ++k) {
        const T value = special_value<T>(random), error = traits::abs(special_value<T>(random));
        const auto x = tracked<T>::within(value, error);
        const std::string text = with_radius(x);
        const std::size_t between = text.find(" ± ");
        ASSERT_NE(between, std::string::npos);
        const std::string radius = text.substr(between + std::string(" ± ").size());
        if (!traits::is_finite(x.error())) {
            ASSERT_EQ(radius, "unknown");
            continue;
        }
        ASSERT_EQ(read_back<printed>(text.substr(0, between)), static_cast<printed>(value)) << text;
        const printed off = read_back<printed>(radius), exact = static_cast<printed>(error);
        ASSERT_GE(off, exact) << text;
        ASSERT_LE(off, exact * printed(1.11) + std::numeric_limits<printed>::denorm_min() * 4)
            << text;
    }
}

std::string text_of(const tracked<double>& x) {
    std::ostringstream to;
    to << x;
    return to.str();
}
tracked<double> within(double value, double error) {
    return tracked<double>::within(value, error);
}

TEST(PrintingText, OfSomeNumbers) {
    EXPECT_EQ(text_of(tracked<double>(0.1) + tracked<double>(0.2)), "0.300000000000000");
    EXPECT_EQ(with_radius(within(0.3, 0.25)), "0.3 ± 2.5e-01");
    EXPECT_EQ(text_of(0.1), "0.1");
    EXPECT_EQ(text_of(-3.0), "-3");
    EXPECT_EQ(text_of(-0.0), "0");
    // The double is less than 1e153, and 2^434 is less than one unit of the last digit.
    EXPECT_EQ(text_of(within(1e153, 0x1p434)), "9.999999999999999997334e+152");
    EXPECT_EQ(text_of(within(123456, 1000)), "1.2e+05");
    EXPECT_EQ(text_of(within(-123456, 0.01)), "-123456.0");
    EXPECT_EQ(text_of(within(9.96, 0.04)), "10.0");
    EXPECT_EQ(text_of(within(1e-30, 1e-34)), "1.000e-30");
    // If no digit is certain, the text shows the magnitude.
    EXPECT_EQ(text_of(within(7, 3)), "1e+01");
    EXPECT_EQ(text_of(within(-7, 3)), "-1e+01");
    EXPECT_EQ(text_of(within(1, 4)), "0e+01");
    EXPECT_EQ(text_of(within(5, 1)), "0e+02");
    EXPECT_EQ(text_of(within(-0.001, 0.01)), "0.0");
    EXPECT_EQ(text_of(within(0, 1e-10)), "0e-09");
    const double infinity = std::numeric_limits<double>::infinity();
    EXPECT_EQ(text_of(within(1, infinity)), "unknown");
    EXPECT_EQ(text_of(tracked<double>(1) / tracked<double>(0)), "unknown");
    EXPECT_EQ(with_radius(within(1, infinity)), "1 ± unknown");
    for (const double sign : {1.0, -1.0}) {
        const double nothing = std::copysign(std::numeric_limits<double>::quiet_NaN(), sign);
        EXPECT_EQ(with_radius(tracked<double>(nothing)), "nan ± unknown");
    }
    EXPECT_EQ(with_radius(tracked<double>(0.1)), "0.1 ± 0");
}

// The replacement of libc++'s std::to_chars for long doubles, in every rounding mode.
TEST(PrintingText, ByPrintfEqualsToChars) {
    if (errbound::detail::to_chars_is_wrong<long double>) GTEST_SKIP();
    if (!errbound::detail::is_ieee_format<long double>) GTEST_SKIP() << "a pair of doubles";
    using errbound::detail::decimal, errbound::detail::printf_decimal;
    using limits = std::numeric_limits<long double>;
    std::mt19937_64 random(4);
    const auto check = [&](long double x) {
        const int precision = static_cast<int>(random() % 40);
        for (const auto how : {std::chars_format::scientific, std::chars_format::fixed})
            ASSERT_EQ(printf_decimal(x, how, precision), decimal(x, how, precision));
        const std::string shortest = printf_decimal(x, std::chars_format::scientific);
        ASSERT_LE(shortest.size(), decimal(x, std::chars_format::scientific).size() + 1);
        const errbound::detail::to_nearest reading;
        for (const std::string& text : {shortest, printf_decimal(x)})
            ASSERT_EQ(read_back<long double>(text), x) << text;
    };
    for (const int mode : {FE_TONEAREST, FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
        std::fesetround(mode);
        for (int k = 0; k < support::scaled(300) && !HasFatalFailure(); ++k)
            check(special_value<long double>(random));
        EXPECT_EQ(std::fegetround(), mode);
        std::fesetround(FE_TONEAREST);
    }
    for (const long double x : {0.0L, -0.0L, 1.0L, -3.0L, 0.5L, 1e5L, 100000000000.0L, 123456.0L,
                                1e-4L, 0.00012L, 1e-5L, limits::infinity(), -limits::infinity()})
        EXPECT_EQ(printf_decimal(x), decimal(x));
}

TEST(PrintingText, KeepsTheStreamsFormat) {
    std::ostringstream to;
    to << std::setprecision(2) << std::setw(8) << tracked<double>(3.25) << ' ' << 0.125 << ' '
       << tracked<errbound::float16, errbound::residual>(2);
    EXPECT_EQ(to.str(), "    3.25 0.12 2");
}

#if defined(__cpp_lib_format)
TEST(PrintingByFormat, EqualsThatOfStreams) {
    using number = errbound::tracked<double>;
    const number x = number::within(0.3, 1e-5);
    EXPECT_EQ(std::format("{}", x), errbound::certain_digits(x));
    EXPECT_EQ(std::format("{}", x), "0.3000");
    EXPECT_EQ(std::format("{}>. {:}", x, x), "0.3000>. 0.3000");
    EXPECT_EQ(std::format("{:>10}|{:.<8}|{:^8}", x, x, x), "    0.3000|0.3000..| 0.3000 ");
    EXPECT_EQ(std::format("{:{}}|", x, 8), "0.3000  |");
    EXPECT_EQ(std::format("{:>5}", number::within(1, -1)), "    ?");
    EXPECT_EQ(std::format("{}", errbound::tracked<float>(0.5F)), "0.5");
    EXPECT_EQ(std::format("{}", errbound::with_radius(x)), errbound::with_radius(x));
}
TEST(PrintingByFormat, TakesNoPrecision) {
    const errbound::tracked<double> x = 0.3;
    int width = 8;
    EXPECT_THROW((void)std::vformat("{:.3}", std::make_format_args(x)), std::format_error);
    EXPECT_THROW((void)std::vformat("{:>8.3}", std::make_format_args(x)), std::format_error);
    EXPECT_THROW((void)std::vformat("{:{}.3}", std::make_format_args(x, width)), std::format_error);
}
#endif

}  // namespace
