// errbound::integer against GMP's integers: on random numbers, and on numbers of zeros and ones
// that carries run through. Quotients whose digits are guessed too large are made: random numbers
// meet them once in 2^64.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <errbound/integers/integer.hpp>
#include <limits>
#include <new>
#include <random>
#include <sstream>
#include <stdexcept>
#include <utility>
#include <vector>

#include "tests/support/special_values.hpp"

namespace {

using errbound::integer;
using word = std::uint64_t;
using truth = whole_number;

truth big(const integer& x) {
    return x < 0 ? truth(-truth("0x" + to_string(-x, 16))) : truth("0x" + to_string(x, 16));
}
integer own(const truth& x) {
    const truth size = abs(x);
    const integer found = integer::from_string(size.str(0, std::ios_base::hex), 16);
    return x < 0 ? -found : found;
}

/// Zeros, ones, single bits and random words alike.
class source {
  public:
    explicit source(word seed) : random_(seed) {}

    word any_word() {
        const word bits = random_();
        switch (random_() % 6) {
            case 0:
                return 0;
            case 1:
                return ~word(0);
            case 2:
                return word(1) << bits % 64;
            case 3:
                return bits >> bits % 64;
            default:
                return bits;
        }
    }
    int below(int n) { return static_cast<int>(random_() % static_cast<word>(n)); }
    truth of_words(int size, bool random_words) {
        truth x = 0;
        for (int i = 0; i < size; ++i) x = (x << 64) + (random_words ? random_() : any_word());
        return below(2) == 0 ? x : truth(-x);
    }
    /// Mostly of few words.
    truth any() {
        const int size = below(8) == 0 ? below(90) : below(7);
        const truth x = of_words(size, below(3) == 0);
        return below(8) == 0 ? truth((truth(1) << 64 * size) - below(2)) : x;
    }

  private:
    std::mt19937_64 random_;
};

/// True if x has the expected value and the same representation as that number made otherwise.
::testing::AssertionResult is(const integer& x, const truth& expected) {
    if (big(x) == expected && x == own(expected)) return ::testing::AssertionSuccess();
    return ::testing::AssertionFailure() << x << " instead of " << expected.str();
}

void check_operators(const truth& x, const truth& y) {
    const integer a = own(x), b = own(y);
    ASSERT_TRUE(is(a, x));
    ASSERT_TRUE(is(a + b, x + y));
    ASSERT_TRUE(is(a - b, x - y));
    ASSERT_TRUE(is(integer(a) + b, x + y));
    ASSERT_TRUE(is(integer(a) - b, x - y));
    ASSERT_TRUE(is(a * b, x * y));
    ASSERT_TRUE(is(-a, -x));
    ASSERT_TRUE(is(abs(a), abs(x)));
    ASSERT_TRUE(is(gcd(a, b), gcd(x, y)));
    ASSERT_TRUE(is(lcm(a, b), lcm(x, y)));
    ASSERT_EQ(a == b, x == y);
    ASSERT_EQ(a < b, x < y);
    ASSERT_EQ(a > b, x > y);
    ASSERT_EQ(a <= b, x <= y);
    ASSERT_EQ(sign_of(a), x > 0   ? errbound::sign_type::positive
                          : x < 0 ? errbound::sign_type::negative
                                  : errbound::sign_type::zero);
    if (y == 0) return;
    ASSERT_TRUE(is(a / b, x / y));
    ASSERT_TRUE(is(a % b, x % y));
    ASSERT_EQ(msb(b), static_cast<int>(msb(abs(y))));
    ASSERT_EQ(lsb(b), static_cast<int>(lsb(abs(y))));
}

/// Results that replace an operand, or a number that has memory already.
void check_in_place(const truth& x, const truth& y) {
    const integer a = own(x), b = own(y);
    const auto changed = [](integer x, const auto& change) {
        change(x);
        return x;
    };
    ASSERT_TRUE(is(changed(a, [&](integer& c) { c += b; }), x + y));
    ASSERT_TRUE(is(changed(a, [&](integer& c) { c -= b; }), x - y));
    ASSERT_TRUE(is(changed(a, [&](integer& c) { c *= b; }), x * y));
    ASSERT_TRUE(is(changed(a, [](integer& c) { c += c; }), x + x));
    ASSERT_TRUE(is(changed(a, [](integer& c) { c -= c; }), 0));
    ASSERT_TRUE(is(changed(a, [](integer& c) { c *= c; }), x * x));
    ASSERT_TRUE(is(changed(a, [](integer& c) { c = *&c; }), x));
    ASSERT_TRUE(is(changed(a, [](integer& c) { c = std::move(*&c); }), x));
    ASSERT_TRUE(is(changed(a, [&](integer& c) { c = b; }), y));
    ASSERT_TRUE(is(changed(a, [&](integer& c) { c = b + c; }), x + y));
    ASSERT_TRUE(is(changed(a, [](integer& c) { ++c; }), x + 1));
    ASSERT_TRUE(is(changed(a, [](integer& c) { --c; }), x - 1));
    if (y != 0) {
        ASSERT_TRUE(is(changed(a, [&](integer& c) { c /= b; }), x / y));
        ASSERT_TRUE(is(changed(a, [&](integer& c) { c %= b; }), x % y));
        ASSERT_TRUE(is(changed(b, [&](integer& c) { c = a / c; }), x / y));
        ASSERT_TRUE(is(changed(b, [](integer& c) { c /= c; }), 1));
        ASSERT_TRUE(is(changed(b, [](integer& c) { c %= c; }), 0));
    }
    integer from = a, to = b;
    to = std::move(from);
    ASSERT_TRUE(is(to, x));
    ASSERT_TRUE(is(from, 0));  // NOLINT(bugprone-use-after-move): the type promises it
    std::swap(from, to);
    ASSERT_TRUE(is(from, x));
}

void check_shifts(const truth& x, int n) {
    const integer a = own(x);
    const truth up = x << n;
    // ⌊x/2^n⌋
    const truth down = x < 0 ? truth(-((-x - 1) >> n) - 1) : truth(x >> n);
    ASSERT_TRUE(is(a << n, up)) << n;
    ASSERT_TRUE(is(a >> static_cast<unsigned>(n), down)) << x << " " << n;
    ASSERT_TRUE(is(integer(a) >> n, down)) << n;
    ASSERT_TRUE(is(scale(a, n), up)) << n;
    integer b = a;
    b <<= static_cast<std::size_t>(n);
    ASSERT_TRUE(is(b, up)) << n;
    b >>= n;
    ASSERT_TRUE(is(b, x)) << n;
    b >>= n;
    ASSERT_TRUE(is(b, down)) << n;
}

TEST(Integer, OperationsAgreeWithGmp) {
    source random(1);
    for (int k = 0; k < 6000 && !HasFatalFailure(); ++k) {
        const truth x = random.any(), y = random.below(16) == 0 ? x : random.any();
        check_operators(x, y);
        check_in_place(x, y);
        check_shifts(x, random.below(3) == 0 ? 64 * random.below(5) : random.below(300));
    }
}

TEST(Integer, EveryPairOfSmallNumbers) {
    std::vector<truth> all;
    for (const int power :
         {0, 1, 31, 32, 52, 53, 62, 63, 64, 65, 127, 128, 129, 191, 192, 255, 256})
        for (const int more : {-2, -1, 0, 1, 2})
            for (const int sign : {-1, 1}) all.push_back(sign * ((truth(1) << power) + more));
    for (const truth& x : all)
        for (const truth& y : all) {
            check_operators(x, y);
            check_in_place(x, y);
            if (HasFatalFailure()) return;
        }
    for (const truth& x : all)
        for (int n = 0; n < 260; ++n) check_shifts(x, n);
}

/// Products of all sizes around those where the algorithm changes, of numbers with and without runs
/// of zeros.
TEST(Integer, LongProducts) {
    source random(2);
    const int k = errbound::integers::words::karatsuba_words;
    std::vector<int> sizes{1,         7,     k - 1,     k,         k + 1,
                           2 * k - 1, 2 * k, 2 * k + 1, 3 * k + 5, 5 * k - 2};
    for (int i = 0; i < 6; ++i) sizes.push_back(1 + random.below(12 * k));
    for (const int m : sizes)
        for (const int n : sizes)
            for (const bool whole : {true, false}) {
                const truth x = random.of_words(m, whole), y = random.of_words(n, whole);
                ASSERT_TRUE(is(own(x) * own(y), x * y)) << m << " by " << n << " words";
                const truth ones = (truth(1) << 64 * m) - 1, hollow = x << 64 * n;
                ASSERT_TRUE(is(own(ones) * own(y), ones * y)) << m << " by " << n << " words";
                ASSERT_TRUE(is(own(hollow) * own(y + hollow), hollow * (y + hollow)));
            }
}

TEST(Integer, ThousandsOfWords) {
    source random(3);
    for (int k = 0; k < 3; ++k) {
        const truth x = random.of_words(1000 + random.below(3000), k != 0),
                    y = random.of_words(1000 + random.below(1000), true);
        check_operators(x, y);
        check_shifts(x, random.below(100'000));
        ASSERT_EQ(own(y), integer::from_string(y.str()));
        ASSERT_EQ(to_string(own(y)), y.str());
    }
}

/// a/d, where the first two words of d go into a exactly q times. The rest of d makes the quotient
/// one less.
TEST(Integer, QuotientsOfDigitsGuessedTooLarge) {
    source random(4);
    int tried = 0;
    for (int k = 0; k < 20'000; ++k) {
        const int more = 1 + random.below(5);
        const truth first = (truth(random.any_word() | word(1) << 63) << 64) + random.any_word();
        const truth below =
            (truth(1) << 64 * more) - 1 - (random.below(2) == 0 ? 0 : random.below(9));
        const truth d = (first << 64 * more) + below;
        const truth q = truth(random.any_word()) + 1;
        const truth a = ((q * first) << 64 * more) + (random.below(2) == 0 ? 0 : random.any_word());
        tried += a / d == q - 1;
        // The same as a later digit of a longer quotient, and shifted.
        const int shift = random.below(64);
        const truth longer = ((d * random.any_word()) << 64) + a;
        ASSERT_TRUE(is(own(a) / own(d), a / d));
        ASSERT_TRUE(is(own(a) % own(d), a % d));
        ASSERT_TRUE(is(own(longer) / own(d), longer / d));
        ASSERT_TRUE(is(own(a >> shift) / own(d >> shift), (a >> shift) / (d >> shift)));
        ASSERT_TRUE(is(own(a - 1) % own(d), (a - 1) % d));
        // Just below and at a multiple.
        const truth multiple = d * q;
        ASSERT_TRUE(is(own(multiple) / own(d), q));
        ASSERT_TRUE(is(own(multiple - 1) / own(d), q - 1));
        ASSERT_TRUE(is(own((d << 64) - 1) / own(d), ~word(0)));
    }
    EXPECT_GT(tried, 10'000);
}

TEST(Integer, QuotientsOfTwoAndThreeWords) {
    namespace words = errbound::integers::words;
    source random(5);
    const truth base = truth(1) << 64;
    const auto edge = [&random](word x) {
        return x - word(2) + static_cast<word>(random.below(5));
    };
    for (int k = 0; k < 200'000; ++k) {
        const word high = random.any_word() | word(1) << 63,
                   low = random.below(4) == 0 ? edge(high) : random.any_word();
        const word v = words::reciprocal(high);
        ASSERT_EQ(truth(v), (base * base - 1) / high - base);
        const truth d = truth(high) * base + low;
        const words::two_word_divisor divisor(high, low);
        // Any dividend below d, or one next to d.
        const word a2 = random.below(3) == 0 ? high : random.any_word() % high;
        const word a1 = a2 < high    ? random.any_word()
                        : low == 0   ? 0
                        : k % 2 == 0 ? low
                                     : random.any_word() % low;
        const word a0 = random.any_word();
        if (truth(a2) * base + a1 > d) continue;
        const truth a = (truth(a2) * base + a1) * base + a0;
        ASSERT_EQ(truth(divisor.quotient(a2, a1, a0)), std::min(truth(a / d), truth(base - 1)))
            << a2 << ' ' << a1 << ' ' << a0 << " by " << high << ' ' << low;
        if (a2 == high) continue;
        word rest = a2;
        const word q = words::divide_two_words(rest, a1, high, v);
        ASSERT_EQ(truth(q) * high + rest, truth(a2) * base + a1);
        ASSERT_LT(rest, high);
    }
}

TEST(Integer, CommonDivisors) {
    source random(6);
    // Neighbours among Fibonacci's numbers take most steps, all by 1.
    truth x = 1, y = 1;
    for (int k = 0; k < 1500; ++k) {
        x = std::exchange(y, x + y);
        ASSERT_EQ(gcd(own(x), own(y)), 1);
        ASSERT_TRUE(is(gcd(own(x * 12), own(y * 18)), gcd(truth(x * 12), truth(y * 18))));
    }
    for (int k = 0; k < 3000; ++k) {
        const truth common = random.any(), a = common * random.any(), b = common * random.any();
        ASSERT_TRUE(is(gcd(own(a), own(b)), gcd(a, b))) << a << ' ' << b;
    }
}

template <class T>
void check_built_in() {
    using limits = std::numeric_limits<T>;
    source random(7);
    std::vector<T> all{0, 1, limits::min(), limits::max(), static_cast<T>(limits::max() - 1)};
    if (std::is_signed_v<T>) all.push_back(static_cast<T>(-1));
    for (int k = 0; k < 50; ++k) all.push_back(static_cast<T>(random.any_word()));
    for (const T x : all) {
        const integer a = x;
        ASSERT_TRUE(is(a, truth(x)));
        ASSERT_EQ(static_cast<T>(a), x);
        ASSERT_EQ(static_cast<T>(a + (integer(1) << 64U)), x);
        ASSERT_EQ(static_cast<T>(a - (integer(5) << 200U)), x);
        for (const T y : all) {
            ASSERT_EQ(a == y, x == y);
            ASSERT_EQ(a < y, x < y);
            ASSERT_EQ(y < a, y < x);
            ASSERT_LT(a, (integer(1) << 64U) + y + 1 + (integer(1) << 70U));
        }
    }
}
template <class... T>
void check_all_built_in() {
    (check_built_in<T>(), ...);
}
TEST(Integer, BuiltInIntegers) {
    check_all_built_in<signed char, unsigned char, short, unsigned short, int, unsigned, long,
                       unsigned long, long long, unsigned long long>();
    EXPECT_EQ(integer(true), 1);
    EXPECT_TRUE(static_cast<bool>(integer(2) << 64U));
    EXPECT_FALSE(static_cast<bool>(integer(0)));
}

/// The distance of the double from x is at most half an ulp; if it is half, the double is even.
void check_nearest(const truth& x) {
    const double d = static_cast<double>(own(x));
    ASSERT_TRUE(std::isfinite(d));
    const double next = std::nextafter(d, x < truth(d) ? -INFINITY : INFINITY);
    const truth away = abs(truth(x - truth(d)));
    if (std::isfinite(next)) {
        const truth other = abs(truth(x - truth(next)));
        ASSERT_LE(away, other) << x;
        if (away == other && d != 0) {
            ASSERT_EQ(std::fmod(std::ldexp(d, 52 - std::ilogb(d)), 2), 0) << x;
        }
    }
    ASSERT_TRUE(is(integer(d), truth(d)));
}
TEST(Integer, Doubles) {
    source random(8);
    for (int k = 0; k < 20'000 && !HasFatalFailure(); ++k) {
        // Near a double, near the middle of two, and anything.
        const truth head = (truth(random.any_word()) >> (random.below(2) == 0 ? 10 : 11));
        const int places = random.below(900);
        check_nearest((head << places) + random.below(3) - 1);
        check_nearest(-(head << places));
        check_nearest(random.of_words(1 + random.below(15), true));
    }
    const truth largest(std::numeric_limits<double>::max()), half = truth(1) << 970;
    EXPECT_EQ(static_cast<double>(own(largest + half - 1)), std::numeric_limits<double>::max());
    EXPECT_EQ(static_cast<double>(own(largest + half)), INFINITY);
    EXPECT_EQ(static_cast<double>(own(-(truth(1) << 5000))), -INFINITY);
    EXPECT_EQ(integer(-0.0), 0);
    EXPECT_EQ(integer(0x1p-1074), 0);
    EXPECT_EQ(integer(-2.75), -2);
    EXPECT_EQ(integer(0x1.8p1), 3);
    for (int k = 0; k < 10'000; ++k) {
        const double x =
            std::ldexp(static_cast<double>(random.any_word()), random.below(1000) - 80);
        if (std::isfinite(x)) {
            ASSERT_TRUE(is(integer(-x), truth(std::trunc(-x))));
        }
    }
}

TEST(Integer, Text) {
    source random(9);
    for (int k = 0; k < 2000; ++k) {
        const truth x = random.any();
        const integer a = own(x);
        ASSERT_EQ(to_string(a), x.str());
        ASSERT_EQ(integer::from_string(x.str()), a);
        for (const int base : {2, 3, 10, 16, 36})
            ASSERT_EQ(integer::from_string(to_string(a, base), base), a) << base;
    }
    std::ostringstream out;
    out << integer::from_string("-00123456789012345678901234567890") << ' ' << integer();
    EXPECT_EQ(out.str(), "-123456789012345678901234567890 0");
    EXPECT_EQ(integer::from_string("+fFz", 36), 15 * 36 * 36 + 15 * 36 + 35);
    for (const char* text : {"", "-", "+", "1 ", " 1", "--1", "1.0", "0x1", "a", "１"})
        EXPECT_THROW(integer::from_string(text), std::invalid_argument) << text;
    EXPECT_THROW(integer::from_string("2", 2), std::invalid_argument);
}

TEST(Integer, ShiftsThatNeedTooMuchMemoryThrow) {
    integer x = (integer(1) << 100U) - 1, before = x;
    EXPECT_THROW(x <<= 0x7fffffffU, std::bad_alloc);
    EXPECT_THROW(x <<= UINT64_MAX, std::bad_alloc);
    EXPECT_EQ(x, before);
    EXPECT_EQ(integer(0) << UINT64_MAX, 0);
    EXPECT_EQ(x >> UINT64_MAX, 0);
    EXPECT_EQ(-x >> UINT64_MAX, -1);
}

TEST(Integer, IsAnExactNumber) {
    static_assert(errbound::exact_number<integer>);
    using limits = std::numeric_limits<integer>;
    static_assert(limits::is_integer && limits::is_signed && !limits::is_bounded);
    static_assert(std::is_nothrow_move_constructible_v<integer>);
    static_assert(std::is_nothrow_move_assignable_v<integer>);
    static_assert(!std::is_convertible_v<double, integer> && !std::is_convertible_v<integer, int>);
    EXPECT_EQ(1 + integer(2) * 3 - 4 / integer(2), 5);
}

}  // namespace
