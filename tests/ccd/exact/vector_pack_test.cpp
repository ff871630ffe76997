// Packs of the compiler's vectors compared with scalar operations, also on this machine, where
// kernels use xsimd.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>
#include <vector>

#define ERRBOUND_INSTRUCTION_SET one_by_one
#include "ccd/exact/vector_pack.hpp"

namespace ccd::detail::one_by_one {
namespace {

template <class T>
using bits_of_number = std::conditional_t<sizeof(T) == 8, std::uint64_t, std::uint32_t>;

template <class T>
bool same(T a, T b) {
    return (std::isnan(a) && std::isnan(b)) ||
           std::bit_cast<bits_of_number<T>>(a) == std::bit_cast<bits_of_number<T>>(b);
}

template <class T>
std::vector<T> special_numbers() {
    using limits = std::numeric_limits<T>;
    std::vector<T> all;
    for (const T x : {T(0), T(1), T(3), T(0.1), limits::denorm_min(), limits::min(), limits::max(),
                      limits::infinity(), T(1) + limits::epsilon()})
        all.insert(all.end(), {x, -x});
    all.push_back(limits::quiet_NaN());
    return all;
}

template <class T>
struct VectorPack : testing::Test {};
using numbers = testing::Types<double, float>;
TYPED_TEST_SUITE(VectorPack, numbers);

/// Calls visit(a, b, lane) for packs of all pairs of special numbers; each pair is once in each
/// lane.
template <class T, class Visit>
void for_all_pairs(const Visit& visit) {
    using pack = vector_pack<T>;
    for (const T a : special_numbers<T>())
        for (const T b : special_numbers<T>())
            for (std::size_t lane = 0; lane < pack::size; ++lane) {
                T left[pack::size] = {7, 7}, right[pack::size] = {5, 5};
                left[lane] = a;
                right[lane] = b;
                visit(pack::load_unaligned(left), pack::load_unaligned(right), a, b, lane);
            }
}

template <class T>
T at(const vector_pack<T>& x, std::size_t lane) {
    T all[vector_pack<T>::size];
    x.store_unaligned(all);
    return all[lane];
}

TYPED_TEST(VectorPack, ArithmeticIsThatOfNumbers) {
    using T = TypeParam;
    for_all_pairs<T>([](const auto& x, const auto& y, T a, T b, std::size_t lane) {
        EXPECT_TRUE(same<T>(at<T>(x + y, lane), a + b)) << a << ' ' << b;
        EXPECT_TRUE(same<T>(at<T>(x - y, lane), a - b)) << a << ' ' << b;
        EXPECT_TRUE(same<T>(at<T>(x * y, lane), a * b)) << a << ' ' << b;
        EXPECT_TRUE(same<T>(at<T>(x / y, lane), a / b)) << a << ' ' << b;
        EXPECT_TRUE(same<T>(at<T>(-x, lane), -a)) << a;
        EXPECT_TRUE(same<T>(at<T>(abs(x), lane), std::abs(a))) << a;
        EXPECT_TRUE(same<T>(at<T>(sqrt(x), lane), std::sqrt(a))) << a;
        EXPECT_TRUE(same<T>(at<T>(vector_pack<T>(a), lane), a)) << a;
        EXPECT_TRUE(same<T>(at<T>(min(x, y), lane), a < b ? a : b)) << a << ' ' << b;
        EXPECT_TRUE(same<T>(at<T>(max(x, y), lane), b < a ? a : b)) << a << ' ' << b;
    });
}

TYPED_TEST(VectorPack, ComparisonsAreLaneByLane) {
    using T = TypeParam;
    for_all_pairs<T>([](const auto& x, const auto& y, T a, T b, std::size_t lane) {
        const auto set = [lane](const auto& mask) { return (mask.bits() >> lane & 1) != 0; };
        EXPECT_EQ(set(x < y), a < b);
        EXPECT_EQ(set(x > y), a > b);
        EXPECT_EQ(set(x <= y), a <= b);
        EXPECT_EQ(set(x >= y), a >= b);
        EXPECT_EQ(set(x == y), a == b);
        EXPECT_TRUE(same<T>(at<T>(select(x < y, x, y), lane), a < b ? a : b));
    });
}

TYPED_TEST(VectorPack, MasksAreSetsOfLanes) {
    using mask = vector_mask<TypeParam>;
    constexpr std::uint32_t every = (1U << mask::size) - 1;
    EXPECT_EQ(mask(true).bits(), every);
    EXPECT_EQ(mask(false).bits(), 0U);
    EXPECT_EQ((!mask(true)).bits(), 0U);
    EXPECT_EQ((mask(true) & mask(false)).bits(), 0U);
    EXPECT_EQ((mask(true) | mask(false)).bits(), every);
    EXPECT_TRUE(all(mask(true)) && any(mask(true)) && !none(mask(true)));
    EXPECT_TRUE(!all(mask(false)) && !any(mask(false)) && none(mask(false)));
    TypeParam numbers[mask::size] = {1};
    const auto some =
        vector_pack<TypeParam>::load_unaligned(numbers) > vector_pack<TypeParam>(TypeParam(0));
    EXPECT_EQ(some.bits(), 1U);
    EXPECT_TRUE(!all(some) && any(some) && !none(some));
}

}  // namespace
}  // namespace ccd::detail::one_by_one
