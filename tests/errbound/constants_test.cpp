// Tracked numbers made of numbers of other types, against rationals, in every direction of
// rounding: exact where the type holds the number, else within the bound, and unknown where it
// overflows.
#include <gtest/gtest.h>

#include <cfenv>
#include <errbound/small_floats.hpp>
#include <errbound/tracked.hpp>
#include <limits>
#include <random>
#include <vector>

#include "tests/support/any_format.hpp"
#include "tests/support/long_double.hpp"
#include "tests/support/scaled.hpp"

namespace {

using errbound::bfloat16;
using errbound::float16;
using errbound::float8_e4m3;
using errbound::float8_e5m2;
using errbound::number_traits;
using errbound::sign_type;
using errbound::tracked;

template <class Number>
Number any_constant(std::mt19937_64& random) {
    if constexpr (std::integral<Number>)
        // Of any length, some with zeros at the end.
        return static_cast<Number>(static_cast<Number>(random()) >> random() % (8 * sizeof(Number))
                                                                        << random() % 4);
    else
        return any_number<Number>(random);
}
template <class Number>
rational exact_constant(Number value) {
    if constexpr (std::integral<Number>)
        return rational(value);
    else
        return exactly(value);
}

template <class T, class Rule, class Number>
void check(Number value) {
    const tracked<T, Rule> x = value;
    using traits = number_traits<T>;
    if (!traits::is_finite(x.value()) || !traits::is_finite(x.error())) {
        ASSERT_EQ(sign_of(x), sign_type::uncertain);
        // Only what is too large for the type is unknown, and NaN.
        if constexpr (!std::integral<Number>)
            if (!number_traits<Number>::is_finite(value)) return;
        const rational size = boost::multiprecision::abs(exact_constant(value));
        ASSERT_GE(size * 2, exactly_of(traits::largest()));
        return;
    }
    const rational off =
        boost::multiprecision::abs(rational(exact_constant(value) - exactly_of(x.value())));
    ASSERT_LE(off, exactly_of(x.error())) << static_cast<double>(value);
    if (off == 0) {
        ASSERT_EQ(x.error(), T(0)) << static_cast<double>(value);
    }
}

template <class Number, class To>
struct made_of {
    using number = Number;
    using type = To;
};
template <class Made>
class Constant : public testing::Test {};
using made = testing::Types<
    made_of<double, float>, made_of<float, double>, made_of<support::long_double, double>,
    made_of<support::long_double, float>, made_of<double, float16>, made_of<float, bfloat16>,
    made_of<double, float8_e4m3>, made_of<float, float8_e5m2>, made_of<int, float>,
    made_of<int, float16>, made_of<unsigned, float8_e5m2>, made_of<long long, double>,
    made_of<unsigned long long, double>, made_of<unsigned long long, float>,
    made_of<long long, float>, made_of<signed char, float8_e4m3>, made_of<short, double>>;
TYPED_TEST_SUITE(Constant, made);

TYPED_TEST(Constant, IsExactOrWithinItsBound) {
    using number = typename TypeParam::number;
    using type = typename TypeParam::type;
    using limits = std::numeric_limits<number>;
    for (const int direction : {FE_TONEAREST, FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
        std::mt19937_64 random(7);
        std::vector<number> constants{limits::min(), limits::max(), limits::lowest(), number(0)};
        for (int k = 0; k < support::scaled(5000); ++k)
            constants.push_back(any_constant<number>(random));
        for (const number& constant : constants) {
            std::fesetround(direction);
            check<type, errbound::tight>(constant);
            // Interval's promise holds to nearest alone.
            if (direction == FE_TONEAREST) check<type, errbound::interval>(constant);
            std::fesetround(FE_TONEAREST);
            if (testing::Test::HasFatalFailure()) return;
        }
    }
}

TEST(Constants, OfSmallFormatsAreNotCutOff) {
    // A double is none of these types' numbers, and must not become an int.
    EXPECT_EQ(sign_of(tracked<float16>(0.1)), sign_type::positive);
    EXPECT_GT(tracked<float16>(0.1).error(), float16(0));
    EXPECT_EQ((tracked<bfloat16>(bfloat16(2)) * 0.5).value(), bfloat16(1));
    EXPECT_EQ(sign_of(tracked<float8_e4m3>(1000000)), sign_type::uncertain);
}

TEST(Constants, OfEveryTypeOfTheLanguage) {
    const std::vector<double> five(5);
    EXPECT_EQ((tracked<double>(10) / five.size()).value(), 2);
    EXPECT_EQ(sign_of(1L + tracked<double>(1) - 3U), sign_type::negative);
    EXPECT_EQ(sign_of(tracked<float>(0.1) - 0.1), sign_type::uncertain);
    constexpr tracked<float> quarter = 0.25;
    static_assert(sign_of(quarter * 4LL) == sign_type::positive);
}

}  // namespace
