// Predicates against rationals: every stage alone is right or uncertain, and all together are right,
// on inputs of all kinds and sizes. ERRBOUND_PREDICATE_INPUTS: inputs per predicate and family.
#include <gtest/gtest.h>

#include <array>
#include <boost/multiprecision/gmp.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <errbound/multiprecision.hpp>
#include <errbound/predicates.hpp>
#include <limits>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "predicate_inputs.hpp"

namespace {

using errbound::predicate_stage;
using errbound::sign_type;
using predicate_inputs::surface;
using rational = boost::multiprecision::number<boost::multiprecision::gmp_rational,
                                               boost::multiprecision::et_off>;

int inputs_per_family() {
    const char* const text = std::getenv("ERRBOUND_PREDICATE_INPUTS");
    return text == nullptr ? 4000 : std::atoi(text);
}

/// By Laplace expansion along the last column.
template <std::size_t N>
rational determinant(const std::array<std::array<rational, N>, N>& m) {
    if constexpr (N == 1) {
        return m[0][0];
    } else {
        rational sum = 0;
        for (std::size_t i = 0; i < N; ++i) {
            std::array<std::array<rational, N - 1>, N - 1> minor;
            for (std::size_t row = 0; row + 1 < N; ++row)
                for (std::size_t column = 0; column + 1 < N; ++column)
                    minor[row][column] = m[row < i ? row : row + 1][column];
            const rational term = m[i][N - 1] * determinant(minor);
            sum += (i + N - 1) % 2 == 0 ? term : rational(-term);
        }
        return sum;
    }
}

/// What the predicates are: determinants of the points' coordinates, for the round ones their
/// squared lengths, and 1. (The signs are those of the head of errbound/predicates.hpp.)
template <class T, std::size_t D, std::size_t N>
sign_type flat_sign(const predicate_inputs::points<T, D, N>& p) {
    std::array<std::array<rational, N>, N> m;
    for (std::size_t i = 0; i < N; ++i) {
        for (std::size_t k = 0; k < D; ++k) m[i][k] = p[i][k];
        m[i][D] = 1;
    }
    return errbound::sign_of(determinant(m));
}
template <class T, std::size_t D, std::size_t N>
sign_type round_sign(const predicate_inputs::points<T, D, N>& p) {
    std::array<std::array<rational, N>, N> m;
    for (std::size_t i = 0; i < N; ++i) {
        m[i][D] = 0;
        for (std::size_t k = 0; k < D; ++k) {
            m[i][k] = p[i][k];
            m[i][D] += m[i][k] * m[i][k];
        }
        m[i][D + 1] = 1;
    }
    return errbound::sign_of(determinant(m));
}

template <std::size_t D, std::size_t N, class T, class Predicate, class Exact>
void compare(const Predicate& predicate, const Exact& exact, surface s) {
    predicate_inputs::generator random(7);
    errbound::predicate_report report;
    std::uint64_t all = 0;
    for (const auto& family : predicate_inputs::families<T, D, N>)
        for (int i = 0; i < inputs_per_family(); ++i, ++all) {
            const auto p = family.make(random, s);
            const sign_type right = exact(p);
            std::apply(
                [&](const auto&... q) {
                    ASSERT_EQ(predicate(report, q...), right)
                        << family.name << ", input " << i;
                    for (std::size_t k = 0; k < errbound::predicate_stage_count; ++k) {
                        const auto stage = static_cast<predicate_stage>(k);
                        const sign_type found = predicate.by(stage, q...);
                        ASSERT_TRUE(found == right || found == sign_type::uncertain)
                            << family.name << ", input " << i << ", stage " << k;
                    }
                },
                p);
            if (testing::Test::HasFatalFailure()) return;
        }
    std::uint64_t decided = 0;
    for (const std::uint64_t n : report.decided) decided += n;
    EXPECT_EQ(decided, all);
    for (const auto stage : {predicate_stage::static_filter, predicate_stage::exact_doubles,
                             predicate_stage::short_integers,
                             predicate_stage::two_word_integers, predicate_stage::long_integers})
        EXPECT_GT(report[stage], 0u);
    if (Predicate::coordinate_bits(127) < 61) {
        EXPECT_GT(report[predicate_stage::word_integers], 0u);
    }
}

template <class T>
class Predicates : public testing::Test {};
using number_types = testing::Types<float, double>;
TYPED_TEST_SUITE(Predicates, number_types);

TYPED_TEST(Predicates, Orient2d) {
    compare<2, 3, TypeParam>(errbound::orient2d, flat_sign<TypeParam, 2, 3>, surface::flat);
}
TYPED_TEST(Predicates, Orient3d) {
    compare<3, 4, TypeParam>(errbound::orient3d, flat_sign<TypeParam, 3, 4>, surface::flat);
}
TYPED_TEST(Predicates, Incircle) {
    compare<2, 4, TypeParam>(errbound::incircle, round_sign<TypeParam, 2, 4>, surface::round);
}
TYPED_TEST(Predicates, Insphere) {
    compare<3, 5, TypeParam>(errbound::insphere, round_sign<TypeParam, 3, 5>, surface::round);
}

}  // namespace
