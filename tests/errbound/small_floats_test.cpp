// Formats of 8 and 16 bits. The tests try every code and every conversion at its breakpoints, and
// compare every pair of 8-bit numbers with rationals. They compare a sample of the pairs of 16-bit
// numbers with exact midpoints; ERRBOUND_TEST_SCALE=5000 tries all 2^32 pairs of both formats.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <errbound/small_floats.hpp>
#include <errbound/tracked.hpp>
#include <errbound/validation/rule_list.hpp>
#include <limits>
#include <random>
#include <type_traits>

#include "tests/support/scaled.hpp"
#include "tests/support/special_values.hpp"

namespace {

using errbound::bfloat16;
using errbound::float16;
using errbound::float8_e4m3;
using errbound::float8_e5m2;
using errbound::number_traits;

/// The value of a code by its definition; beyond the largest number as if the format went on.
template <class T>
double by_definition(int code) {
    const int size = code & (T::codes / 2 - 1);
    const int fractions = 1 << (T::precision - 1), field = size / fractions;
    const int units = field == 0 ? size : size % fractions + fractions;
    const int exponent = std::max(field, 1) - 1 + T::least_exponent - (T::precision - 1);
    return std::copysign(std::ldexp(units, exponent), size == code ? 1 : -1);
}

/// True if r is x rounded to nearest even. compare(m) is the sign of |x| − m; m >= 0 is a number of
/// the format or the midpoint of two.
template <class T, class Compare>
bool is_nearest(T r, bool negative, const Compare& compare) {
    const int code = r.code() & (T::codes / 2 - 1);
    if ((r.code() != code) != negative || code > T::overflow_code) return false;
    const double size = by_definition<T>(code);
    if (code > 0) {
        const int above = compare((by_definition<T>(code - 1) + size) / 2);
        if (above < 0 || (above == 0 && code % 2 == 1)) return false;
    }
    if (code > T::largest_code) return true;
    const int below = compare((size + by_definition<T>(code + 1)) / 2);
    return below < 0 || (below == 0 && code % 2 == 0);
}
/// The sign of y − z.
int order(double y, double z) {
    return y > z ? 1 : y < z ? -1 : 0;
}

template <class T>
class SmallFloats : public testing::Test {};
using formats = testing::Types<float16, bfloat16, float8_e5m2, float8_e4m3>;
TYPED_TEST_SUITE(SmallFloats, formats);

TYPED_TEST(SmallFloats, CodesHaveTheirValues) {
    using T = TypeParam;
    EXPECT_EQ(sizeof(T), T::bits / 8u);
    static_assert(std::is_trivially_copyable_v<T>);
    for (int code = 0; code < T::codes; ++code) {
        const T x = T::from_code(code);
        const int size = code & (T::codes / 2 - 1);
        if (size <= T::largest_code) {
            ASSERT_EQ(double(x), by_definition<T>(code)) << code;
            ASSERT_EQ(std::signbit(double(x)), code != size);
            ASSERT_EQ(T(double(x)).code(), code);
            ASSERT_EQ(T(float(x)).code(), code);
        } else if (number_traits<T>::has_infinity && size == T::overflow_code) {
            ASSERT_TRUE(std::isinf(double(x)));
            ASSERT_EQ(T(double(x)).code(), code);
        } else {
            ASSERT_TRUE(std::isnan(double(x)));
            ASSERT_TRUE(std::isnan(double(T(double(x)))) && std::isnan(double(T(float(x)))));
            ASSERT_FALSE(x == x);
        }
        ASSERT_EQ(number_traits<T>::is_finite(x), size <= T::largest_code);
        ASSERT_EQ((-x).code(), code ^ (T::codes / 2));
    }
}

/// Rounding is monotone: it is right everywhere if it is right at ties and next to them.
template <class T, class Source>
void check_conversion_from() {
    const Source infinity = std::numeric_limits<Source>::infinity();
    for (int code = 0; code <= T::largest_code; ++code) {
        const auto tie =
            static_cast<Source>((by_definition<T>(code) + by_definition<T>(code + 1)) / 2);
        const int even = code % 2 == 0 ? code : code + 1;
        for (const Source sign : {Source(1), Source(-1)}) {
            const int bit = sign < 0 ? T::codes / 2 : 0;
            const auto code_of = [&](Source size) { return T(sign * size).code() - bit; };
            ASSERT_EQ(code_of(std::nextafter(tie, Source(0))), code) << code;
            ASSERT_EQ(code_of(tie), even) << code;
            ASSERT_EQ(code_of(std::nextafter(tie, infinity)), code + 1) << code;
        }
    }
    for (const Source x : {std::numeric_limits<Source>::max(), infinity})
        ASSERT_EQ(T(x).code(), T::overflow_code);
    ASSERT_EQ(T(std::numeric_limits<Source>::denorm_min()).code(), 0);
    ASSERT_EQ(
        T(std::numeric_limits<Source>::min()).code() == 1 << (T::precision - 1),
        std::numeric_limits<Source>::min() == Source(double(number_traits<T>::smallest_normal())));
}

TYPED_TEST(SmallFloats, ConversionsRoundOnce) {
    check_conversion_from<TypeParam, float>();
    check_conversion_from<TypeParam, double>();
}

/// Integers next to each tie, up to 2^64: more bits than a double has.
TYPED_TEST(SmallFloats, IntegersOfEveryLengthAreRoundedOnce) {
    using T = TypeParam;
    for (int code = 0; code <= T::largest_code; ++code) {
        const double tie = (by_definition<T>(code) + by_definition<T>(code + 1)) / 2;
        if (tie != std::floor(tie) || tie >= 0x1p64) continue;
        const auto at = static_cast<std::uint64_t>(tie);
        const int even = code % 2 == 0 ? code : code + 1;
        ASSERT_EQ(T(at - 1).code(), code) << at;
        ASSERT_EQ(T(at).code(), even) << at;
        ASSERT_EQ(T(at + 1).code(), code + 1) << at;
        if (at >= std::uint64_t{1} << 63) continue;
        const auto negative = -static_cast<std::int64_t>(at);
        const int bit = T::codes / 2;
        ASSERT_EQ(T(negative + 1).code(), (tie == 1 ? 0 : bit) + code) << at;
        ASSERT_EQ(T(negative).code(), bit + even) << at;
        ASSERT_EQ(T(negative - 1).code(), bit + code + 1) << at;
    }
    for (const std::int64_t size : {std::numeric_limits<std::int64_t>::max(), std::int64_t{0}})
        ASSERT_EQ(T(size).code(), T(static_cast<double>(size)).code());
    const auto least = std::numeric_limits<std::int64_t>::min();
    ASSERT_EQ(T(least).code(), T(static_cast<double>(least)).code());
    const errbound::tracked<T> x = std::size_t{3};
    ASSERT_EQ(double(x.error()), 0);
    const errbound::tracked<T> beyond = ~std::uint64_t{0};
    ASSERT_GT(double(errbound::tracked<T>(std::uint64_t{17}).error()), T::precision == 4 ? 0 : -1);
    ASSERT_NE(double(beyond.error()), 0);
}

TYPED_TEST(SmallFloats, LimitsAgreeWithTheCodes) {
    using T = TypeParam;
    using limits = std::numeric_limits<T>;
    using traits = number_traits<T>;
    EXPECT_EQ(double(limits::epsilon()), double(T::from_code(T(1).code() + 1)) - 1);
    EXPECT_EQ(double(traits::unit_roundoff()), double(limits::epsilon()) / 2);
    EXPECT_EQ(double(limits::denorm_min()), by_definition<T>(1));
    EXPECT_EQ(double(limits::min()), std::ldexp(1.0, limits::min_exponent - 1));
    EXPECT_LT(double(T::from_code(limits::min().code() - 1)), double(limits::min()));
    EXPECT_EQ(std::ilogb(double(limits::max())), limits::max_exponent - 1);
    EXPECT_EQ(double(limits::lowest()), -double(limits::max()));
    EXPECT_FALSE(traits::is_finite(limits::infinity()));
    EXPECT_EQ(limits::has_infinity, std::isinf(double(limits::infinity())));
    EXPECT_EQ(limits::digits10, static_cast<int>((limits::digits - 1) * std::log10(2.0)));
    EXPECT_EQ(limits::max_digits10, std::ceil(limits::digits * std::log10(2.0) + 1));
    EXPECT_EQ(limits::max_exponent10, std::floor(std::log10(double(limits::max()))));
    EXPECT_EQ(limits::min_exponent10, std::ceil(std::log10(double(limits::min()))));
}

TEST(SmallFloats, ExtremesAreThoseOfTheSpecifications) {
    EXPECT_EQ(double(number_traits<float16>::largest()), 65504);
    EXPECT_EQ(double(number_traits<bfloat16>::largest()), 0x1.fep127);
    EXPECT_EQ(double(number_traits<float8_e5m2>::largest()), 57344);
    EXPECT_EQ(double(number_traits<float8_e4m3>::largest()), 448);
    EXPECT_EQ(double(number_traits<float8_e4m3>::smallest_normal()), 0x1p-6);
    EXPECT_EQ(double(number_traits<float8_e4m3>::underflow_unit()), 0x1p-9);
    EXPECT_EQ(float8_e4m3::from_code(0x7f).code(), float8_e4m3(1000).code());
    EXPECT_EQ(double(float8_e4m3(464)), 448);  // a tie with 480, which would be the next number
    EXPECT_TRUE(std::isnan(double(float8_e4m3(std::nextafter(464.0, 500.0)))));
    EXPECT_TRUE(std::isnan(double(float8_e4m3(448) + float8_e4m3(32))));
}

TEST(SmallFloats, WorkInConstantExpressions) {
    constexpr float16 x(0.1), y = 3;
    static_assert(float(x * y) == 0.2998046875F && x < y && -y < x);
    static_assert(float(number_traits<float16>::scale(y, -2)) == 0.75F);
    using number = errbound::tracked<float16, errbound::sharp>;
    static_assert(sign_of(number(y) * number(y) - number(9)) == errbound::sign_type::uncertain);
    static_assert(sign_of(number(y) * number(y) - number(8)) == errbound::sign_type::positive);
    static_assert(!std::is_convertible_v<double, float16> && std::is_convertible_v<int, float16> &&
                  std::is_convertible_v<std::size_t, float16>);
}

template <class T>
class PairsOf8 : public testing::Test {};
using formats_of_8 = testing::Types<float8_e5m2, float8_e4m3>;
TYPED_TEST_SUITE(PairsOf8, formats_of_8);

template <class T>
bool is_nearest_of(T r, const rational& exact) {
    const rational size = exact < 0 ? rational(-exact) : exact;
    return is_nearest(r, exact < 0, [&](double m) { return size.compare(exactly(m)); });
}

TYPED_TEST(PairsOf8, OperationsAreRoundedOnce) {
    using T = TypeParam;
    const auto finite = [](T x) { return number_traits<T>::is_finite(x); };
    for (int i = 0; i < T::codes; ++i)
        for (int j = 0; j < T::codes; ++j) {
            const T a = T::from_code(i), b = T::from_code(j);
            if (!finite(a) || !finite(b)) {
                // The result is that of doubles, except infinities if the format has none.
                const double x = double(a), y = double(b);
                for (const auto& [r, s] : {std::pair{a + b, x + y}, std::pair{a * b, x * y},
                                           std::pair{a - b, x - y}, std::pair{a / b, x / y}})
                    ASSERT_TRUE(double(r) == s || (std::isnan(double(r)) && std::isnan(s)));
                continue;
            }
            const rational x = exactly(double(a)), y = exactly(double(b));
            // A zero has the sign that float's has.
            const auto right = [&](T r, const rational& exact) {
                return exact == 0 ? r == 0 : is_nearest_of(r, exact);
            };
            ASSERT_TRUE(right(a + b, x + y) && right(a - b, x - y) && right(a * b, x * y))
                << double(a) << " " << double(b);
            if (y != 0) {
                ASSERT_TRUE(right(a / b, x / y)) << double(a) << " / " << double(b);
            } else {
                ASSERT_FALSE(finite(a / b));
            }
        }
}

template <class T>
class NumbersOf16 : public testing::Test {};
using formats_of_16 = testing::Types<float16, bfloat16>;
TYPED_TEST_SUITE(NumbersOf16, formats_of_16);

TYPED_TEST(SmallFloats, RootsAreRoundedOnce) {
    using T = TypeParam;
    for (int code = 1; code <= T::largest_code; ++code) {
        const T x = T::from_code(code);
        // Squares of midpoints have at most 24 bits.
        ASSERT_TRUE(is_nearest(number_traits<T>::sqrt(x), false, [&](double m) {
            return order(double(x), m * m);
        })) << code;
    }
    EXPECT_EQ(double(number_traits<T>::sqrt(T(0))), 0);
    EXPECT_TRUE(std::isnan(double(number_traits<T>::sqrt(T(-1)))));
}

TYPED_TEST(SmallFloats, ScalingIsRoundedOnceAndExponentsAreRight) {
    using T = TypeParam;
    const int range = T::bits == 8 ? 60 : 3;
    for (int code = 1; code <= T::largest_code; ++code) {
        const T x = T::from_code(code);
        const double value = double(x);
        ASSERT_EQ(number_traits<T>::exponent(-x), std::ilogb(value) + 1);
        for (int e = -range; e <= range; ++e)
            ASSERT_EQ(number_traits<T>::scale(x, e).code(), T(std::ldexp(value, e)).code());
        const int out = T::least_exponent - std::ilogb(value);
        for (int e = out - T::precision - 1; e <= out + 1; ++e)
            ASSERT_EQ(number_traits<T>::scale(x, e).code(), T(std::ldexp(value, e)).code());
        for (const int e : {-2000000000, -5000, 5000, 2000000000})
            ASSERT_EQ(number_traits<T>::scale(x, e).code(), e < 0 ? 0 : T::overflow_code);
    }
}

/// Compares |a ∘ b| with midpoints. two_sum computes the error of a sum; products and quotients
/// have at most 23 bits and are exact.
template <class T>
bool pair_is_right(T a, T b) {
    const double x = double(a), y = double(b);
    const auto sum_is_right = [](T r, double p, double q) {
        const auto [sum, error] = errbound::two_sum(p, q);
        if (sum == 0) return r == 0;
        const double size = std::abs(sum), rest = sum < 0 ? -error : error;
        return is_nearest(r, sum < 0,
                          [&](double m) { return size != m ? order(size, m) : order(rest, 0); });
    };
    const bool negative = std::signbit(x) != std::signbit(y);
    const double product = std::abs(x * y);
    const auto of_product = [&](double m) { return order(product, m); };
    const auto of_quotient = [&](double m) { return order(std::abs(x), m * std::abs(y)); };
    return sum_is_right(a + b, x, y) && sum_is_right(a - b, x, -y) &&
           is_nearest(a * b, negative, of_product) &&
           (y == 0 || is_nearest(a / b, negative, of_quotient));
}

TYPED_TEST(NumbersOf16, PairsAreRoundedOnce) {
    using T = TypeParam;
    constexpr int stride_of_sample = 4093;  // a prime: all remainders are met
    const int stride = std::max(1, stride_of_sample / support::scaled(1));
    // One sign of a is enough: −(a ∘ b) = (−a) ∘ (∓b).
    std::int64_t next = 0;
    for (int i = 0; i <= T::largest_code; ++i) {
        for (; next < T::codes; next += stride) {
            const T a = T::from_code(i), b = T::from_code(static_cast<int>(next));
            if (!number_traits<T>::is_finite(b)) continue;
            ASSERT_TRUE(pair_is_right(a, b)) << double(a) << " " << double(b);
        }
        next -= T::codes;
    }
}

TYPED_TEST(SmallFloats, FusedProductsAreRoundedOnce) {
    using T = TypeParam;
    std::mt19937_64 random(5);
    for (int k = 0; k < support::scaled(400000); ++k) {
        const auto any = [&] {
            return T::from_code(static_cast<int>(random() % static_cast<unsigned>(T::codes)));
        };
        const T a = any(), b = any();
        // Often next to a product that is nearly a tie.
        T c = any();
        if (random() % 2 == 0) c = number_traits<T>::scale(a * b, -static_cast<int>(random() % 40));
        if (random() % 4 == 0) c = -(a * b);
        if (!std::isfinite(double(a)) || !std::isfinite(double(b)) || !std::isfinite(double(c)))
            continue;
        const rational exact = exactly(double(a)) * exactly(double(b)) + exactly(double(c));
        const T r = number_traits<T>::fma(a, b, c);
        ASSERT_TRUE(exact == 0 ? r == 0 : is_nearest_of(r, exact))
            << double(a) << " " << double(b) << " " << double(c);
    }
}

/// Results of an overflow, and numbers computed from them, are never certain.
TYPED_TEST(SmallFloats, OverflowIsUncertain) {
    using T = TypeParam;
    const auto check = [](const auto& x) {
        EXPECT_EQ(sign_of(x), errbound::sign_type::uncertain);
        EXPECT_FALSE(std::isfinite(double(x.error())));
    };
    const auto of_rule = [&]<class Rule>() {
        using number = errbound::tracked<T, Rule>;
        const number huge(number_traits<T>::largest()), one(1);
        const number wide =
            number::within(number_traits<T>::largest(), number_traits<T>::largest());
        for (const number& x : {huge + huge, huge * huge, -huge - huge, scale(huge, 1),
                                (huge + huge) - huge, one - huge * huge})
            check(x);
        if constexpr (number_traits<T>::max_exponent < 31)
            for (const int i : {2000000000, -2000000000}) check(number(i));
        check(wide * wide);
    };
    using namespace errbound;
    for_each_rule(rule_types<tight, sharp, safe, interval, residual, affine, relative>(), of_rule);
}

}  // namespace
