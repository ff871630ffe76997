// Functions of tracked numbers: what they say of exact and of uncertain arguments. That bounds hold
// is for errbound/validation, which tries them in random expressions and in tiny formats.
#include <gtest/gtest.h>

#include <cmath>
#include <errbound/explain/explain.hpp>
#include <errbound/functions.hpp>
#include <errbound/rules/affine.hpp>
#include <errbound/rules/relative.hpp>
#include <limits>
#include <random>

#include "tests/support/long_double.hpp"

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
    EXPECT_GE(wide.error(), 10 - std::sqrt(99.0));
    EXPECT_LE(wide.error(), 0.0505 * number::within(100, 1).error());
}

TYPED_TEST(Functions, RootsOfWhatMayBeNegativeAreUnknown) {
    using number = typename TestFixture::number;
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const number& x : {number(-1), number(-0x1p-1074), number(nan), number::within(1, 1.5),
                            number::within(0, 0x1p-1074)}) {
        EXPECT_FALSE(std::isfinite(sqrt(x).error())) << x.value();
        EXPECT_EQ(sign_of(sqrt(x)), sign_type::uncertain);
    }
    EXPECT_TRUE(std::isfinite(sqrt(number::within(1, 0.4)).error()));
}

TYPED_TEST(Functions, AbsoluteValuesKeepWhatIsKnown) {
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

TYPED_TEST(Functions, LesserAndGreaterAreWhatTheyCertainlyAre) {
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
    // What underflows keeps its sign.
    for (const double tiny : {0x1p-1000, -0x1p-1000})
        for (const double zero : {0.0, -0.0}) {
            const number underflows = fma(number(tiny), number(0x1p-100), number(zero));
            EXPECT_EQ(underflows.value(), 0);
            EXPECT_EQ(std::signbit(underflows.value()), std::signbit(tiny));
            EXPECT_FALSE(certain(sign_of(underflows)));
        }
    EXPECT_EQ(sign_of(fma(number(a), number(b), number::within(-1, 1e-9))), sign_type::uncertain);
}

/// What is left of a product that nearly cancels shows a second rounding.
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
#ifndef __MINGW32__  // where those of long doubles do not compile
    expect_one_rounding_where_products_cancel<support::long_double>();
#endif
}

TEST(FunctionsOfNone, AreThoseOfPlainArithmetic) {
    using number = tracked<double, errbound::none>;
    EXPECT_EQ(sqrt(number(2)).value(), std::sqrt(2.0));
    EXPECT_EQ(abs(number(-2)).value(), 2);
    EXPECT_EQ(sign_of(sqrt(number(-1))), sign_type::uncertain);
}

/// Written once over plain and tracked numbers.
template <class T>
T distance(const T& x, const T& y) {
    using std::sqrt;
    return sqrt(x * x + y * y);
}

TEST(FunctionsOfAnyNumber, AreFoundByTheirArguments) {
    EXPECT_EQ(distance(3.0, 4.0), 5);
    EXPECT_EQ(distance(tracked<double>(3), tracked<double>(4)).value(), 5);
    EXPECT_EQ(distance(tracked<float>(3), tracked<float>(4)).value(), 5);
}

}  // namespace
