// Exact integers of compile-time width: no allocation, no branches on size, usable in device code.
// fixed_integer<Words> is a two's complement number of 64·Words bits. A product has the words of
// both factors and is exact. Sums, differences and shifts keep their width and wrap around, so
// callers must ensure that results fit. Cost: A·B word multiplications for a product of A and B
// words.
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <errbound/detail/bits.hpp>
#include <errbound/integers/double_word.hpp>
#include <errbound/sign.hpp>
#include <type_traits>

namespace errbound::integers {

namespace words {

// Clang keeps carries in the carry flag; GCC does so only with builtins, which device compilers
// lack.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__CUDACC__)
#define ERRBOUND_X86_CARRY
#endif

/// a + b + carry; updates carry (0 or 1). Proof: proofs/integers/Words.v, add_with_carry_exact.
constexpr word add_with_carry(word a, word b, unsigned char& carry) {
#ifdef ERRBOUND_X86_CARRY
    if (!std::is_constant_evaluated()) {
        unsigned long long sum;
        carry = __builtin_ia32_addcarryx_u64(carry, a, b, &sum);
        return sum;
    }
#endif
    const double_word sum = double_word(a) + b + carry;
    carry = static_cast<unsigned char>(sum >> 64);
    return static_cast<word>(sum);
}

/// a − b − borrow; updates borrow (0 or 1). Proof: proofs/integers/Words.v,
/// subtract_with_borrow_exact.
constexpr word subtract_with_borrow(word a, word b, unsigned char& borrow) {
#ifdef ERRBOUND_X86_CARRY
    if (!std::is_constant_evaluated()) {
        unsigned long long difference;
        borrow = __builtin_ia32_sbb_u64(borrow, a, b, &difference);
        return difference;
    }
#endif
    const double_word difference = double_word(a) - b - borrow;
    borrow = static_cast<unsigned char>(difference >> 64) & 1;
    return static_cast<word>(difference);
}
#undef ERRBOUND_X86_CARRY

constexpr word sign_word(word w) {
    return static_cast<word>(static_cast<std::int64_t>(w) >> 63);
}

/// r += a·b for n words; returns the carry out of r. Proof: proofs/integers/Words.v,
/// add_multiple_exact.
[[gnu::always_inline]] constexpr word add_multiple(word* r, word a, const word* b, int n) {
    word carry = 0;
#ifndef __CUDACC__
#pragma GCC unroll 4
#endif
    for (int j = 0; j < n; ++j) {
        auto sum = double_word(a) * b[j] + r[j];
        sum += carry;
        r[j] = static_cast<word>(sum);
        carry = static_cast<word>(sum >> 64);
    }
    return carry;
}

/// r = a·b, of m + n words. Multiplies unsigned numbers, which adds 2^(64m)·b if a < 0 and
/// 2^(64n)·a if b < 0, then subtracts these. Proof: proofs/integers/Words.v, product_exact.
[[gnu::always_inline]] constexpr void multiply(word* r, const word* a, int m, const word* b,
                                               int n) {
    for (int j = 0; j < n; ++j) r[j] = 0;
    for (int i = 0; i < m; ++i) r[i + n] = add_multiple(r + i, a[i], b, n);
    const word if_a = sign_word(a[m - 1]), if_b = sign_word(b[n - 1]);
    unsigned char borrow = 0;
    for (int j = 0; j < n; ++j) r[m + j] = subtract_with_borrow(r[m + j], b[j] & if_a, borrow);
    borrow = 0;
    for (int i = 0; i < m; ++i) r[n + i] = subtract_with_borrow(r[n + i], a[i] & if_b, borrow);
}

[[gnu::always_inline]] constexpr void multiply_one(word* r, word a, word b) {
#ifdef __SIZEOF_INT128__
    const auto product =
        signed_double_word(static_cast<std::int64_t>(a)) * static_cast<std::int64_t>(b);
    r[0] = static_cast<word>(product);
    r[1] = static_cast<word>(product >> 64);
#else
    multiply(r, &a, 1, &b, 1);
#endif
}

/// multiply, compiled once for all sizes.
[[gnu::noinline]] constexpr void multiply_long(word* r, const word* a, int m, const word* b,
                                               int n) {
    multiply(r, a, m, b, n);
}

}  // namespace words

template <int Words>
class fixed_integer {
    static_assert(Words >= 1);
    using word = words::word;

  public:
    static constexpr int width = 64 * Words;  ///< in bits, with sign

    constexpr fixed_integer() = default;
    constexpr fixed_integer(std::int64_t value) {
        words_[0] = static_cast<word>(value);
        for (int i = 1; i < Words; ++i) at(i) = words::sign_word(words_[0]);
    }
    template <int Narrower>
    requires(Narrower < Words) constexpr fixed_integer(const fixed_integer<Narrower>& x) {
        for (int i = 0; i < Words; ++i)
            at(i) = i < Narrower ? x[i] : words::sign_word(x[Narrower - 1]);
    }
    /// Least significant word first.
    static constexpr fixed_integer from_words(const std::array<word, std::size_t{Words}>& w) {
        fixed_integer x;
        x.words_ = w;
        return x;
    }
    /// magnitude·2^shift modulo 2^width, for shift >= 0. Proof: proofs/integers/WordBits.v,
    /// shifted_exact.
    static constexpr fixed_integer shifted(word magnitude, int shift) {
        fixed_integer x;
        const int whole = shift / 64, bits = shift % 64;
        const word low = magnitude << bits, high = bits == 0 ? 0 : magnitude >> (64 - bits);
        for (int i = 0; i < Words; ++i) at(x, i) = i == whole ? low : i == whole + 1 ? high : 0;
        return x;
    }

    constexpr word operator[](int i) const { return words_[static_cast<std::size_t>(i)]; }
    constexpr bool negative() const { return (words_[Words - 1] >> 63) != 0; }

    /// Proof: proofs/integers/Words.v, sum_exact.
    friend constexpr fixed_integer operator+(const fixed_integer& a, const fixed_integer& b) {
        fixed_integer r;
        unsigned char carry = 0;
        for (int i = 0; i < Words; ++i) at(r, i) = words::add_with_carry(a[i], b[i], carry);
        return r;
    }
    /// Proof: proofs/integers/Words.v, difference_exact.
    friend constexpr fixed_integer operator-(const fixed_integer& a, const fixed_integer& b) {
        fixed_integer r;
        unsigned char borrow = 0;
        for (int i = 0; i < Words; ++i) at(r, i) = words::subtract_with_borrow(a[i], b[i], borrow);
        return r;
    }
    constexpr fixed_integer operator-() const { return fixed_integer() - *this; }
    /// x·2^bits, 0 <= bits < 64. Proof: proofs/integers/Words.v, shift_exact.
    friend constexpr fixed_integer operator<<(const fixed_integer& x, int bits) {
        if (bits == 0) return x;
        fixed_integer r;
        at(r, 0) = x[0] << bits;
        for (int i = 1; i < Words; ++i) at(r, i) = x[i] << bits | x[i - 1] >> (64 - bits);
        return r;
    }

    friend constexpr bool operator==(const fixed_integer& a, const fixed_integer& b) {
        word differing = 0;
        for (int i = 0; i < Words; ++i) differing |= a[i] ^ b[i];
        return differing == 0;
    }
    /// Proof: proofs/integers/Words.v, compare_exact.
    friend constexpr std::strong_ordering operator<=>(const fixed_integer& a,
                                                      const fixed_integer& b) {
        constexpr word sign_bit = word(1) << 63;  // inverted, to compare as unsigned numbers
        for (int i = Words - 1; i >= 0; --i) {
            const word invert = i == Words - 1 ? sign_bit : 0;
            if (a[i] != b[i]) return (a[i] ^ invert) <=> (b[i] ^ invert);
        }
        return std::strong_ordering::equal;
    }
    /// Proof: proofs/integers/Words.v, sign_exact.
    friend constexpr sign_type sign_of(const fixed_integer& x) {
        if (x.negative()) return sign_type::negative;
        word any = 0;
        for (int i = 0; i < Words; ++i) any |= x[i];
        return any == 0 ? sign_type::zero : sign_type::positive;
    }

    /// The least n with −2^n <= x < 2^n. Proof: proofs/integers/WordBits.v, bit_length_exact.
    constexpr int bit_length() const {
        const word invert = words::sign_word(words_[Words - 1]);
        for (int i = Words - 1; i >= 0; --i) {
            const word w = (*this)[i] ^ invert;
            if (w != 0) return 64 * i + detail::bit_width(w);
        }
        return 0;
    }

    /// ⌊x/2^shift⌋ modulo 2^(64·Result), shift >= 0. Proof: proofs/integers/WordBits.v,
    /// from_bit_exact.
    template <int Result>
    constexpr fixed_integer<Result> from_bit(int shift) const {
        const word beyond = words::sign_word(words_[Words - 1]);
        const auto word_at = [&](int i) { return i < Words ? (*this)[i] : beyond; };
        const int whole = shift / 64, bits = shift % 64;
        fixed_integer<Result> r;
        word low = word_at(whole);
        for (int i = 0; i < Result; ++i) {
            const word high = word_at(whole + i + 1);
            // Two shifts: a single one by 64, for bits = 0, is undefined.
            r.at(i) = low >> bits | high << 1 << (63 - bits);
            low = high;
        }
        return r;
    }
    constexpr std::int64_t word_from_bit(int shift) const { return from_bit<1>(shift).low_word(); }
    constexpr std::int64_t low_word() const { return static_cast<std::int64_t>(words_[0]); }

    /// The exact product. Small products are unrolled in place; large ones are rare and share code.
    template <int B>
    [[gnu::always_inline]] constexpr fixed_integer<Words + B> times(
        const fixed_integer<B>& b) const {
        fixed_integer<Words + B> r;
        if constexpr (Words == 1 && B == 1) {
            words::multiply_one(r.words_.data(), words_[0], b.words_[0]);
        } else if constexpr (Words * B <= 8) {
            words::multiply(r.words_.data(), words_.data(), Words, b.words_.data(), B);
        } else if constexpr (Words * B <= 36) {
            multiply(r.words_, words_, b.words_);
        } else {
            words::multiply_long(r.words_.data(), words_.data(), Words, b.words_.data(), B);
        }
        return r;
    }

  private:
    template <int>
    friend class fixed_integer;

    constexpr word& at(int i) { return words_[static_cast<std::size_t>(i)]; }
    static constexpr word& at(fixed_integer& x, int i) { return x.at(i); }

    template <std::size_t A, std::size_t B>
    [[gnu::noinline]] static constexpr void multiply(std::array<word, A + B>& r,
                                                     const std::array<word, A>& a,
                                                     const std::array<word, B>& b) {
        words::multiply(r.data(), a.data(), A, b.data(), B);
    }

    std::array<word, std::size_t{Words}> words_{};
};

template <int A, int B>
[[gnu::always_inline]] constexpr fixed_integer<A + B> operator*(const fixed_integer<A>& a,
                                                                const fixed_integer<B>& b) {
    return a.times(b);
}

template <int Words>
constexpr fixed_integer<Words> scale(const fixed_integer<Words>& x, int e) {
    return x << e;
}

}  // namespace errbound::integers
