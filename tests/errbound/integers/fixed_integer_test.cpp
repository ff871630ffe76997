// Integers of fixed width compared with GMP's, modulo their width; and long integers.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <errbound/bernstein.hpp>
#include <errbound/integers/common_exponent.hpp>
#include <errbound/integers/fixed_integer.hpp>
#include <errbound/integers/long_integer.hpp>
#include <errbound/integers/sized_integer.hpp>
#include <errbound/multiprecision.hpp>
#include <random>
#include <utility>
#include <vector>

#include "tests/support/special_values.hpp"

namespace {

using errbound::sign_of;
using errbound::integers::fixed_integer;
using integer = whole_number;

template <class Number>
integer big(const Number& x, int words) {
    integer sum = 0;
    for (int i = words - 1; i >= 0; --i) sum = (sum << 64) + integer(x[i]);
    return x.negative() ? integer(sum - (integer(1) << (64 * words))) : sum;
}
template <int Words>
integer big(const fixed_integer<Words>& x) {
    return big(x, Words);
}
template <int Words>
integer big(const errbound::integers::long_integer<Words>& x) {
    return big(x, x.size());
}
/// 0, all ones, or a random number of any length.
std::uint64_t any_word(std::mt19937_64& random) {
    const auto pick = random() % 4;
    return pick == 0 ? 0 : pick == 1 ? ~std::uint64_t{0} : random() >> random() % 64;
}

/// x modulo 2^(64·Words), in the range of a two's complement number.
template <int Words>
integer wrapped(const integer& x) {
    const integer modulus = integer(1) << (64 * Words);
    integer r = x % modulus;
    if (r < 0) r += modulus;
    return r >= modulus / 2 ? integer(r - modulus) : r;
}

/// Extreme numbers, then numbers of random words.
template <int Words>
std::vector<fixed_integer<Words>> samples(std::mt19937_64& random) {
    using number = fixed_integer<Words>;
    std::vector<number> all{0, 1, -1, 2, -2, INT64_MAX, INT64_MIN};
    const number least = number::shifted(1, 64 * Words - 1);
    all.insert(all.end(), {least, least + 1, least - 1, number::shifted(1, 64 * Words - 2)});
    for (int k = 0; k < 40; ++k) {
        std::array<std::uint64_t, Words> w;
        for (auto& word : w) word = any_word(random);
        all.push_back(number::from_words(w));
    }
    return all;
}

template <int Words>
void check_one_width(std::mt19937_64& random) {
    const auto all = samples<Words>(random);
    for (const auto& a : all) {
        const integer x = big(a);
        EXPECT_EQ(big(-a), wrapped<Words>(-x));
        EXPECT_EQ(big(fixed_integer<Words + 2>(a)), x);
        EXPECT_EQ(sign_of(a), sign_of(x));
        EXPECT_EQ(a.negative(), x < 0);
        const integer size = x < 0 ? integer(-x - 1) : x;
        EXPECT_EQ(a.bit_length(), size == 0 ? 0 : static_cast<int>(msb(size)) + 1);
        for (const int shift : {0, 1, 63, 64, 100, 64 * Words - 1, 64 * Words + 70}) {
            const integer floor = x < 0 ? integer(-((-x - 1) >> shift) - 1) : integer(x >> shift);
            EXPECT_EQ(big(a.template from_bit<1>(shift)), wrapped<1>(floor)) << x << " " << shift;
            EXPECT_EQ(big(a.template from_bit<3>(shift)), wrapped<3>(floor)) << x << " " << shift;
        }
        for (const int bits : {0, 1, 7, 63}) {
            EXPECT_EQ(big(a << bits), wrapped<Words>(x << bits));
            EXPECT_EQ(big(scale(a, bits)), wrapped<Words>(x << bits));
        }
        for (const auto& b : all) {
            const integer y = big(b);
            ASSERT_EQ(big(a + b), wrapped<Words>(x + y)) << x << " " << y;
            ASSERT_EQ(big(a - b), wrapped<Words>(x - y)) << x << " " << y;
            ASSERT_EQ(a == b, x == y);
            ASSERT_EQ(a < b, x < y);
            ASSERT_EQ(a >= b, x >= y);
        }
    }
    for (const std::int64_t v : {std::int64_t{0}, INT64_MIN, INT64_MAX, std::int64_t{-5}})
        EXPECT_EQ(big(fixed_integer<Words>(v)), integer(v));
    for (int shift = 0; shift < 64 * Words + 130; ++shift) {
        const std::uint64_t size = random() >> random() % 64;
        EXPECT_EQ(big(fixed_integer<Words>::shifted(size, shift)),
                  wrapped<Words>(integer(size) << shift));
    }
}

template <int A, int B>
void check_products(std::mt19937_64& random) {
    for (const auto& a : samples<A>(random))
        for (const auto& b : samples<B>(random)) {
            static_assert(std::is_same_v<decltype(a * b), fixed_integer<A + B>>);
            ASSERT_EQ(big(a * b), big(a) * big(b)) << A << " by " << B << " words";
        }
}

template <int... Widths>
void check_all(std::mt19937_64& random, std::integer_sequence<int, Widths...>) {
    (check_one_width<Widths + 1>(random), ...);
    (check_products<1, Widths + 1>(random), ...);
    (check_products<2, Widths + 1>(random), ...);
    (check_products<4, Widths + 1>(random), ...);
    (check_products<Widths + 1, 3>(random), ...);
    (check_products<Widths + 1, Widths + 1>(random), ...);
}

#ifdef __SIZEOF_INT128__
TEST(TwoWords, AgreeWithTheCompilersIntegersOf128Bits) {
    using errbound::integers::words::two_words;
    __extension__ using wide = unsigned __int128;
    std::mt19937_64 random(5);
    const auto word = [&random] { return any_word(random); };
    const auto same = [](const two_words& x, wide y) {
        return static_cast<std::uint64_t>(x) == static_cast<std::uint64_t>(y) &&
               static_cast<std::uint64_t>(x >> 64) == static_cast<std::uint64_t>(y >> 64);
    };
    for (int i = 0; i < 100'000; ++i) {
        const std::uint64_t a = word(), b = word(), c = word(), d = word(), e = word();
        const two_words x = two_words(a) * b + c, y = two_words(d) * e;
        const wide x_right = wide(a) * b + c, y_right = wide(d) * e;
        ASSERT_TRUE(same(x, x_right)) << a << ' ' << b << ' ' << c;
        ASSERT_TRUE(same(x + y, x_right + y_right));
        ASSERT_TRUE(same(x - y, x_right - y_right));
        ASSERT_TRUE(same(x * y, x_right * y_right));
        const std::uint64_t p = (word() >> 1) | 1;
        ASSERT_TRUE(same(x % p, x_right % p)) << p;
    }
}
#endif

TEST(FixedInteger, OperationsAgreeWithGmpModuloTheWidth) {
    std::mt19937_64 random(1);
    check_all(random, std::make_integer_sequence<int, 13>());
    // The widths of roots of a query's forms at 1 and 2 words (ccd/exact/interior_contact.hpp).
    check_products<10, 6>(random);
    check_products<16, 6>(random);
    check_products<22, 6>(random);
    check_products<44, 12>(random);
    check_one_width<28>(random);
}

TEST(FixedInteger, AreConstantExpressions) {
    constexpr fixed_integer<2> a = fixed_integer<2>::shifted(3, 100), b = -5;
    static_assert(sign_of(a * b) == errbound::sign_type::negative);
    static_assert((a + b) - a == b);
    static_assert(b.bit_length() == 3);
    EXPECT_EQ(big(a * b), integer(-15) << 100);
}

TEST(FixedInteger, PolynomialsGrowByTheirFactorsWidths) {
    std::mt19937_64 random(1);
    using errbound::bernstein;
    for (int k = 0; k < 200; ++k) {
        // Spare bits for the sums.
        const auto coefficient = [&] {
            return static_cast<std::int64_t>(random()) >> (4 + random() % 60);
        };
        bernstein<fixed_integer<1>, 2> p;
        bernstein<integer, 2> big_p;
        bernstein<fixed_integer<1>, 1> q;
        bernstein<integer, 1> big_q;
        for (int i = 0; i <= 2; ++i) big_p[i] = big(p[i] = coefficient());
        for (int i = 0; i <= 1; ++i) big_q[i] = big(q[i] = coefficient());
        const auto product = p * q;
        static_assert(std::is_same_v<decltype(product), const bernstein<fixed_integer<2>, 3>>);
        const auto big_product = big_p * big_q;
        for (int i = 0; i <= 3; ++i) EXPECT_EQ(big(product[i]), big_product[i]);
        const fixed_integer<2> s = coefficient(), t = coefficient();
        const auto value = value_at(p, s, t);
        static_assert(std::is_same_v<decltype(value), const fixed_integer<5>>);
        EXPECT_EQ(big(value), value_at(big_p, big(s), big(t)));
        EXPECT_EQ(sign_inside(product), sign_inside(big_product));
    }
}

/// The bits of a double at any position, or sums of up to three.
errbound::integers::long_integer<20> any_long(std::mt19937_64& random) {
    using number = errbound::integers::long_integer<20>;
    const auto one = [&] {
        return number(random() >> random() % 64, static_cast<int>(random() % 1100),
                      random() % 2 == 0);
    };
    const number first = one(), second = one(), third = one();
    switch (random() % 4) {
        case 0:
            return first;
        case 1:
            return number::difference(first, second);
        case 2:
            return number(static_cast<std::int64_t>(random() % 5) - 2);
        default:
            return number::sum(number::sum(first, second), third);
    }
}

/// Coordinates of up to 127 bits: two words, or the compiler's integers of 128.
TEST(SizedIntegers, CoordinatesOfTwoWordsAreConverted) {
    using namespace errbound::integers;
    using level = integer_level<integer_kind::words, 127, false>;
    std::mt19937_64 random(7);
    for (int i = 0; i < 10'000; ++i) {
        std::array<double, 2> x;
        for (double& c : x)
            c = std::ldexp(static_cast<double>(static_cast<std::int64_t>(random()) >> 11),
                           static_cast<int>(random() % 75));
        const common_unit unit(x);
        for (const double c : x) {
            const binary_double parts(c);
            integer right = integer(parts.magnitude);
            const int shift = parts.exponent - unit.unit;
            right = shift < 0 ? integer(right >> -shift) : integer(right << shift);
            EXPECT_EQ(big(as_fixed(unit.converted<level>(c).value)),
                      parts.negative ? -right : right)
                << c;
        }
    }
}

TEST(LongIntegers, AgreeWithGmp) {
    std::mt19937_64 random(11);
    for (int k = 0; k < 100'000; ++k) {
        const auto a = any_long(random), b = any_long(random);
        const integer x = big(a), y = big(b);
        using product = errbound::integers::long_integer<40>;
        const auto ab = product::product(a, b);
        ASSERT_EQ(big(ab), x * y);
        using result = errbound::integers::long_integer<60>;
        const auto more = result::product(product::sum(ab, a), b);
        ASSERT_EQ(big(more), (x * y + x) * y);
        ASSERT_EQ(big(result::difference(more, ab)), (x * y + x) * y - x * y);
        ASSERT_EQ(sign_of(ab), sign_of(integer(x * y)));
        ASSERT_EQ(big(a * b), x * y);
        ASSERT_EQ(a == b, x == y);
        if (a.size() < 20) {
            ASSERT_EQ(big(-a), -x);
        }
        const int shift = static_cast<int>(random() % 1000);
        ASSERT_EQ(big(result(ab) << shift), x * y << shift);
        const int length = ab.bit_length();
        ASSERT_LT(x * y, integer(1) << length);
        ASSERT_GE(x * y, -(integer(1) << length));
        ASSERT_TRUE(length == 0 || x * y >= integer(1) << (length - 1) ||
                    x * y < -(integer(1) << (length - 1)));
        const int from = length > 63 ? length - 63 : 0;
        // Boost's shift of a negative number rounds down, too.
        ASSERT_EQ(integer(ab.word_from_bit(from)), x * y >> from);
    }
}

}  // namespace
