// Functions made of several operations against rationals: midpoint, linear interpolation, length,
// sign of another number, whole powers; of numbers with bounds, of every size.
#include <gtest/gtest.h>

#include <cmath>
#include <errbound/functions.hpp>
#include <errbound/multiprecision.hpp>
#include <errbound/rules/affine.hpp>
#include <errbound/rules/relative.hpp>
#include <errbound/small_floats.hpp>
#include <limits>
#include <random>
#include <string>

#include "tests/support/any_format.hpp"
#include "tests/support/scaled.hpp"

namespace {

using errbound::number_traits;
using errbound::sign_type;
using errbound::tracked;

template <class Number>
struct sample {
    Number number;
    rational exact;
};

template <class T, class Rule>
class checker {
    using number = tracked<T, Rule>;
    using traits = number_traits<T>;
    using one = sample<number>;

  public:
    void run(int count) {
        for (int k = 0; k < count && !testing::Test::HasFatalFailure(); ++k) {
            const one a = input(), b = related(a), t = random_() % 3 ? fraction() : input();
            check({midpoint(a.number, b.number), (a.exact + b.exact) / 2}, "midpoint");
            check({lerp(a.number, b.number, t.number), a.exact + t.exact * (b.exact - a.exact)},
                  "lerp");
            if constexpr (traits::digits >= 8)
                check_root(hypot(a.number, b.number), a.exact * a.exact + b.exact * b.exact);
            const rational size = boost::multiprecision::abs(a.exact);
            check({copysign(a.number, b.number), b.exact < 0 ? rational(-size) : size}, "copysign");
            check_power(a);
        }
    }

  private:
    one input() {
        T v = any_number<T>(random_);
        while (!traits::is_finite(v)) v = any_number<T>(random_);
        if (random_() % 2) return {number(v), exactly_of(v)};
        return within(v, traits::scale(traits::abs(v), -static_cast<int>(random_() % 40)));
    }
    one within(T v, T error) {
        if (random_() % 8 == 0) error = traits::abs(any_number<T>(random_));
        const number x = number::within(v, error);
        if (!traits::is_finite(error)) return {number(v), exactly_of(v)};
        const int quarters = random_() % 2 ? 4 : static_cast<int>(random_() % 9) - 4;
        return {x, exactly_of(v) + exactly_of(error) * quarters / 4};
    }
    /// Of any size, or near a.
    one related(const one& a) {
        if (random_() % 2) return input();
        const T v = traits::scale(a.number.value(), static_cast<int>(random_() % 9) - 4);
        if (!traits::is_finite(v)) return input();
        return random_() % 2 ? one{number(v), exactly_of(v)} : within(v, traits::scale(v, -9));
    }
    one fraction() {
        const T v = T(static_cast<double>(random_() % 1025) / 1024);
        if (random_() % 2) return {number(v), exactly_of(v)};
        return within(v, traits::scale(T(1), -static_cast<int>(random_() % 12)));
    }

    static bool claims_nothing(const number& x) {
        if (traits::is_finite(x.value()) && traits::is_finite(x.error())) return false;
        // Bounds that are kept in a wider type may tell the sign where the error overflows T.
        if (!errbound::detail::bounds_are_wider<T, Rule> || !traits::is_finite(x.value())) {
            EXPECT_EQ(sign_of(x), sign_type::uncertain);
        }
        return true;
    }
    void check(const one& s, const char* what) {
        const sign_type sign = sign_of(s.number);
        ASSERT_TRUE(sign == sign_type::uncertain || sign == errbound::sign_of(s.exact))
            << what << " " << Rule::name;
        if (claims_nothing(s.number)) return;
        const rational off = exactly_of(s.number.value()) - s.exact;
        ASSERT_LE(boost::multiprecision::abs(off), exactly_of(s.number.error()))
            << what << " " << Rule::name;
    }
    void check_root(const number& root, const rational& square) {
        if (claims_nothing(root)) return;
        const rational v = exactly_of(root.value()), e = exactly_of(root.error());
        ASSERT_TRUE((v - e <= 0 || (v - e) * (v - e) <= square) && (v + e) * (v + e) >= square)
            << "hypot " << Rule::name;
        ASSERT_TRUE(sign_of(root) != sign_type::negative &&
                    (sign_of(root) != sign_type::zero || square == 0));
    }
    void check_power(const one& a) {
        const int n = static_cast<int>(random_() % 13) - 4;
        if (n < 0 && a.exact == 0) return;
        rational exact = 1;
        for (int i = 0; i < std::abs(n); ++i) exact *= a.exact;
        check({pow(a.number, n), n < 0 ? rational(1 / exact) : exact}, "pow");
    }

    std::mt19937_64 random_{11};
};

template <class T>
class CompoundFunctions : public testing::Test {};
using numbers = testing::Types<double, float, errbound::float16, errbound::bfloat16,
                               errbound::float8_e5m2, errbound::float8_e4m3>;
TYPED_TEST_SUITE(CompoundFunctions, numbers);

TYPED_TEST(CompoundFunctions, HoldTheExactResult) {
    const int count = support::scaled(4000);
    checker<TypeParam, errbound::tight>().run(count);
    checker<TypeParam, errbound::sharp>().run(count);
    checker<TypeParam, errbound::safe>().run(count);
    checker<TypeParam, errbound::interval>().run(count);
    checker<TypeParam, errbound::residual>().run(count);
    checker<TypeParam, errbound::affine>().run(count);
    checker<TypeParam, errbound::relative>().run(count);
}

// From the other side: bounds are not much larger than they have to be.
TEST(CompoundFunctionsOfDoubles, AreTight) {
    using number = tracked<double>;
    const number a = number::within(1, 0x1p-20), b = number::within(2, 0x1p-20);
    // σ(1 − t) + σt, and not σ(1 + 2t) as of a + t(b − a).
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
    // The sign of what may not exist: the result may not, either.
    const number root = sqrt(number(-1));
    EXPECT_FALSE(std::isfinite(copysign(number(2), root).error()));
    EXPECT_EQ(sign_of(copysign(number(0), root)), sign_type::uncertain);
    using safe_number = tracked<double, errbound::safe>;
    EXPECT_EQ(sign_of(pow(safe_number(2), 3)), sign_type::positive);
    EXPECT_EQ(sign_of(pow(safe_number(2), -3)), sign_type::uncertain);
}

TEST(CompoundFunctionsOfDoubles, WorkInConstantExpressions) {
    constexpr tracked<double> a = 3, b = 5;
    static_assert(sign_of(midpoint(a, b) - pow(a, 2)) == sign_type::negative);
    static_assert(sign_of(copysign(a, -b)) == sign_type::negative);
}

}  // namespace
