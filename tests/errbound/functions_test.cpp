// Functions of exact and of uncertain tracked numbers. errbound/validation tests that the bounds
// hold, in random expressions and in tiny formats.
#include <gtest/gtest.h>

#include <cfloat>
#include <cmath>
#include <complex>
#include <errbound/elementary.hpp>
#include <errbound/explain/explain.hpp>
#include <errbound/functions.hpp>
#include <errbound/rules/affine.hpp>
#include <errbound/rules/relative.hpp>
#include <limits>
#include <random>

#include "tests/support/long_double.hpp"

#if defined(__GLIBC__) && LDBL_MANT_DIG == 64
/// The error of another library's function.
template <>
inline constexpr double errbound::function_error<errbound::elementary_function::exp2, long double> =
    7.5;
#endif

namespace {

using errbound::sign_type;
using errbound::tracked;

template <class Rule>
class Functions : public testing::Test {
  public:
    using number = tracked<double, Rule>;
};
using Rules = testing::Types<errbound::tight, errbound::sharp, errbound::safe, errbound::interval,
                             errbound::residual, errbound::affine, errbound::relative,
                             errbound::explained<errbound::tight>>;
TYPED_TEST_SUITE(Functions, Rules);

TYPED_TEST(Functions, RootsOfSquaresAreExact) {
    using number = typename TestFixture::number;
    for (const double x : {0.0, 1.0, 4.0, 0x1p-200, 12345678.0 * 12345678.0}) {
        const number root = sqrt(number(x));
        EXPECT_EQ(root.value(), std::sqrt(x));
        EXPECT_EQ(root.error(), 0) << x;
    }
}

TYPED_TEST(Functions, RootsAreOffByAboutARounding) {
    using number = typename TestFixture::number;
    for (const double x : {2.0, 1e-300, 1e300, 5e-324}) {
        const number root = sqrt(number(x));
        EXPECT_EQ(root.value(), std::sqrt(x));
        EXPECT_GE(root.error(),
                  std::abs(std::fma(root.value(), root.value(), -x)) / 2.1 / root.value());
        EXPECT_LE(root.error(), 0x1p-50 * root.value());
        EXPECT_EQ(sign_of(root * root - number(x)), sign_type::uncertain) << x;
    }
    // Half of what x is off by, relatively.
    const number wide = sqrt(number::within(100, 1));
    EXPECT_GE(wide.error(), (10 - std::sqrt(99.0)) * (1 - 0x1p-40));
    EXPECT_LE(wide.error(), 0.0505 * number::within(100, 1).error());
}

// fl(√2) is above √2 by 9.67e-17; half a unit in its last place is 1.11e-16.
TEST(Residual, ComputesTheErrorOfARoot) {
    using number = tracked<double, errbound::residual>;
    // √2 − v for v = fl(√2) is (2 − v²)/(√2 + v), whose numerator fma rounds once.
    const double v = std::sqrt(2.0), off = std::fma(-v, v, 2.0) / (2 * v);
    const number root = sqrt(number(2));
    EXPECT_LT(off, -9.6e-17);
    EXPECT_NEAR(root.error(), -off, -1e-14 * off);
    EXPECT_EQ(sign_of(root - number(v)), sign_type::negative);
    // Errors of arguments keep their signs: √((1 + 2^-52)(1 − 2^-52)) = 1 − 2^-105 + ..., and the
    // product rounds to 1.
    const number below = sqrt(number(1 + 0x1p-52) * number(1 - 0x1p-52));
    EXPECT_EQ(below.value(), 1);
    EXPECT_NEAR(below.error(), 0x1p-105, 0x1p-150);
    EXPECT_EQ(sign_of(below - number(1)), sign_type::negative);
    EXPECT_FALSE(std::isfinite(sqrt(number(1) - number(2)).error()));
}

// Both factors are known to within 2.5e-4 and have the same error.
TEST(Affine, KeepsTheSourcesOfTheArgumentOfARoot) {
    using number = tracked<double, errbound::affine>;
    const number x = number::within(2, 1e-3), root = sqrt(x);
    EXPECT_LE(root.error(), 3.54e-4);
    EXPECT_LE((root * root - x).error(), 4e-7);
    EXPECT_LE((sqrt(x) - root).error(), 2e-7);
    EXPECT_LE((fma(x, number(3), number(1)) - number(3) * x).error(), 4e-15);
}

TEST(Interval, RootsAndFusedSumsHaveSharpEnds) {
    using number = tracked<double, errbound::interval>;
    const auto ends = sqrt(number::within(2.5, 1.5)).bound();
    EXPECT_GE(ends.lower, 1 - 0x1p-51);
    EXPECT_LE(ends.lower, 1);
    EXPECT_GE(ends.upper, 2);
    EXPECT_LE(ends.upper, 2 + 0x1p-50);
    const auto point = sqrt(number(2)).bound();
    EXPECT_EQ(point.upper, std::sqrt(2.0));
    EXPECT_GE(point.lower, std::nextafter(std::sqrt(2.0), 1.0));
    // 3·[1, 2] − 3 lies in [0, 3].
    const auto fused = fma(number(3), number::within(1.5, 0.5), number(-3)).bound();
    EXPECT_GE(fused.lower, -0x1p-49);
    EXPECT_GE(fused.upper, 3);
    EXPECT_LE(fused.upper, 3 + 0x1p-49);
}

TEST(Residual, ComputesTheErrorOfAFusedSum) {
    using number = tracked<double, errbound::residual>;
    // (1 + 2^-30)³ = 1 + 3·2^-30 + 3·2^-60 + 2^-90, which rounds to 1 + 3·2^-30.
    const number one_and_more(1 + 0x1p-30);
    const number square = fma(one_and_more, one_and_more, number(0));
    const number cube = fma(square, one_and_more, number(0));
    EXPECT_NEAR(cube.error(), 3 * 0x1p-60 + 0x1p-90, 0x1p-105);
    EXPECT_EQ(fma(number(3), number(5), number(7)).error(), 0);
    EXPECT_EQ(sign_of(fma(one_and_more, one_and_more, number(-(1 + 0x1p-29)))),
              sign_type::positive);
}

/// Generic code calls functions of tracked and built-in numbers in this way.
template <class Number>
bool is_usual(const Number& x) {
    using std::fabs, std::isfinite, std::isnan, std::sqrt;
    return isfinite(x) && !isnan(sqrt(fabs(x)));
}
TYPED_TEST(Functions, AreCalledByGenericCode) {
    using number = typename TestFixture::number;
    using std::isnan;
    EXPECT_TRUE(is_usual(-2.5));
    EXPECT_TRUE(is_usual(number(-2.5)));
    EXPECT_EQ(fabs(number(-2.5)).value(), 2.5);
    const double infinity = std::numeric_limits<double>::infinity();
    EXPECT_FALSE(is_usual(number::within(1, infinity)));
    EXPECT_FALSE(is_usual(number(infinity)));
    EXPECT_FALSE(isnan(number(infinity)));
    EXPECT_TRUE(isnan(number(std::numeric_limits<double>::quiet_NaN())));
    EXPECT_FALSE(is_usual(sqrt(number(-1))));
}

// (3 + 4i)² = −7 + 24i has size 25; the angle of 1 + i is π/4.
TEST(Complex, SizeAngleAndPolarForm) {
    using number = tracked<double, errbound::sharp>;
    using std::abs, std::arg;
    const std::complex<number> z(number(3), number(4)), square = z * z;
    EXPECT_EQ(square.real().value(), -7);
    EXPECT_EQ(square.imag().value(), 24);
    EXPECT_NEAR(abs(square).value(), 25, abs(square).error());
    EXPECT_LE(abs(square).error(), 1e-13);
    EXPECT_EQ((z / z).real().value(), 1);
    EXPECT_EQ(abs(std::complex<double>(3, 4)), 5);
    const number quarter = arg(std::complex<number>(number(1), number(1)));
    EXPECT_NEAR(quarter.value(), 0.78539816339744831, quarter.error() + 1e-16);
    const std::complex<number> back = polar(number(2), quarter);
    EXPECT_NEAR(back.real().value(), std::sqrt(2.0), back.real().error() + 1e-15);
    EXPECT_LE(back.imag().error(), 1e-14);
    EXPECT_FALSE(isfinite(arg(std::complex<number>(number(0), number(0)))));
}

TYPED_TEST(Functions, RootsHaveInfiniteErrorsIfTheArgumentMayBeNegative) {
    using number = typename TestFixture::number;
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const number& x : {number(-1), number(-0x1p-1074), number(nan), number::within(1, 1.5),
                            number::within(0, 0x1p-1074)}) {
        EXPECT_FALSE(std::isfinite(sqrt(x).error())) << x.value();
        EXPECT_EQ(sign_of(sqrt(x)), sign_type::uncertain);
    }
    EXPECT_TRUE(std::isfinite(sqrt(number::within(1, 0.4)).error()));
}

TYPED_TEST(Functions, AbsoluteValues) {
    using number = typename TestFixture::number;
    EXPECT_EQ(abs(number(-3)).value(), 3);
    EXPECT_EQ(abs(number(-3)).error(), 0);
    const number sure = abs(number::within(-3, 1)), unsure = abs(number::within(-1, 2));
    EXPECT_EQ(sure.value(), 3);
    EXPECT_EQ(sign_of(sure), sign_type::positive);
    EXPECT_EQ(unsure.value(), 1);
    EXPECT_GE(unsure.error(), 2);
    EXPECT_EQ(sign_of(unsure), sign_type::uncertain);
}

TYPED_TEST(Functions, MinimumAndMaximum) {
    using number = typename TestFixture::number;
    const number one(1), two(2), about_one = number::within(1.25, 0.5);
    EXPECT_EQ(min(one, two).error(), 0);
    EXPECT_EQ(min(one, two).value(), 1);
    EXPECT_EQ(max(two, one).error(), 0);
    EXPECT_EQ(max(one, two).value(), 2);
    EXPECT_EQ(min(one, about_one).value(), 1);
    EXPECT_GE(min(one, about_one).error(), 0.5);
    EXPECT_EQ(max(one, about_one).value(), 1.25);
    const number unknown = number::within(1, std::numeric_limits<double>::infinity());
    EXPECT_FALSE(std::isfinite(min(unknown, two).error()));
    EXPECT_FALSE(std::isfinite(max(two, unknown).error()));
}

TYPED_TEST(Functions, FusedProductsAreRoundedOnce) {
    using number = typename TestFixture::number;
    const double a = 1 + 0x1p-30, b = 1 - 0x1p-30;
    const number fused = fma(number(a), number(b), number(-1));
    EXPECT_EQ(fused.value(), -0x1p-60);
    EXPECT_EQ(sign_of(fused), sign_type::negative);
    EXPECT_EQ(fma(number(0), number(5), number(7)).error(), 0);
    // A product that underflows keeps its sign.
    for (const double tiny : {0x1p-1000, -0x1p-1000})
        for (const double zero : {0.0, -0.0}) {
            const number underflows = fma(number(tiny), number(0x1p-100), number(zero));
            EXPECT_EQ(underflows.value(), 0);
            EXPECT_EQ(std::signbit(underflows.value()), std::signbit(tiny));
            EXPECT_FALSE(certain(sign_of(underflows)));
        }
    EXPECT_EQ(sign_of(fma(number(a), number(b), number::within(-1, 1e-9))), sign_type::uncertain);
}

/// The remainder of a product that nearly cancels shows a second rounding.
template <class T>
void expect_one_rounding_where_products_cancel() {
    std::mt19937_64 random(1);
    const auto any = [&] { return T(1) + static_cast<T>(random() >> 11) * T(0x1p-53); };
    for (int i = 0; i < 1000; ++i) {
        const T a = any(), b = any();
        const auto [product, error] = errbound::two_product(a, b);
        const T c = -product + T(random() % 200) * errbound::number_traits<T>::epsilon();
        const tracked<T> fused = fma(tracked<T>(a), tracked<T>(b), tracked<T>(c));
        ASSERT_EQ(fused.value(), (product + c) + error) << a << " " << b << " " << c;
    }
}

TEST(FusedProducts, OfAllFormatsAreRoundedOnce) {
    expect_one_rounding_where_products_cancel<float>();
    expect_one_rounding_where_products_cancel<double>();
    if constexpr (support::fuses<support::long_double>)
        expect_one_rounding_where_products_cancel<support::long_double>();
}

TEST(Functions, OfNoneAreThoseOfPlainArithmetic) {
    using number = tracked<double, errbound::none>;
    EXPECT_EQ(sqrt(number(2)).value(), std::sqrt(2.0));
    EXPECT_EQ(abs(number(-2)).value(), 2);
    EXPECT_EQ(sign_of(sqrt(number(-1))), sign_type::uncertain);
}

#if defined(__GLIBC__) && LDBL_MANT_DIG == 64
TEST(FunctionErrors, CanBeSetByAProgram) {
    const long double x = 0.5, v = std::exp2(x), unit = std::numeric_limits<long double>::epsilon();
    const auto named = exp2(tracked<long double>(x)), other = exp(tracked<long double>(x));
    EXPECT_GE(named.error(), 7.5 * unit * v);
    EXPECT_LE(named.error(), 7.6 * unit * v);
    EXPECT_LE(other.error(), 2.1 * unit * other.value());
}
#endif

TEST(CompoundFunctions, HaveTightErrors) {
    using number = tracked<double>;
    const number a = number::within(1, 0x1p-20), b = number::within(2, 0x1p-20);
    // The error is σ(1 − t) + σt; that of a + t(b − a) is σ(1 + 2t).
    EXPECT_LE(lerp(a, b, number(0.5)).error(), 1.001 * 0x1p-20);
    EXPECT_GE((a + number(0.5) * (b - a)).error(), 1.999 * 0x1p-20);
    EXPECT_LE(hypot(number(3e200), number(4e200)).error(), 3.01 * 0x1p-52 * 5e200);
    EXPECT_EQ(hypot(number(0x3p600), number(0x4p600)).value(), 0x5p600);
    EXPECT_EQ(midpoint(number(1e308), number(1.5e308)).value(), 1.25e308);
    EXPECT_EQ(midpoint(number(1), number(2)).value(), 1.5);
    EXPECT_EQ(lerp(a, b, number(0)).error(), 0x1p-20);
    EXPECT_EQ(lerp(a, b, number(1)).value(), 2);
    EXPECT_EQ(pow(number(3), 4).value(), 81);
    EXPECT_EQ(pow(number(0.1), 1).error(), 0);
    EXPECT_EQ(pow(number(0), 0).value(), 1);
    EXPECT_EQ(pow(number(2), -2).value(), 0.25);
    EXPECT_EQ(sign_of(copysign(number(2), number(-0.5))), sign_type::negative);
    EXPECT_EQ(sign_of(copysign(number(2), number::within(-0.5, 1))), sign_type::uncertain);
    // A copied sign is unknown if its number may not exist.
    const number root = sqrt(number(-1));
    EXPECT_FALSE(std::isfinite(copysign(number(2), root).error()));
    EXPECT_EQ(sign_of(copysign(number(0), root)), sign_type::uncertain);
    using safe_number = tracked<double, errbound::safe>;
    EXPECT_EQ(sign_of(pow(safe_number(2), 3)), sign_type::positive);
    EXPECT_EQ(sign_of(pow(safe_number(2), -3)), sign_type::uncertain);
}

TEST(CompoundFunctions, WorkInConstantExpressions) {
    constexpr tracked<double> a = 3, b = 5;
    static_assert(sign_of(midpoint(a, b) - pow(a, 2)) == sign_type::negative);
    static_assert(sign_of(copysign(a, -b)) == sign_type::negative);
}

}  // namespace
