// Conversions of tracked numbers to another type, and of plain numbers in every rounding direction,
// compared with rationals. The exact number stays within the bound; a number of the type is exact.
#include <gtest/gtest.h>

#include <cfenv>
#include <cfloat>
#include <errbound/binary128.hpp>
#include <errbound/conversion.hpp>
#include <errbound/small_floats.hpp>
#include <limits>
#include <random>
#include <type_traits>
#include <vector>

#include "tests/support/long_double.hpp"
#include "tests/support/scaled.hpp"
#include "tests/support/special_values.hpp"

namespace {

using errbound::convert;
using errbound::number_traits;
using errbound::sign_type;
using errbound::tracked;

/// The number of a small format nearest to x, ties to even.
template <class To>
To nearest(const rational& x) {
    // The number after the largest one would be at the distance of the one before.
    const auto number_of = [](int code) {
        const auto of = [](int c) { return exactly(To::from_code(c)); };
        return code <= To::largest_code ? of(code) : rational(2 * of(code - 1) - of(code - 2));
    };
    const rational size = boost::multiprecision::abs(x);
    int below = 0;
    for (int step = To::codes / 4; step > 0; step /= 2)
        if (below + step <= To::largest_code && number_of(below + step) <= size) below += step;
    const rational twice = 2 * size - number_of(below) - number_of(below + 1);
    const To y = To::from_code(twice > 0 || (twice == 0 && below % 2 == 1) ? below + 1 : below);
    return x < 0 ? -y : y;
}
template <class To, class From>
To nearest_to(const From& value) {
    if constexpr (requires { static_cast<To>(value); })
        return static_cast<To>(value);
    else
        return nearest<To>(exactly(value));
}

template <class Rule, class To, class From>
void check(From value, From error) {
    const auto x = tracked<From, Rule>::within(value, error);
    const auto y = convert<To>(x);
    static_assert(std::is_same_v<decltype(y), const tracked<To, Rule>>);
    using traits = number_traits<To>;
    const std::string context = std::string(Rule::name) + " " +
                                std::to_string(static_cast<double>(value)) + " +- " +
                                std::to_string(static_cast<double>(error));
    if (!number_traits<From>::is_finite(value) || !number_traits<From>::is_finite(x.error())) {
        ASSERT_FALSE(traits::is_finite(y.error())) << context;
        ASSERT_EQ(sign_of(y), sign_type::uncertain) << context;
        return;
    }
    const To plain = nearest_to<To>(value);
    if (!traits::is_finite(plain) || !traits::is_finite(y.error())) {
        ASSERT_EQ(sign_of(y), sign_type::uncertain) << context;
        // Only numbers that are too large for the type have infinite errors.
        ASSERT_TRUE(!traits::is_finite(plain) ||
                    exactly(x.error()) * 4 + exactly(traits::abs(plain)) * 4 >
                        exactly(traits::largest() * traits::unit_roundoff()))
            << context;
        return;
    }
    ASSERT_EQ(y.value(), plain) << context;
    const rational off = exactly(plain) - exactly(value);
    const rational away = boost::multiprecision::abs(off);
    const rational needed = away + exactly(error), bound = exactly(y.error());
    ASSERT_GE(bound, needed) << context;
    if (away == 0 && error == From(0)) {
        ASSERT_EQ(bound, 0) << context;
    }
}

template <class From, class To>
struct conversion {
    using from = From;
    using to = To;
};
using errbound::bfloat16;
using errbound::float16;
using errbound::float8_e4m3;
using errbound::float8_e5m2;
template <class Pair>
class Conversion : public testing::Test {};
using support::long_double;
using pairs =
    testing::Types<conversion<double, float>, conversion<float, double>, conversion<double, double>,
                   conversion<long_double, double>, conversion<long_double, float>,
                   conversion<double, long_double>, conversion<double, float16>,
                   conversion<float, bfloat16>, conversion<double, bfloat16>,
                   conversion<float16, bfloat16>, conversion<bfloat16, float16>,
                   conversion<float16, float8_e4m3>, conversion<bfloat16, float8_e5m2>,
                   conversion<float8_e5m2, float8_e4m3>, conversion<float8_e4m3, float8_e5m2>,
                   conversion<float8_e4m3, double>, conversion<long_double, float16>,
                   conversion<long_double, bfloat16>, conversion<long_double, float8_e4m3>,
                   conversion<float16, long_double>>;
TYPED_TEST_SUITE(Conversion, pairs);

TYPED_TEST(Conversion, HoldsTheExactNumber) {
    using From = typename TypeParam::from;
    using To = typename TypeParam::to;
    using traits = number_traits<From>;
    std::mt19937_64 random(4);
    for (int k = 0; k < support::scaled(5000) && !testing::Test::HasFatalFailure(); ++k) {
        const From value = special_value<From>(random);
        From error = traits::abs(special_value<From>(random));
        if (random() % 4 == 0) error = From(0);
        if (random() % 2 == 0)
            error = traits::scale(traits::abs(value), -static_cast<int>(random() % 60)) *
                    From(static_cast<int>(random() % 4));
        check<errbound::tight, To>(value, error);
        check<errbound::sharp, To>(value, error);
        // The others enlarge the bound of an input, which may overflow.
        if (error == From(0)) {
            check<errbound::residual, To>(value, error);
            check<errbound::interval, To>(value, error);
        }
    }
}

/// Converts every number with every bound.
template <class From, class To>
void check_all() {
    for (int i = 0; i < From::codes; ++i)
        for (int j = 0; j < From::codes / 2; ++j) {
            check<errbound::tight, To>(From::from_code(i), From::from_code(j));
            if (testing::Test::HasFatalFailure()) return;
        }
}
TEST(Conversions, OfEvery8BitNumberWithEveryBound) {
    check_all<float8_e5m2, float8_e4m3>();
    check_all<float8_e4m3, float8_e5m2>();
    check_all<float8_e5m2, float16>();
}

/// Converts neighbours of each midpoint of two numbers, closer than double's last place.
template <class From, class To>
void check_midpoints() {
    for (int code = 0; code < To::largest_code; ++code) {
        const double below(To::from_code(code)), above(To::from_code(code + 1));
        const From middle = below + (above - below) / 2;
        const From off = number_traits<From>::scale(middle, 3 - number_traits<From>::digits);
        const int even = code + code % 2;
        for (const int sign : {1, -1}) {
            const auto converted = [&](const From& x) {
                return convert<To>(tracked<From>(From(sign) * x)) * tracked<To>(To(sign));
            };
            ASSERT_EQ(converted(middle - off).value().code(), code);
            ASSERT_EQ(converted(middle).value().code(), even);
            ASSERT_EQ(converted(middle + off).value().code(), code + 1);
            // The bound is half of the difference, rounded up.
            ASSERT_GE(From(static_cast<double>(converted(middle - off).error())),
                      middle - off - below);
            ASSERT_GT(From(static_cast<double>(converted(middle + off).error())),
                      above - middle - 2 * off);
        }
    }
}
template <class From>
void check_all_midpoints() {
    check_midpoints<From, float16>();
    check_midpoints<From, bfloat16>();
    check_midpoints<From, float8_e4m3>();
    check_midpoints<From, float8_e5m2>();
}
TEST(Conversions, FromWiderTypesRoundOnce) {
    check_all_midpoints<double>();
    check_all_midpoints<support::long_double>();
#if LDBL_MANT_DIG == 113 || defined(__SIZEOF_FLOAT128__)
    using errbound::float128;
    check_all_midpoints<float128>();
    for (int code = 0; code < float16::codes; ++code) {
        const float16 x = float16::from_code(code);
        if (!number_traits<float16>::is_finite(x)) continue;
        const auto wide = convert<float128>(tracked<float16>::within(x, float16(0.1)));
        ASSERT_TRUE(wide.value() == float128(static_cast<double>(x)));
        ASSERT_TRUE(wide.error() == float128(static_cast<double>(float16(0.1))));
        ASSERT_EQ(convert<float16>(wide).value(), x);
    }
    const auto tiny =
        convert<float16>(tracked<float128>(number_traits<float128>::underflow_unit()));
    EXPECT_EQ(tiny.value(), float16(0));
    EXPECT_EQ(tiny.error(), number_traits<float16>::underflow_unit());
    const auto huge = convert<float8_e4m3>(tracked<float128>(number_traits<float128>::largest()));
    EXPECT_EQ(sign_of(huge), sign_type::uncertain);
#endif
    static_assert(convert<float16>(tracked<support::long_double>(0.5)).value() == float16(0.5));
}

TEST(Conversions, ToAnotherRuleAndInConstantExpressions) {
    constexpr auto third = tracked<double>(1) / tracked<double>(3);
    constexpr auto y = convert<float, errbound::interval>(third);
    static_assert(sign_of(y) == errbound::sign_type::positive);
    EXPECT_LE(y.error(), 0x1.01p-25F);
    EXPECT_EQ(convert<float>(tracked<double>(0.5)).error(), 0);
    EXPECT_EQ(convert<double>(tracked<float>::within(1, 0x1p-30F)).error(), 0x1p-30);
}

TEST(Conversions, ThatOverflowOrUnderflow) {
    EXPECT_EQ(sign_of(convert<float>(tracked<double>(1e39))), sign_type::uncertain);
    EXPECT_EQ(sign_of(convert<float8_e4m3>(tracked<float>(465))), sign_type::uncertain);
    EXPECT_EQ(sign_of(convert<float>(tracked<double>::within(1, 1e39))), sign_type::uncertain);
    const auto tiny = convert<float>(tracked<double>(1e-60));
    EXPECT_EQ(tiny.value(), 0);
    EXPECT_EQ(tiny.error(), 0x1p-149F);
    EXPECT_EQ(convert<float>(tracked<double>::within(1, 1e-60)).error(), 0x1p-149F);
}

template <class Number>
Number any_constant(std::mt19937_64& random) {
    if constexpr (std::integral<Number>)
        // Integers of any length, some with trailing zeros.
        return static_cast<Number>(static_cast<Number>(random()) >> random() % (8 * sizeof(Number))
                                                                        << random() % 4);
    else
        return special_value<Number>(random);
}
template <class Number>
rational exact_constant(Number value) {
    if constexpr (std::integral<Number>)
        return rational(value);
    else
        return exactly(value);
}

template <class T, class Rule, class Number>
void check_constant(Number value) {
    const tracked<T, Rule> x = value;
    using traits = number_traits<T>;
    if (!traits::is_finite(x.value()) || !traits::is_finite(x.error())) {
        ASSERT_EQ(sign_of(x), sign_type::uncertain);
        // Only NaN and numbers that are too large for the type have infinite errors.
        if constexpr (!std::integral<Number>)
            if (!number_traits<Number>::is_finite(value)) return;
        const rational size = boost::multiprecision::abs(exact_constant(value));
        ASSERT_GE(size * 2, exactly(traits::largest()));
        return;
    }
    const rational off =
        boost::multiprecision::abs(rational(exact_constant(value) - exactly(x.value())));
    ASSERT_LE(off, exactly(x.error())) << static_cast<double>(value);
    if (off == 0) {
        ASSERT_EQ(x.error(), T(0)) << static_cast<double>(value);
    }
}

template <class Made>
class Constant : public testing::Test {};
using constants = testing::Types<
    conversion<double, float>, conversion<float, double>, conversion<long_double, double>,
    conversion<long_double, float>, conversion<double, float16>, conversion<float, bfloat16>,
    conversion<double, float8_e4m3>, conversion<float, float8_e5m2>, conversion<int, float>,
    conversion<int, float16>, conversion<unsigned, float8_e5m2>, conversion<long long, double>,
    conversion<unsigned long long, double>, conversion<unsigned long long, float>,
    conversion<long long, float>, conversion<signed char, float8_e4m3>, conversion<short, double>>;
TYPED_TEST_SUITE(Constant, constants);

TYPED_TEST(Constant, IsExactOrWithinItsBound) {
    using number = typename TypeParam::from;
    using type = typename TypeParam::to;
    using limits = std::numeric_limits<number>;
    for (const int direction : {FE_TONEAREST, FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
        std::mt19937_64 random(7);
        std::vector<number> constants{limits::min(), limits::max(), limits::lowest(), number(0)};
        for (int k = 0; k < support::scaled(5000); ++k)
            constants.push_back(any_constant<number>(random));
        for (const number& constant : constants) {
            std::fesetround(direction);
            check_constant<type, errbound::tight>(constant);
            // The bounds of `interval` hold only in rounding to nearest.
            if (direction == FE_TONEAREST) check_constant<type, errbound::interval>(constant);
            std::fesetround(FE_TONEAREST);
            if (testing::Test::HasFatalFailure()) return;
        }
    }
}

TEST(Constants, OfSmallFormats) {
    // A double must not be converted to int on the way to these types.
    EXPECT_EQ(sign_of(tracked<float16>(0.1)), sign_type::positive);
    EXPECT_GT(tracked<float16>(0.1).error(), float16(0));
    EXPECT_EQ((tracked<bfloat16>(bfloat16(2)) * 0.5).value(), bfloat16(1));
    EXPECT_EQ(sign_of(tracked<float8_e4m3>(1000000)), sign_type::uncertain);
}

TEST(Constants, OfBuiltInTypes) {
    const std::vector<double> five(5);
    EXPECT_EQ((tracked<double>(10) / five.size()).value(), 2);
    EXPECT_EQ(sign_of(1L + tracked<double>(1) - 3U), sign_type::negative);
    EXPECT_EQ(sign_of(tracked<float>(0.1) - 0.1), sign_type::uncertain);
    constexpr tracked<float> quarter = 0.25;
    static_assert(sign_of(quarter * 4LL) == sign_type::positive);
}

}  // namespace
