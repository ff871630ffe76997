// Number types wider than double under the rules that support them, compared with rationals in
// random programs.
#include <gtest/gtest.h>

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/multiprecision/mpfr.hpp>
#include <errbound/binary128.hpp>
#include <errbound/conversion.hpp>
#include <errbound/functions.hpp>
#include <errbound/multiprecision.hpp>
#include <errbound/rules/affine.hpp>
#include <errbound/rules/relative.hpp>
#include <random>

#include "tests/support/long_double.hpp"
#include "tests/support/random_programs.hpp"
#include "tests/support/scaled.hpp"

namespace {

namespace multiprecision = boost::multiprecision;
using errbound::number_traits;
using errbound::sign_type;
using errbound::tracked;
/// Numbers with few bits or all bits. The numbers of one program are ordinary, about to underflow
/// or about to overflow; `Reach` > 0 limits the exponents.
template <class T, int Reach>
class edge_numbers {
    using traits = number_traits<T>;

  public:
    T operator()(std::mt19937_64& random) {
        if (drawn_++ % 32 == 0) scale_ = static_cast<int>(random() % 3);
        if (random() % 16 == 0) return T(0);
        T m = T(static_cast<int>(random() % 15) + 1);
        if (random() % 3 != 0)
            for (int bits = 0; bits < traits::digits; bits += 28)
                m = traits::scale(m, 28) + T(static_cast<int>(random() >> 36));
        m = traits::scale(m, -traits::exponent(m));
        constexpr int least = Reach > 0 ? -Reach : traits::min_exponent;
        constexpr int most = Reach > 0 ? Reach : traits::max_exponent;
        const auto near = [&](int e, int spread) {
            return e + static_cast<int>(random() % static_cast<unsigned>(2 * spread + 1)) - spread;
        };
        int e = near(0, 4);
        if (scale_ == 1 && random() % 3 != 0)
            e = random() % 2 ? std::max(near(least, traits::digits), least - traits::digits + 2)
                             : near(least / 2, traits::digits);
        if (scale_ == 2 && random() % 3 != 0)
            e = random() % 2 ? std::min(near(most, 3), most) : near(most / 2, 2);
        const T x = traits::scale(m, e);
        return random() % 2 ? x : T(-x);
    }

  private:
    int drawn_ = 0, scale_ = 0;
};

template <class T, int Reach = 0, class... Rules>
void check_rules(int count) {
    using draw = edge_numbers<T, Reach>;
    (support::random_programs<T, Rules, draw>(7, draw()).run(support::scaled(count)), ...);
}

TEST(WideNumbers, LongDoubleUnderEveryRule) {
    using namespace errbound;
    check_rules<support::long_double, 0, tight, sharp, safe, interval, residual, affine, relative>(
        300);
}
TEST(WideNumbers, Binary128UnderEveryRule) {
    using namespace errbound;
    check_rules<float128, 0, tight, sharp, safe, interval, residual, affine, relative>(300);
}

// A type with double's bits and exponents underflows as often as double, but has no subnormal
// numbers. The others have more bits, or exponents that are too long for rationals.
TEST(WideNumbers, BoostsBinaryFloatsUnderTight) {
    using errbound::tight;
    using multiprecision::et_off;
    using multiprecision::et_on;
    using bits_of_double = multiprecision::cpp_bin_float_double::backend_type;
    check_rules<multiprecision::number<bits_of_double, et_off>, 0, tight>(4000);
    check_rules<multiprecision::number<bits_of_double, et_on>, 0, tight>(4000);
    check_rules<multiprecision::cpp_bin_float_quad, 0, tight>(300);
    check_rules<multiprecision::cpp_bin_float_50, 200, tight>(2000);
}
TEST(WideNumbers, BoostsMpfrUnderTight) {
    check_rules<multiprecision::mpfr_float_50, 200, errbound::tight>(2000);
    check_rules<
        multiprecision::number<multiprecision::mpfr_float_backend<100>, multiprecision::et_off>,
        200, errbound::tight>(1000);
}

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
    check_underflow<multiprecision::cpp_bin_float_double>();
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
