// Number types wider than double: facts about them, underflow without subnormal numbers, and
// conversions. validate_test runs random expressions of them under every rule.
#include <gtest/gtest.h>

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/multiprecision/mpfr.hpp>
#include <errbound/binary128.hpp>
#include <errbound/conversion.hpp>
#include <errbound/multiprecision.hpp>
#include <random>

#include "tests/support/long_double.hpp"
#include "tests/support/scaled.hpp"
#include "tests/support/special_values.hpp"

namespace {

namespace multiprecision = boost::multiprecision;
using errbound::number_traits;
using errbound::sign_type;
using errbound::tracked;

/// Sums that underflow have the lost part as an error, and x − x is certainly zero.
template <class T>
void check_underflow() {
    using number = tracked<T>;
    using traits = number_traits<T>;
    static_assert(!errbound::has_subnormals<T>);
    const T least = traits::underflow_unit(), next = least * (1 + traits::epsilon());
    const number lost = number(next) - number(least);
    EXPECT_GE(lost.error(), least);
    EXPECT_EQ(sign_of(lost), sign_type::uncertain);
    EXPECT_EQ(sign_of(number(next) - number(next)), sign_type::zero);
    EXPECT_EQ(sign_of(number(next) * number(next)), sign_type::uncertain);
    EXPECT_EQ(sign_of(scale(number(next), -1)), sign_type::uncertain);
    EXPECT_EQ(sign_of(number(T(8 * least)) + number(next)), sign_type::positive);
    const number nearly(traits::largest());
    EXPECT_EQ(sign_of(nearly + nearly), sign_type::uncertain);
    EXPECT_EQ(sign_of(nearly * nearly), sign_type::uncertain);
}
TEST(WideNumbers, SumsUnderflowWithoutSubnormalNumbers) {
    using bits_of_double = multiprecision::cpp_bin_float_double::backend_type;
    check_underflow<multiprecision::number<bits_of_double, multiprecision::et_off>>();
    check_underflow<multiprecision::number<bits_of_double, multiprecision::et_on>>();
    check_underflow<multiprecision::cpp_bin_float_quad>();
    check_underflow<multiprecision::cpp_bin_float_50>();
    check_underflow<multiprecision::mpfr_float_50>();
}

/// `less`: the difference between the standard's exponents and the type's.
template <class T>
void check_facts(int less = 0) {
    using traits = number_traits<T>;
    const T one = 1, u = traits::unit_roundoff();
    EXPECT_TRUE(T(one + traits::epsilon()) > one && T(one + u) == one);
    const T odd = one + traits::epsilon();
    EXPECT_TRUE(T(odd + u) > odd);  // a tie, to even
    EXPECT_EQ(traits::exponent(one), 1);
    EXPECT_EQ(traits::exponent(T(traits::epsilon())), 2 - traits::digits);
    EXPECT_EQ(traits::exponent(traits::smallest_normal()), traits::min_exponent + less);
    EXPECT_EQ(traits::exponent(traits::largest()), traits::max_exponent + less);
    EXPECT_FALSE(traits::is_finite(T(traits::largest() * 2)));
    EXPECT_TRUE(T(traits::scale(traits::underflow_unit(), -1)) == 0);
    EXPECT_TRUE(traits::scale(T(traits::scale(T(3), 100)), -100) == 3);
}
TEST(WideNumbers, TraitsAgreeWithTheTypes) {
    check_facts<support::long_double>();
    check_facts<errbound::float128>();
    check_facts<multiprecision::cpp_bin_float_double>(1);
    check_facts<multiprecision::cpp_bin_float_quad>(1);
    check_facts<multiprecision::cpp_bin_float_50>(1);
    check_facts<multiprecision::mpfr_float_50>();
}

TEST(WideNumbers, Binary128ScalesWithOneRounding) {
    using errbound::float128;
    using traits = number_traits<float128>;
    std::mt19937_64 random(3);
    for (int k = 0; k < support::scaled(500); ++k) {
        const float128 m =
            static_cast<float128>(random()) * 0x1p60 + static_cast<float128>(random() >> 5);
        const float128 x = traits::scale(m, static_cast<int>(random() % 30000) - 16000);
        if (!traits::is_finite(x)) continue;
        const int e = -16494 - traits::exponent(x) + static_cast<int>(random() % 130);
        const rational exact = exactly(x) * power_of(2, e);
        const float128 y = traits::scale(x, e);
        const rational off = multiprecision::abs(rational(exactly(y) - exact));
        const rational half = exactly(traits::underflow_unit()) / 2;
        ASSERT_LE(off, half) << e;
    }
}

TEST(WideNumbers, ConversionsHaveErrors) {
    using errbound::float128;
    const auto third = tracked<float128>(1) / tracked<float128>(3);
    const auto y = errbound::convert<double>(third);
    EXPECT_LE(multiprecision::abs(rational(exactly(y.value()) - rational(1, 3))),
              exactly(y.error()));
    EXPECT_LE(y.error(), 0x1p-54);
    EXPECT_EQ(sign_of(errbound::convert<float128>(y) - third), sign_type::uncertain);
    EXPECT_EQ(
        sign_of(errbound::convert<double>(tracked<float128>(number_traits<float128>::largest()))),
        sign_type::uncertain);
}

}  // namespace
