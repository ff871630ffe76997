// Relations of simplices, compared with their convex combinations: all simplices of the grid of
// side 3, and random, degenerate and badly scaled ones.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <errbound/simplices/common_segment.hpp>
#include <errbound/simplices/relation.hpp>
#include <map>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "tests/errbound/predicates/predicate_inputs.hpp"
#include "tests/errbound/predicates/predicate_oracle.hpp"
#include "tests/errbound/predicates/simplices_oracle.hpp"
#include "tests/support/scaled.hpp"

namespace {

using errbound::relation;
using predicate_inputs::between;
using predicate_inputs::generator;
using predicate_inputs::surface;

template <class T, std::size_t D, std::size_t K>
using element = std::array<std::array<T, D>, K>;

/// The vertices of two elements in a common unit.
template <class T, std::size_t D, std::size_t K, std::size_t L>
struct scaled_pair {
    int unit;
    simplices_oracle::points<D> a, b;

    scaled_pair(const element<T, D, K>& x, const element<T, D, L>& y) {
        std::array<std::array<T, D>, K + L> all;
        std::copy(y.begin(), y.end(), std::copy(x.begin(), x.end(), all.begin()));
        unit = predicate_oracle::common_unit(all);
        const auto scaled = predicate_oracle::scaled_points(all, unit);
        a.assign(scaled.begin(), scaled.begin() + K);
        b.assign(scaled.begin() + K, scaled.end());
    }
};

template <class T, std::size_t D, std::size_t K, std::size_t L>
std::string text_of(const element<T, D, K>& a, const element<T, D, L>& b) {
    return predicate_inputs::text_of<T, D, K>(a) + " |" + predicate_inputs::text_of<T, D, L>(b);
}

/// Both ends are within their errors of the intersection's ends, and the errors are small.
template <class T, std::size_t D, std::size_t K, std::size_t L>
void check_common_segment(const element<T, D, K>& a, const element<T, D, L>& b, int unit,
                          const std::vector<simplices_oracle::fraction_point<D>>& corners) {
    const auto ends = errbound::common_segment(a, b);
    ASSERT_FALSE(ends[1].position < ends[0].position);
    double largest = 0;
    for (const auto& p : a)
        for (const T x : p) largest = std::max(largest, std::abs(double(x)));
    for (const auto& p : b)
        for (const T x : p) largest = std::max(largest, std::abs(double(x)));
    const auto is_at = [&](const errbound::located_point<D>& p,
                           const simplices_oracle::fraction_point<D>& corner) {
        for (std::size_t k = 0; k < D; ++k) {
            // All in units of 2^low.
            const int low = std::min(unit, -1200);
            big_integer numerator = corner.numerators[k];
            numerator <<= unit - low;
            const big_integer distance =
                abs(numerator - big_integer(p.position[k], low) * corner.divisor);
            if (big_integer(p.error, low) * corner.divisor < distance) return false;
        }
        return true;
    };
    std::array<bool, 2> found{};
    for (const auto& corner : corners) {
        found[0] = found[0] || is_at(ends[0], corner);
        found[1] = found[1] || is_at(ends[1], corner);
        ASSERT_TRUE(is_at(ends[0], corner) || is_at(ends[1], corner)) << text_of(a, b);
    }
    ASSERT_TRUE(found[0] && found[1]) << text_of(a, b);
    for (const auto& end : ends)
        ASSERT_LE(end.error, 0x1p-44 * largest + 0x1p-1070) << text_of(a, b);
}

/// Counts of relations found.
using counts = std::map<relation, std::size_t>;

/// Compares the relation with convex combinations, in `orders` orders of vertices and of elements.
/// The first `common` vertices are the same.
template <class T, std::size_t D, std::size_t K, std::size_t L>
class checked_pair {
  public:
    checked_pair(const element<T, D, K>& a, const element<T, D, L>& b)
        : a_(a), b_(b), scaled_(a, b), right_(scaled_.a, scaled_.b) {}

    /// `order`: the common vertices are those with these indices in a and b.
    void check(counts& found, generator& random, int orders,
               const std::vector<std::array<std::size_t, 2>>& common = {}) const {
        simplices_oracle::points<D> shared;
        for (const auto& c : common) shared.push_back(scaled_.a[c[0]]);
        const relation right = right_.relation(shared);
        ++found[right];
        for (int k = 0; k < orders; ++k) {
            auto pairs = common;
            std::shuffle(pairs.begin(), pairs.end(), random);
            const auto x = reordered(a_, pairs, 0, random);
            const auto y = reordered(b_, pairs, 1, random);
            ASSERT_EQ(errbound::relation_of(x, y, common.size()), right)
                << text_of(x, y) << ", " << common.size() << " in common";
            ASSERT_EQ(errbound::relation_of(y, x, common.size()), right)
                << text_of(y, x) << ", " << common.size() << " in common";
            if constexpr (D == 3 || (K == 2 && L == 2))
                if (right == relation::crossing && k == 0)
                    check_common_segment(x, y, scaled_.unit, right_.corners());
        }
    }
    /// The same for each way in which vertices with equal coordinates may be common.
    void check_all_common(counts& found, generator& random, int orders) const {
        check(found, random, orders);
        std::vector<std::array<std::size_t, 2>> equal;
        for (std::size_t i = 0; i < K; ++i)
            for (std::size_t j = 0; j < L; ++j)
                if (a_[i] == b_[j]) equal.push_back({i, j});
        for (std::size_t m = 0; m < equal.size(); ++m) {
            if (K > 1 && L > 1) check(found, random, orders, {equal[m]});
            for (std::size_t n = 0; n < m; ++n)
                if (K > 2 && L > 2 && equal[m][0] != equal[n][0] && equal[m][1] != equal[n][1])
                    check(found, random, orders, {equal[m], equal[n]});
        }
    }

  private:
    template <std::size_t N>
    static element<T, D, N> reordered(const element<T, D, N>& s,
                                      const std::vector<std::array<std::size_t, 2>>& first,
                                      std::size_t side, generator& random) {
        std::array<std::size_t, N> order;
        for (std::size_t i = 0; i < N; ++i) order[i] = i;
        std::shuffle(order.begin(), order.end(), random);
        for (std::size_t k = 0; k < first.size(); ++k)
            std::swap(order[k], *std::find(order.begin(), order.end(), first[k][side]));
        element<T, D, N> r;
        for (std::size_t i = 0; i < N; ++i) r[i] = s[order[i]];
        return r;
    }

    const element<T, D, K>& a_;
    const element<T, D, L>& b_;
    scaled_pair<T, D, K, L> scaled_;
    simplices_oracle::meeting<D> right_;
};

/// All sets of K points of the grid of side 3, points repeated or not.
template <std::size_t D, std::size_t K>
std::vector<element<double, D, K>> grid_elements() {
    constexpr int size = D == 2 ? 9 : 27;
    const auto at = [](int i) {
        std::array<double, D> p;
        for (double& x : p) x = i % 3, i /= 3;
        return p;
    };
    std::vector<element<double, D, K>> all;
    std::array<int, K> index{};
    for (;;) {
        element<double, D, K> e;
        for (std::size_t k = 0; k < K; ++k) e[k] = at(index[k]);
        all.push_back(e);
        std::size_t k = 0;
        while (k < K && index[k] == size - 1) ++k;
        if (k == K) return all;
        ++index[k];
        std::fill_n(index.begin(), k, index[k]);
    }
}
/// One of each class that the grid's symmetries map to each other.
template <std::size_t D, std::size_t K>
std::vector<element<double, D, K>> grid_classes() {
    std::vector<element<double, D, K>> classes;
    std::set<element<double, D, K>> known;
    for (auto e : grid_elements<D, K>()) {
        std::sort(e.begin(), e.end());
        if (known.contains(e)) continue;
        classes.push_back(e);
        std::array<std::size_t, D> axes;
        for (std::size_t i = 0; i < D; ++i) axes[i] = i;
        do
            for (unsigned mirrored = 0; mirrored < 1U << D; ++mirrored) {
                auto image = e;
                for (std::size_t k = 0; k < K; ++k)
                    for (std::size_t i = 0; i < D; ++i)
                        image[k][i] = (mirrored >> i & 1) != 0 ? 2 - e[k][axes[i]] : e[k][axes[i]];
                std::sort(image.begin(), image.end());
                known.insert(image);
            }
        while (std::next_permutation(axes.begin(), axes.end()));
    }
    return classes;
}

/// Every pair, up to symmetry.
template <std::size_t D, std::size_t K, std::size_t L>
counts check_grid() {
    generator random(1);
    counts found;
    const auto all = grid_elements<D, L>();
    for (const auto& a : grid_classes<D, K>())
        for (const auto& b : all) {
            checked_pair<double, D, K, L>(a, b).check_all_common(found, random, 1);
            if (testing::Test::HasFatalFailure()) return found;
        }
    return found;
}

// Relations are constant expressions.
constexpr element<double, 3, 3> base{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}};
static_assert(errbound::relation_of(base,
                                    element<double, 3, 3>{{{1, 1, -1}, {1, 1, 1}, {3, 3, 1}}}) ==
              relation::crossing);
static_assert(errbound::relation_of(base, element<double, 3, 2>{{{0, 0, 0}, {1, 1, 0}}}, 1) ==
              relation::touching);
static_assert(
    errbound::relation_of(base, element<double, 3, 3>{{{0, 0, 0}, {4, 0, 0}, {1e200, -1e200, 0}}},
                          2) == relation::disjoint);

TEST(Grid, OfThePlane) {
    check_grid<2, 1, 1>();
    check_grid<2, 2, 1>();
    check_grid<2, 2, 2>();
    check_grid<2, 3, 1>();
    check_grid<2, 3, 2>();
    check_grid<2, 3, 3>();
}
TEST(Grid, OfSpace) {
    check_grid<3, 1, 1>();
    check_grid<3, 2, 1>();
    check_grid<3, 2, 2>();
    check_grid<3, 3, 1>();
    check_grid<3, 3, 2>();
    const counts found = check_grid<3, 3, 3>();
    EXPECT_EQ(found.size(), 4U);
}

/// Small integers, where points of b often are points of a, of its plane or of its lines; then each
/// axis times a power of two, down to subnormal numbers and up to overflowing products.
template <class T, std::size_t D>
element<T, D, 6> combined(generator& random, surface) {
    element<T, D, 6> p;
    const int most = between(random, 1, 7);
    for (auto& point : p)
        for (T& x : point) x = static_cast<T>(between(random, -most, most));
    for (std::size_t i = 2; i < 6; ++i) {
        if (random() % 3 == 0) continue;
        const auto &q = p[random() % i], &r = p[random() % i], &s = p[random() % i];
        const int along = between(random, -1, 2), across = between(random, -1, 2);
        for (std::size_t k = 0; k < D; ++k)
            p[i][k] = q[k] + T(along) * (r[k] - q[k]) + T(across) * (s[k] - q[k]);
    }
    using limits = std::numeric_limits<T>;
    std::array<int, D> exponents;
    const int all =
        between(random, limits::min_exponent - limits::digits, limits::max_exponent - 16);
    for (int& e : exponents)
        e = random() % 4 == 0
                ? between(random, limits::min_exponent - limits::digits, limits::max_exponent - 16)
                : all;
    for (auto& point : p)
        for (std::size_t k = 0; k < D; ++k) point[k] = std::ldexp(point[k], exponents[k]);
    return p;
}

/// Random elements, also with common vertices.
template <class T, std::size_t D, std::size_t K, std::size_t L>
void check_random(int count) {
    generator random(K + 4 * L + 16 * D + sizeof(T));
    counts found;
    const auto& families = predicate_inputs::families<T, D, 6>;
    for (int n = 0; n < count; ++n) {
        const std::size_t family = random() % (2 * families.size());
        const auto make = family < families.size() ? families[family].make : combined<T, D>;
        const auto p = make(random, random() % 2 == 0 ? surface::flat : surface::concurrent);
        element<T, D, K> a;
        element<T, D, L> b;
        std::copy_n(p.begin(), K, a.begin());
        std::copy_n(p.begin() + K, L, b.begin());
        const std::size_t common = random() % std::min(K, L);
        std::vector<std::array<std::size_t, 2>> pairs;
        for (std::size_t i = 0; i < common; ++i) b[i] = a[i], pairs.push_back({i, i});
        checked_pair<T, D, K, L>(a, b).check(found, random, 2, pairs);
        if (testing::Test::HasFatalFailure()) return;
    }
    if (count < 1000) return;
    // Points only touch; elements of different dimensions do not overlap.
    EXPECT_GT(found[relation::disjoint], 0U);
    EXPECT_GT(found[relation::touching] + found[relation::overlapping], 0U);
    EXPECT_EQ(found[relation::overlapping] > 0, K > 1 && L > 1) << K << L;
    EXPECT_EQ(found[relation::crossing] > 0, K + L >= D + 2) << K << L;
}

TEST(Random, ElementsOfSpace) {
    const int count = support::scaled(10000);
    check_random<double, 3, 3, 3>(4 * count);
    check_random<float, 3, 3, 3>(count);
    check_random<double, 3, 3, 2>(count);
    check_random<double, 3, 2, 2>(count / 2);
    check_random<double, 3, 3, 1>(count / 2);
    check_random<double, 3, 2, 1>(count / 4);
    check_random<double, 3, 1, 1>(count / 4);
}
TEST(Random, ElementsOfThePlane) {
    const int count = support::scaled(10000);
    check_random<double, 2, 2, 2>(count);
    check_random<float, 2, 2, 2>(count / 2);
    check_random<double, 2, 3, 3>(count / 2);
    check_random<double, 2, 3, 2>(count / 4);
    check_random<double, 2, 3, 1>(count / 4);
    check_random<double, 2, 2, 1>(count / 4);
    check_random<double, 2, 1, 1>(count / 4);
}

}  // namespace
