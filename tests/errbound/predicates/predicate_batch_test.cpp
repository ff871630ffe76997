// Batches of predicates have the signs of single calls.
#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <deque>
#include <errbound/predicate_batch.hpp>
#include <errbound/predicates.hpp>
#include <errbound/simplices/predicates.hpp>
#include <utility>
#include <vector>

#include "tests/errbound/predicates/predicate_inputs.hpp"

namespace {

using errbound::sign_type;
using predicate_inputs::surface;

template <class T, std::size_t D, class Predicate, std::size_t... I>
void compare_batch(const Predicate& predicate, surface s, std::index_sequence<I...>) {
    constexpr std::size_t N = sizeof...(I);
    predicate_inputs::generator random(3);
    for (const auto& family : predicate_inputs::families<T, D, N>) {
        const std::size_t count = 1000;  // not a whole number of blocks
        std::array<std::vector<std::array<T, D>>, N> points;
        std::array<std::array<std::vector<T>, D>, N> arrays;
        for (std::size_t i = 0; i < count; ++i) {
            const auto p = family.make(random, s);
            for (std::size_t k = 0; k < N; ++k) {
                points[k].push_back(p[k]);
                for (std::size_t d = 0; d < D; ++d) arrays[k][d].push_back(p[k][d]);
            }
        }
        const auto as_arrays = [&](std::size_t k) {
            errbound::coordinate_arrays<T, D> a{{}, count};
            for (std::size_t d = 0; d < D; ++d) a.coordinates[d] = arrays[k][d].data();
            return a;
        };
        std::vector<sign_type> one_by_one(count), batch(count), of_arrays(count);
        for (std::size_t i = 0; i < count; ++i) one_by_one[i] = predicate(points[I][i]...);
        errbound::batch_signs(predicate, batch, points[I]...);
        errbound::batch_signs(predicate, of_arrays, as_arrays(I)...);
        EXPECT_EQ(batch, one_by_one) << family.name;
        EXPECT_EQ(of_arrays, one_by_one) << family.name;
    }
}
template <class T>
class Batches : public testing::Test {};
using number_types = testing::Types<float, double>;
TYPED_TEST_SUITE(Batches, number_types);

TYPED_TEST(Batches, EqualSingleCalls) {
    using T = TypeParam;
    compare_batch<T, 2>(errbound::orient2d, surface::flat, std::make_index_sequence<3>());
    compare_batch<T, 3>(errbound::orient3d, surface::flat, std::make_index_sequence<4>());
    compare_batch<T, 2>(errbound::incircle, surface::round, std::make_index_sequence<4>());
    compare_batch<T, 3>(errbound::insphere, surface::round, std::make_index_sequence<5>());
    compare_batch<T, 3>(errbound::segments_intersect3d, surface::flat,
                        std::make_index_sequence<4>());
    compare_batch<T, 3>(errbound::triangle_intersects_triangle, surface::flat,
                        std::make_index_sequence<6>());
}

TEST(Batch, OfOnePointAgainstMany) {
    std::vector<std::array<double, 2>> points;
    for (int i = 0; i < 200; ++i) points.push_back({i * 0.5, 50.0 - i});
    std::vector<sign_type> signs(points.size());
    errbound::batch_signs(errbound::orient2d, signs, errbound::every<std::array<double, 2>>{{0, 0}},
                          errbound::every<std::array<double, 2>>{{1, 0}}, points);
    for (std::size_t i = 0; i < points.size(); ++i)
        EXPECT_EQ(signs[i], i < 50    ? sign_type::positive
                            : i == 50 ? sign_type::zero
                                      : sign_type::negative);
}
/// Points that are computed when they are read.
struct scaled_points {
    std::vector<std::array<double, 2>> points;
    double factor;
    std::array<double, 2> operator[](std::size_t i) const {
        return {factor * points[i][0], factor * points[i][1]};
    }
};
TEST(Batch, OfComputedPoints) {
    // Kernels with fused multiply-add also round the factor's products before they subtract: points
    // that coincide when rounded do so in the batch.
    predicate_inputs::generator random(3);
    scaled_points a{{}, 1 + 0x1.3p-20};
    std::vector<std::array<double, 2>> b, c;
    for (int i = 0; i < 6400; ++i) {
        a.points.push_back(
            {predicate_inputs::uniform<double>(random), predicate_inputs::uniform<double>(random)});
        b.push_back(a[static_cast<std::size_t>(i)]);
        c.push_back({predicate_inputs::uniform<double>(random), 0.5});
    }
    std::vector<sign_type> signs(b.size());
    errbound::batch_signs(errbound::orient2d, signs, a, b, c);
    for (std::size_t i = 0; i < signs.size(); ++i) {
        EXPECT_EQ(signs[i], sign_type::zero);
        EXPECT_EQ(errbound::orient2d(a[i], b[i], c[i]), sign_type::zero);
    }
}
TEST(Batch, OfRangesThatAreNotContiguous) {
    const std::deque<std::array<double, 2>> a(100, {0, 0}), b(100, {1, 0}), c(100, {0, 1});
    std::vector<sign_type> signs(a.size());
    errbound::batch_signs(errbound::orient2d, signs, a, b, c);
    for (const sign_type s : signs) EXPECT_EQ(s, sign_type::positive);
}

}  // namespace
