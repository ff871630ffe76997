// The components of the decisions in integers of fixed width, compared with their definitions.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <errbound/bernstein.hpp>
#include <errbound/integers/fixed_integer.hpp>
#include <random>

#include "ccd/exact/axis_units.hpp"
#include "ccd/exact/bounded_integer.hpp"
#include "ccd/exact/common_roots.hpp"
#include "ccd/exact/cubic_roots.hpp"

namespace {

using errbound::sign_type;
using errbound::integers::fixed_integer;

std::int64_t between(std::mt19937_64& random, std::int64_t low, std::int64_t high) {
    return low + static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(high - low + 1));
}

TEST(BoundedInteger, ErrorsStayWithinTheirBounds) {
    std::mt19937_64 random(1);
    for (int k = 0; k < 20000; ++k) {
        // The real number that each represents, and the number itself.
        std::array<std::int64_t, 4> real;
        std::array<ccd::detail::bounded_integer<fixed_integer<1>>, 4> x;
        for (std::size_t i = 0; i < 4; ++i) {
            const int size = static_cast<int>(random() % 28),
                      error = static_cast<int>(random() % 12);
            const std::int64_t value = between(random, -(1LL << size), 1LL << size);
            const std::int64_t off = (1LL << error) - 1;
            real[i] = value + between(random, -off, off);
            x[i] = {value, error};
            if (random() % 8 == 0) x[i] = {real[i]};
        }
        const auto found = x[0] * x[1] - x[2] * x[3];
        const std::int64_t right = real[0] * real[1] - real[2] * real[3];
        const auto error = (found.value - fixed_integer<2>(right)).low_word();
        if (found.error_bits < ccd::detail::bounded_integer<fixed_integer<2>>::exact / 2) {
            EXPECT_EQ(error, 0);
        } else {
            EXPECT_LT(std::abs(error), 1LL << found.error_bits);
        }
        const auto sign = sign_of(found);
        if (certain(sign)) {
            EXPECT_EQ(sign, sign_of(fixed_integer<1>(right)));
        }
    }
    EXPECT_EQ(sign_of(ccd::detail::bounded_integer<fixed_integer<1>>{0, -7}), sign_type::uncertain);
    EXPECT_EQ(sign_of(ccd::detail::bounded_integer<fixed_integer<1>>{0}), sign_type::zero);
    EXPECT_EQ(sign_of(ccd::detail::bounded_integer<fixed_integer<1>>{-8, 3}), sign_type::uncertain);
    EXPECT_EQ(sign_of(ccd::detail::bounded_integer<fixed_integer<1>>{-9, 3}), sign_type::negative);
}

TEST(CommonRoots, OfProductsOfLinearForms) {
    std::mt19937_64 random(2);
    using linear = ccd::detail::linear_form<1>;
    using kind = ccd::detail::common_roots<fixed_integer<2>>::kind_type;
    const auto any_linear = [&] {
        return linear{{between(random, -50, 50), between(random, -50, 50)}};
    };
    for (int k = 0; k < 5000; ++k) {
        const std::int64_t s = between(random, 1, 30), t = between(random, 1, 30);
        const linear vanishing{{-t, s}};  // zero at (s, t)
        std::array<ccd::detail::quadratic_form<2>, 3> f{
            {vanishing * any_linear(), vanishing * any_linear(), vanishing * any_linear()}};
        const ccd::detail::common_roots<fixed_integer<2>> roots(f);
        ASSERT_NE(roots.kind, kind::none);
        if (roots.kind == kind::one) {
            EXPECT_EQ(roots.squares[0] * fixed_integer<1>(t),
                      roots.squares[1] * fixed_integer<1>(s));
            EXPECT_EQ(roots.squares[1] * fixed_integer<1>(t),
                      roots.squares[2] * fixed_integer<1>(s));
        }
        const fixed_integer<2> nothing(0);
        f[2] = f[0] + f[0], f[1] = {{nothing, nothing, nothing}};
        EXPECT_EQ(ccd::detail::common_roots<fixed_integer<2>>(f).kind,
                  sign_inside(f[0]) == sign_type::zero ? kind::everywhere : kind::of_quadratic);
        f[0][1] = f[0][1] + fixed_integer<2>(1);  // no longer zero at (s, t), where f[2] is
        f[1] = linear{{-t, s}} * linear{{1, 1}};
        EXPECT_EQ(ccd::detail::common_roots<fixed_integer<2>>(f).kind, kind::none);
    }
}

TEST(CubicRoots, AreBracketedWithinAFewUnits) {
    std::mt19937_64 random(3);
    for (int k = 0; k < 5000; ++k) {
        ccd::detail::cubic_form<3> y;
        for (auto& h : y.h)
            h = fixed_integer<3>(between(random, -(1LL << 60), 1LL << 60))
                << static_cast<int>(random() % 60);
        const ccd::detail::inner_sign_changes changes(y);
        if (changes.count != 1) continue;
        ccd::detail::cubic_part<3> all{{}, changes, 0, 0};
        for (std::size_t i = 0; i < 4; ++i) all.y.h[i] = y.h[i];
        const auto bracket = bracket_near(y, all, estimated_place(all));
        ASSERT_TRUE(bracket.has_value());
        EXPECT_LE(bracket->low, bracket->high);
        if (bracket->is_root()) continue;
        const auto refined = bracket_near(y, all, refined_place(y, *bracket));
        ASSERT_TRUE(refined.has_value());
        EXPECT_GE(refined->bits, bracket->bits + 20);
        EXPECT_LE(refined->width(), 32);
        // Inside the first bracket, except for the few units of its widening.
        const auto slack = fixed_integer<2>(32);
        const int more = refined->bits - bracket->bits;
        EXPECT_GE(refined->low + slack, fixed_integer<2>(bracket->low) << more);
        EXPECT_LE(refined->high - slack, fixed_integer<2>(bracket->high) << more);
    }
}

TEST(CubicRoots, NoBracketDependsOnTheEstimate) {
    // Roots at 1/2, 1.1 and −7: signs beyond the end must not count.
    using linear = ccd::detail::linear_form<1>;
    const auto y = linear{{-1, 1}} * linear{{11, 1}} * linear{{7, 8}};
    const ccd::detail::inner_sign_changes changes(y);
    ASSERT_TRUE(changes.opposite);
    ccd::detail::cubic_part<3> all{{}, changes, 0, 0};
    for (std::size_t i = 0; i < 4; ++i) all.y.h[i] = y.h[i];
    constexpr int bits = 10;
    const fixed_integer<1> end(1 << bits);
    for (std::int64_t place = -4 << bits; place <= 8 << bits; ++place) {
        const auto bracket = bracket_near(y, all, ccd::detail::dyadic_point<1>{place, bits});
        ASSERT_TRUE(bracket.has_value());  // the widest bracket is the whole interval
        ASSERT_GE(bracket->low, 0);
        ASSERT_LE(bracket->low, 1 << (bits - 1));
        ASSERT_GE(bracket->high, 1 << (bits - 1));
        ASSERT_LE(bracket->high, end);
    }
}

}  // namespace
