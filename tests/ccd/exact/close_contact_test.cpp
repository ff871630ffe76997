// Roots that nearly coincide, and coordinates of very different scales: integers without allocation
// decide them all, with the results of the reference.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <ccd/explain.hpp>
#include <ccd/reference.hpp>
#include <cmath>
#include <random>

#include "ccd/exact/axis_units.hpp"
#include "ccd/exact/integer_decision.hpp"
#include "ccd/exact/integers.hpp"
#include "ccd/exact/stages.hpp"

namespace {

using ccd::outcome;
using ccd::detail::extent_limit;
using ccd::detail::integer_units;

using numbers = std::array<double, 24>;

/// Small whole coordinates. Many do not move, so that roots often coincide. Up to three are changed
/// by about 2^-tiny.
numbers nearly_coincident(std::mt19937_64& random, int tiny) {
    const auto between = [&](int low, int high) {
        return low + static_cast<int>(random() % static_cast<unsigned>(high - low + 1));
    };
    const int range = between(1, 4);
    numbers x;
    for (double& c : x) c = between(-range, range);
    if (random() % 3 == 0)
        for (std::size_t p = 0; p < 24; p += 6)
            if (random() % 2 == 0) std::copy_n(x.begin() + p, 3, x.begin() + p + 3);
    for (int k = between(1, 3); k > 0; --k) {
        double& c = x[random() % 24];
        // Next to another number, changes are a few last places.
        const int exponent = c == 0 ? -tiny : std::max(-tiny, -50);
        c += std::ldexp(between(-3, 3), exponent);
    }
    return x;
}

template <class Query>
outcome in_words(const Query& query, const integer_units& units) {
    return units.bits() <= extent_limit(1) ? ccd::detail::decide_in_words<1>(query, units)
                                           : ccd::detail::decide_in_words<2>(query, units);
}

template <class Query>
class CloseContact : public testing::Test {};
using queries = testing::Types<ccd::vertex_face<double>, ccd::edge_edge<double>>;
TYPED_TEST_SUITE(CloseContact, queries);

/// Expects right decisions of `count` queries with few bits of difference that are hard(query,
/// units). Returns the number of contacts.
template <class Query, class Hard>
int expect_decided(unsigned seed, int count, int tiny, unsigned range, const Hard& hard) {
    std::mt19937_64 random(seed);
    int collided = 0;
    while (count > 0) {
        const auto query = std::bit_cast<Query>(
            nearly_coincident(random, tiny + static_cast<int>(random() % range)));
        if (!hard(query, integer_units(query))) continue;
        const outcome right = decide_reference(query).outcome;
        EXPECT_EQ(ccd::detail::decide_in_integers(query).outcome, right);
        --count;
        collided += right == outcome::collides;
    }
    return collided;
}

TYPED_TEST(CloseContact, OfRootsThatBracketsDoNotPartIsDecided) {
    EXPECT_GT(expect_decided<TypeParam>(7, 300, 20, 80,
                                        [](const TypeParam& query, const integer_units& units) {
                                            return units.bits() <= extent_limit(2) &&
                                                   in_words(query, units) == outcome::uncertain;
                                        }),
              10);
}

TYPED_TEST(CloseContact, OfScalesFarApartIsDecided) {
    EXPECT_GT(expect_decided<TypeParam>(8, 3000, 100, 150,
                                        [](const TypeParam&, const integer_units& units) {
                                            return units.bits() > extent_limit(2) &&
                                                   units.bits() <= extent_limit(4);
                                        }),
              100);
}

/// Once the slowest known query with coordinates of 1e-3 to 1e3: the reference took 0.2
/// milliseconds to separate two roots 2^-58 apart.
TEST(CloseRoots, ThatHillClimbingOnTimeBroughtTogetherNeedNoReference) {
    const numbers x{
        0x1.b91d6dea62386p-3,  -0x1.86dcd9b9da7p-9,   0x1.4fe353fc3d0e8p-2,  -0x1.a819fc0a5fe23p-2,
        -0x1.c0f8185a51a41p-1, -0x1.54be7b3eb6de4p-1, 0x1.49a3e9194b04bp-4,  -0x1.f1e771217d89p-3,
        -0x1.2d1459d36f8e9p-1, -0x1.5dd12cbad179ap-1, 0x1.0142f8b03ab6p-4,   -0x1.30dd90f3e22f7p-4,
        0x1.504b98116ef5ep-3,  -0x1.bcdf21231eb0fp-1, 0x1.6afb503859103p-3,  -0x1.25bcf00e180b2p-2,
        -0x1.2479f6ed084b4p-3, -0x1.d0620d55f0eb7p-2, -0x1.2ce6863fc6604p-2, -0x1.7f739fb9d164ep-1,
        0x1.2a23fadea2cbap-3,  -0x1.3c2d161cc6083p-4, 0x1.56c1854fcf038p-3,  -0x1.3e492b943031cp-1};
    ccd::stage_report report;
    const auto answer =
        ccd::detail::decide_with_integers(std::bit_cast<ccd::edge_edge<double>>(x), &report);
    EXPECT_EQ(answer.outcome, outcome::separate);
    EXPECT_EQ(report[ccd::stage::unbounded].entered, 0);
}

}  // namespace
