// Exact integers of a width that is known at compile time: no allocation, no branches on size.
//
// fixed_integer<Words> is a two's complement number of 64·Words bits. A product has as many words
// as its factors together and is always exact. Sums, differences and shifts keep the width of
// their operands and wrap around: their result is right if it fits, whatever happened on the way,
// so it is the caller's to bound the results. Forms of a degree that is known in advance over
// coordinates of a bounded size (errbound/bernstein.hpp) get by with that, at a small part of the
// cost of unbounded integers.
//
// Everything is constexpr, without exceptions, intrinsics headers or global state, and fit for
// device code; what it asks of the compiler is a 128-bit integer type. Cost: A·B multiplications
// of words for a product of A and B words, one addition with carry per word for a sum.
#pragma once

#include <array>
#include <bit>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <errbound/sign.hpp>
#include <type_traits>

namespace errbound {

namespace words {

using word = std::uint64_t;
__extension__ using double_word = unsigned __int128;
__extension__ using signed_double_word = __int128;

// Compilers that know how to keep a carry in the processor's flag offer it by a builtin; before
// version 14 GCC does not find it in portable code. Device compilers take the portable code.
#if defined(__CUDACC__) || defined(__HIPCC__)
#elif defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define ERRBOUND_X86_CARRY
#endif

/// a + b + carry; carry (0 or 1) becomes the one out of it.
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

/// a − b − borrow; borrow (0 or 1) becomes the one out of it.
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

}  // namespace words

template <int Words>
class fixed_integer {
    static_assert(Words >= 1);
    using word = words::word;

  public:
    static constexpr int width = 64 * Words;  ///< in bits, the sign's included

    /// Zero.
    constexpr fixed_integer() = default;
    constexpr fixed_integer(std::int64_t value) {
        words_[0] = static_cast<word>(value);
        for (int i = 1; i < Words; ++i) at(i) = sign_word(words_[0]);
    }
    template <int Narrower>
    requires(Narrower < Words) constexpr fixed_integer(const fixed_integer<Narrower>& x) {
        for (int i = 0; i < Words; ++i) at(i) = i < Narrower ? x[i] : sign_word(x[Narrower - 1]);
    }
    /// From words, the least significant first.
    static constexpr fixed_integer from_words(const std::array<word, Words>& w) {
        fixed_integer x;
        x.words_ = w;
        return x;
    }
    /// magnitude·2^shift, for shift >= 0, less whole multiples of 2^width where it does not fit.
    static constexpr fixed_integer shifted(word magnitude, int shift) {
        fixed_integer x;
        const int whole = shift / 64, bits = shift % 64;
        const word low = magnitude << bits, high = bits == 0 ? 0 : magnitude >> (64 - bits);
        for (int i = 0; i < Words; ++i) at(x, i) = i == whole ? low : i == whole + 1 ? high : 0;
        return x;
    }

    constexpr word operator[](int i) const { return words_[static_cast<std::size_t>(i)]; }
    constexpr bool negative() const { return (words_[Words - 1] >> 63) != 0; }

    friend constexpr fixed_integer operator+(const fixed_integer& a, const fixed_integer& b) {
        fixed_integer r;
        unsigned char carry = 0;
        for (int i = 0; i < Words; ++i) at(r, i) = words::add_with_carry(a[i], b[i], carry);
        return r;
    }
    friend constexpr fixed_integer operator-(const fixed_integer& a, const fixed_integer& b) {
        fixed_integer r;
        unsigned char borrow = 0;
        for (int i = 0; i < Words; ++i) at(r, i) = words::subtract_with_borrow(a[i], b[i], borrow);
        return r;
    }
    constexpr fixed_integer operator-() const { return fixed_integer() - *this; }
    /// x·2^bits, for 0 <= bits < 64.
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
    friend constexpr std::strong_ordering operator<=>(const fixed_integer& a,
                                                      const fixed_integer& b) {
        // With the sign bits inverted, the order is that of unsigned numbers.
        constexpr word sign_bit = word(1) << 63;
        for (int i = Words - 1; i >= 0; --i) {
            const word invert = i == Words - 1 ? sign_bit : 0;
            if (a[i] != b[i]) return (a[i] ^ invert) <=> (b[i] ^ invert);
        }
        return std::strong_ordering::equal;
    }
    friend constexpr sign_type sign_of(const fixed_integer& x) {
        if (x.negative()) return sign_type::negative;
        word any = 0;
        for (int i = 0; i < Words; ++i) any |= x[i];
        return any == 0 ? sign_type::zero : sign_type::positive;
    }

    /// The least n with −2^n <= x < 2^n.
    constexpr int bit_length() const {
        const word invert = sign_word(words_[Words - 1]);
        for (int i = Words - 1; i >= 0; --i) {
            const word w = (*this)[i] ^ invert;
            if (w != 0) return 64 * i + static_cast<int>(std::bit_width(w));
        }
        return 0;
    }

    /// The exact product. The unsigned product of the words of two's complement numbers a and b is
    /// a·b, plus 2^(64A)·b where a < 0, plus 2^(64B)·a where b < 0, modulo the width of the result.
    template <int B>
    constexpr fixed_integer<Words + B> times(const fixed_integer<B>& b) const {
        const fixed_integer& a = *this;
        std::array<word, Words + B> r{};
        if constexpr (Words == 1 && B == 1) {
            const auto product = words::signed_double_word(static_cast<std::int64_t>(a[0])) *
                                 static_cast<std::int64_t>(b[0]);
            r = {static_cast<word>(product), static_cast<word>(product >> 64)};
        } else {
            for (std::size_t i = 0; i < Words; ++i) {
                word carry = 0;
                for (std::size_t j = 0; j < B; ++j) {
                    const words::double_word sum =
                        words::double_word(a[int(i)]) * b[int(j)] + r[i + j] + carry;
                    r[i + j] = static_cast<word>(sum);
                    carry = static_cast<word>(sum >> 64);
                }
                r[i + B] = carry;
            }
            const word if_a = sign_word(a[Words - 1]), if_b = sign_word(b[B - 1]);
            unsigned char borrow = 0;
            for (std::size_t j = 0; j < B; ++j)
                r[Words + j] = words::subtract_with_borrow(r[Words + j], b[int(j)] & if_a, borrow);
            borrow = 0;
            for (std::size_t i = 0; i < Words; ++i)
                r[B + i] = words::subtract_with_borrow(r[B + i], a[int(i)] & if_b, borrow);
        }
        return fixed_integer<Words + B>::from_words(r);
    }

  private:
    /// All ones if the word's first bit is set, else 0.
    static constexpr word sign_word(word w) {
        return static_cast<word>(static_cast<std::int64_t>(w) >> 63);
    }
    constexpr word& at(int i) { return words_[static_cast<std::size_t>(i)]; }
    static constexpr word& at(fixed_integer& x, int i) { return x.at(i); }

    std::array<word, Words> words_{};
};

/// The exact product.
template <int A, int B>
constexpr fixed_integer<A + B> operator*(const fixed_integer<A>& a, const fixed_integer<B>& b) {
    return a.times(b);
}

/// x·2^e for 0 <= e < 64, as for other exact numbers.
template <int Words>
constexpr fixed_integer<Words> scale(const fixed_integer<Words>& x, int e) {
    return x << e;
}

}  // namespace errbound
