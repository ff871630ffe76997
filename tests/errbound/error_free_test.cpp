// Error-free transformations compared with rationals: random, extreme and subnormal operands.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <errbound/error_free.hpp>
#include <limits>
#include <random>

#include "tests/support/long_double.hpp"
#include "tests/support/special_values.hpp"

namespace {

using errbound::number_traits;

/// The number of cases in which each result was exact.
struct counts {
    int sums = 0, products = 0, remainders = 0, splits = 0;
};

template <class T>
counts compare(int pairs, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    counts held;
    for (int k = 0; k < pairs; ++k) {
        const T a = special_value<T>(random), b = special_value<T>(random);
        const rational x = exactly(a), y = exactly(b);

        const auto sum = errbound::two_sum(a, b);
        EXPECT_EQ(sum.value, a + b);
        if (std::isfinite(sum.value) && std::isfinite(sum.error)) {
            ++held.sums;
            EXPECT_EQ(exactly(sum.value) + exactly(sum.error), x + y) << a << " + " << b;
            const auto fast = std::abs(a) < std::abs(b) ? errbound::fast_two_sum(b, a)
                                                        : errbound::fast_two_sum(a, b);
            EXPECT_EQ(exactly(fast.value) + exactly(fast.error), x + y) << a << " + " << b;
        }

        const auto product = errbound::two_product(a, b);
        EXPECT_TRUE(product.value == a * b) << a << " * " << b;
        if (errbound::product_error_is_exact(a, b, product)) {
            ++held.products;
            EXPECT_EQ(exactly(product.value) + exactly(product.error), x * y) << a << " * " << b;
        }

        if (b != 0) {
            const T quotient = a / b;
            const auto remainder = errbound::remainder_of_division(a, b, quotient);
            if (remainder.exact) {
                ++held.remainders;
                EXPECT_EQ(exactly(remainder.value), x - exactly(quotient) * y) << a << " / " << b;
            }
        }

        const auto parts = errbound::split(a);
        if (std::isfinite(parts.value)) {
            ++held.splits;
            EXPECT_EQ(exactly(parts.value) + exactly(parts.error), x) << a;
            constexpr int half = (std::numeric_limits<T>::digits + 1) / 2;
            EXPECT_LE(std::abs(parts.error),
                      std::ldexp(std::abs(a), half - number_traits<T>::digits))
                << a;
        }
        if (testing::Test::HasFailure()) return held;
    }
    return held;
}

template <class T>
class ErrorFree : public testing::Test {};
using types = testing::Types<float, double, support::long_double>;
TYPED_TEST_SUITE(ErrorFree, types);

TYPED_TEST(ErrorFree, ValueAndErrorAreTheExactResult) {
    constexpr int pairs = 30000;
    const counts held = compare<TypeParam>(pairs, 1);
    EXPECT_GT(held.sums, pairs * 9 / 10);
    EXPECT_GT(held.products, pairs / 3);
    EXPECT_GT(held.remainders, pairs / 3);
    EXPECT_GT(held.splits, pairs * 9 / 10);
}

TYPED_TEST(ErrorFree, InexactErrorsAreReported) {
    using T = TypeParam;
    const auto known = [](T a, T b) {
        return errbound::product_error_is_exact(a, b, errbound::two_product(a, b));
    };
    const T huge = std::numeric_limits<T>::max(), tiny = std::numeric_limits<T>::min();
    const T odd = 1 + std::numeric_limits<T>::epsilon();
    EXPECT_TRUE(known(odd, odd));
    EXPECT_TRUE(known(T(0), odd));
    EXPECT_FALSE(known(T(0), huge));       // with fused multiply-add, too
    EXPECT_FALSE(known(tiny * odd, odd));  // the error is below the smallest number
    EXPECT_FALSE(known(tiny, tiny));
    EXPECT_FALSE(known(huge, huge));
    // The error is lost if two_product without fused multiply-add overflows.
    EXPECT_FALSE(known(huge / 2, tiny * 4 * odd));
    EXPECT_FALSE(known(std::sqrt(huge) * odd, std::sqrt(huge) * odd / 2));
    EXPECT_TRUE(known(std::sqrt(huge) * odd, std::sqrt(huge) * odd / 8));
    EXPECT_FALSE(errbound::remainder_of_division(tiny, huge, T(tiny / huge)).exact);
}

TEST(ErrorFreeConstants, AreConstantExpressions) {
    constexpr auto product = errbound::two_product(0.1, 0.1);
    static_assert(product.value == 0.1 * 0.1 && product.error != 0);
    static_assert(errbound::two_sum(1.0, 0x1p-60).error == 0x1p-60);
}

}  // namespace
