// Natural numbers of any length, as words in memory, least significant first. Sizes are in words,
// at least 1 unless stated. Results have the stated size and may have leading zeros; unless stated,
// they must not overlap operands.
#pragma once

#include <algorithm>
#include <compare>
#include <errbound/detail/bits.hpp>
#include <errbound/integers/fixed_integer.hpp>
#include <errbound/integers/long_integer.hpp>
#include <numeric>
#include <utility>

namespace errbound::integers::words {

/// The size without leading zeros, possibly 0.
constexpr int trimmed(const word* a, int n) {
    while (n > 0 && a[n - 1] == 0) --n;
    return n;
}

constexpr std::strong_ordering compare(const word* a, const word* b, int n) {
    while (n > 0 && a[n - 1] == b[n - 1]) --n;
    return n == 0 ? std::strong_ordering::equal : a[n - 1] <=> b[n - 1];
}

/// r = a + b of m and n <= m words, n >= 0; returns the carry. r may be a or b.
constexpr word add(word* r, const word* a, int m, const word* b, int n) {
    unsigned char carry = 0;
#ifndef __CUDACC__
#pragma GCC unroll 4
#endif
    for (int i = 0; i < n; ++i) r[i] = add_with_carry(a[i], b[i], carry);
    for (int i = n; i < m; ++i) r[i] = add_with_carry(a[i], 0, carry);
    return carry;
}

/// r = a − b of m and n <= m words, n >= 0; returns the borrow. r may be a or b.
constexpr word subtract(word* r, const word* a, int m, const word* b, int n) {
    unsigned char borrow = 0;
#ifndef __CUDACC__
#pragma GCC unroll 4
#endif
    for (int i = 0; i < n; ++i) r[i] = subtract_with_borrow(a[i], b[i], borrow);
    for (int i = n; i < m; ++i) r[i] = subtract_with_borrow(a[i], 0, borrow);
    return borrow;
}

/// r = a·2^bits, 0 <= bits < 64; returns the bits shifted out. r may be a, or begin inside it.
constexpr word shift_left(word* r, const word* a, int n, int bits) {
    // Two shifts: a single one by 64, for bits = 0, is undefined.
    const word beyond = a[n - 1] >> 1 >> (63 - bits);
    for (int i = n - 1; i > 0; --i) r[i] = a[i] << bits | a[i - 1] >> 1 >> (63 - bits);
    r[0] = a[0] << bits;
    return beyond;
}

/// r = ⌊a/2^bits⌋, 0 <= bits < 64. r may be a, or a may begin inside it.
constexpr void shift_right(word* r, const word* a, int n, int bits) {
    for (int i = 0; i + 1 < n; ++i) r[i] = a[i] >> bits | a[i + 1] << 1 << (63 - bits);
    r[n - 1] = a[n - 1] >> bits;
}

/// r = a·b + carry for n words; returns the carry. r may be a.
constexpr word multiply_by_word(word* r, const word* a, int n, word b, word carry = 0) {
    for (int i = 0; i < n; ++i) {
        const auto product = double_word(a[i]) * b + carry;
        r[i] = static_cast<word>(product);
        carry = static_cast<word>(product >> 64);
    }
    return carry;
}

/// r = a·b of m + n words, row by row.
constexpr void multiply_rows(word* r, const word* a, int m, const word* b, int n) {
    r[n] = multiply_by_word(r, b, n, a[0]);
    for (int i = 1; i < m; ++i) r[n + i] = a[i] == 0 ? 0 : add_multiple(r + i, a[i], b, n);
}

inline constexpr int karatsuba_words = 32;  ///< from this size on, Karatsuba's products are faster

/// Scratch words for a product whose shorter factor has n words. multiply_by_halves needs 2n + 3,
/// multiply_natural 2n for pieces and 2n for the remainder; with recursion 12n + 9·log2(n) suffice.
constexpr int product_scratch(int n) {
    return n < karatsuba_words ? 0 : 16 * n;
}

constexpr void multiply_natural(word* r, const word* a, int m, const word* b, int n, word* scratch);

/// r = |a − b|, of m and n words, m − 1 <= n <= m; returns true if a < b.
constexpr bool subtract_size(word* r, const word* a, int m, const word* b, int n) {
    const bool negative = (n == m || a[m - 1] == 0) && compare(a, b, n) < 0;
    if (negative) {
        subtract(r, b, n, a, n);
        if (n < m) r[n] = 0;
    } else {
        subtract(r, a, m, b, n);
    }
    return negative;
}

/// r = a·b of 2n words, n >= 2, by halves a = a1·W + a0, b = b1·W + b0 (A. Karatsuba, Yu. Ofman
/// 1962): a0·b1 + a1·b0 = a0·b0 + a1·b1 − (a0 − a1)(b0 − b1).
constexpr void multiply_by_halves(word* r, const word* a, const word* b, int n, word* scratch) {
    const int low = (n + 1) / 2, high = n - low;
    word *const cross = scratch, *const sum = cross + 2 * low, *const rest = sum + 2 * low + 1;
    const bool a_negative = subtract_size(r, a, low, a + low, high),
               b_negative = subtract_size(r + low, b, low, b + low, high);
    multiply_natural(cross, r, low, r + low, low, rest);
    multiply_natural(r, a, low, b, low, rest);
    multiply_natural(r + 2 * low, a + low, high, b + low, high, rest);
    sum[2 * low] = add(sum, r, 2 * low, r + 2 * low, 2 * high);
    if (a_negative == b_negative)
        subtract(sum, sum, 2 * low + 1, cross, 2 * low);
    else
        add(sum, sum, 2 * low + 1, cross, 2 * low);
    // The sum may have one more word than fits, a zero.
    add(r + low, r + low, 2 * n - low, sum, (std::min)(2 * low + 1, 2 * n - low));
}

/// r = a·b of m + n words, n <= m, by pieces of a as long as b.
constexpr void multiply_by_pieces(word* r, const word* a, int m, const word* b, int n,
                                  word* scratch) {
    multiply_natural(r, a, n, b, n, scratch);
    word *const product = scratch, *const rest = scratch + 2 * n;
    for (int i = n; i < m; i += n) {
        const int size = (std::min)(n, m - i);
        multiply_natural(product, b, n, a + i, size, rest);
        add(r + i, product, n + size, r + i, n);
    }
}

/// r = a·b of m + n words, n <= m, with product_scratch(n) words of scratch. Skips zeros at both
/// ends of the factors (see long_integer.hpp).
constexpr void multiply_natural(word* r, const word* a, int m, const word* b, int n,
                                word* scratch) {
    if (n < karatsuba_words) {
        multiply_rows(r, b, n, a, m);
        return;
    }
    const int a_end = trimmed(a, m), b_end = trimmed(b, n);
    int a_low = 0, b_low = 0;
    while (a_low < a_end && a[a_low] == 0) ++a_low;
    while (b_low < b_end && b[b_low] == 0) ++b_low;
    const int a_size = a_end - a_low, b_size = b_end - b_low;
    if (a_size == 0 || b_size == 0) {
        std::fill_n(r, m + n, word(0));
    } else if (a_size + b_size < m + n) {
        const int low = a_low + b_low;
        std::fill_n(r, low, word(0));
        std::fill(r + a_end + b_end, r + m + n, word(0));
        if (a_size < b_size)
            multiply_natural(r + low, b + b_low, b_size, a + a_low, a_size, scratch);
        else
            multiply_natural(r + low, a + a_low, a_size, b + b_low, b_size, scratch);
    } else if (m == n) {
        multiply_by_halves(r, a, b, n, scratch);
    } else {
        multiply_by_pieces(r, a, m, b, n, scratch);
    }
}

// Quotients: N. Möller, T. Granlund, Improved division by invariant integers, IEEE TC 60, 2011.

/// ⌊(2^128 − 1)/d⌋ − 2^64 for d >= 2^63, by Knuth's algorithm D on 32-bit digits.
constexpr word reciprocal(word d) {
    constexpr word half = 0xffffffff;
    const word high_half = d >> 32, low_half = d & half;
    // ⌊(rest·2^32 + 2^32 − 1)/d⌋ for rest < d
    const auto digit = [&](word rest) {
        word q = rest / high_half, left = rest % high_half;
        while (left <= half && (q > half || q * low_half > (left << 32 | half))) {
            --q;
            left += high_half;
        }
        return q;
    };
    const word high = digit(~d);  // 2^128 − 1 − 2^64·d has the words ~d and ~0
    return high << 32 | digit((~d << 32 | half) - high * d);
}

/// ⌊(rest·2^64 + low)/d⌋ for rest < d, 2^63 <= d with reciprocal v; rest becomes the remainder.
constexpr word divide_two_words(word& rest, word low, word d, word v) {
    const auto estimate = double_word(v) * rest;
    const word fraction = static_cast<word>(estimate) + low;
    word q = static_cast<word>(estimate >> 64) + rest + (fraction < low) + 1;
    rest = low - q * d;
    if (rest > fraction) {
        --q;
        rest += d;
    }
    if (rest >= d) {
        ++q;
        rest -= d;
    }
    return q;
}

/// Divides a by d, not zero: calls store(i, word) for i = n − 1, ..., 0; returns the remainder.
template <class Store>
constexpr word divide_by_word(const word* a, int n, word d, const Store& store) {
    const int shift = detail::countl_zero(d);
    const word divisor = d << shift, v = reciprocal(divisor);
    word rest = a[n - 1] >> 1 >> (63 - shift);
    for (int i = n - 1; i >= 0; --i) {
        const word next = i > 0 ? a[i - 1] >> 1 >> (63 - shift) : 0;
        store(i, divide_two_words(rest, a[i] << shift | next, divisor, v));
    }
    return rest >> shift;
}

/// A divisor of two words, the higher one >= 2^63.
class two_word_divisor {
  public:
    constexpr two_word_divisor(word high, word low) : high_(high), low_(low) {
        v_ = reciprocal(high);  // that of the higher word, reduced below
        word p = high * v_ + low;
        if (p < low) {
            --v_;
            if (p >= high) {
                --v_;
                p -= high;
            }
            p -= high;
        }
        const auto t = double_word(v_) * low;
        const word t_high = static_cast<word>(t >> 64), t_low = static_cast<word>(t);
        p += t_high;
        if (p < t_high) {
            --v_;
            if (p > high || (p == high && t_low >= low)) --v_;
        }
    }

    /// The quotient of three words, or 2^64 − 1 if it is larger. Precondition: the first two words
    /// are at most the divisor.
    constexpr word quotient(word a2, word a1, word a0) const {
        if (a2 == high_ && a1 == low_) return ~word(0);
        const auto estimate = double_word(v_) * a2;
        const word fraction = static_cast<word>(estimate) + a1;
        word q = static_cast<word>(estimate >> 64) + a2 + (fraction < a1);
        word r1 = a1 - q * high_, r0 = a0;
        const auto t = double_word(q) * low_;
        unsigned char borrow = 0;
        r0 = subtract_with_borrow(r0, static_cast<word>(t), borrow);
        r1 = subtract_with_borrow(r1, static_cast<word>(t >> 64), borrow);
        borrow = 0;
        r0 = subtract_with_borrow(r0, low_, borrow);
        r1 = subtract_with_borrow(r1, high_, borrow);
        ++q;
        if (r1 >= fraction) {
            --q;
            unsigned char carry = 0;
            r0 = add_with_carry(r0, low_, carry);
            r1 = add_with_carry(r1, high_, carry);
        }
        if (r1 > high_ || (r1 == high_ && r0 >= low_)) ++q;
        return q;
    }

  private:
    word high_, low_, v_;
};

/// Divides a, of m + 1 words whose last n are below d, by d, n >= 2 words with its first bit set:
/// calls store(i, word) from the last word on; a becomes the remainder. (Knuth, TAOCP 4.3.1,
/// algorithm D.)
template <class Store>
constexpr void divide_long(word* a, int m, const word* d, int n, const Store& store) {
    const two_word_divisor divisor(d[n - 1], d[n - 2]);
    for (int i = m - n; i >= 0; --i) {
        word* const part = a + i;
        // The quotient of three words is the digit or, very rarely, one more.
        word q = divisor.quotient(part[n], part[n - 1], part[n - 2]);
        if (subtract_multiple(part, q, d, n) > part[n]) {
            --q;
            add(part, part, n, d, n);
        }
        part[n] = 0;
        store(i, q);
    }
}

/// A matrix of determinant ±1: (a, b) becomes (|m00·a − m01·b|, |m10·a − m11·b|).
struct euclid_steps {
    word m00 = 1, m01 = 0, m10 = 0, m11 = 1;
    bool even = true;  ///< the differences have the signs as written; otherwise both are negated
    bool none() const { return m01 == 0; }
};

/// The steps of Euclid's algorithm common to all numbers a >= b that begin with these words. (D. H.
/// Lehmer 1938; condition: G. E. Collins, in T. Jebelean, J. Symbolic Computation 19, 1995.)
constexpr euclid_steps common_steps(word a, word b) {
    euclid_steps sure, m;
    while (b >= m.m11 && a - b >= m.m01 + m.m11) {
        sure = m;
        const word q = a / b, rest = a % b;
        a = b;
        b = rest;
        m = {m.m10, m.m11, m.m00 + q * m.m10, m.m01 + q * m.m11, !m.even};
    }
    return sure;
}

constexpr void apply(const euclid_steps& m, word* a, word* b, int n) {
    word c00 = 0, c01 = 0, c10 = 0, c11 = 0;
    unsigned char borrow_a = 0, borrow_b = 0;
    const auto product = [](word factor, word x, word& carry) {
        const auto p = double_word(factor) * x + carry;
        carry = static_cast<word>(p >> 64);
        return static_cast<word>(p);
    };
    for (int i = 0; i < n; ++i) {
        const word x = a[i], y = b[i];
        const word ax = product(m.m00, x, c00), ay = product(m.m01, y, c01);
        const word bx = product(m.m10, x, c10), by = product(m.m11, y, c11);
        a[i] = m.even ? subtract_with_borrow(ax, ay, borrow_a)
                      : subtract_with_borrow(ay, ax, borrow_a);
        b[i] = m.even ? subtract_with_borrow(by, bx, borrow_b)
                      : subtract_with_borrow(bx, by, borrow_b);
    }
}

struct word_pair {
    word high, low;
    friend constexpr auto operator<=>(const word_pair&, const word_pair&) = default;
};

constexpr word_pair odd_part(word_pair x) {
    if (x.low == 0) x = {0, x.high};
    const int zeros = detail::countr_zero(x.low);
    return {x.high >> zeros, x.low >> zeros | x.high << 1 << (63 - zeros)};
}

/// The greatest common divisor, by differences and halving (J. Stein 1967). Precondition: a and b
/// are odd.
constexpr word_pair odd_common_divisor(word_pair a, word_pair b) {
    while ((a.high | b.high) != 0) {
        if (a == b) return a;
        if (a < b) std::swap(a, b);
        unsigned char borrow = 0;
        const word low = subtract_with_borrow(a.low, b.low, borrow);
        a = odd_part({subtract_with_borrow(a.high, b.high, borrow), low});
    }
    return {0, std::gcd(a.low, b.low)};
}

}  // namespace errbound::integers::words
