// 128-bit unsigned integers: the compiler's, or a class if the compiler has none (32-bit
// processors).
#pragma once

#include <bit>
#include <concepts>
#include <cstdint>

namespace errbound::integers::words {

using word = std::uint64_t;

/// Unsigned, modulo 2^128; only the operations used here.
class two_words {
  public:
    constexpr two_words(std::unsigned_integral auto low) : low_(low) {}

    template <std::unsigned_integral T>
    explicit constexpr operator T() const {
        return static_cast<T>(low_);
    }
    friend constexpr two_words operator+(two_words a, two_words b) {
        const word low = a.low_ + b.low_;
        return {low, a.high_ + b.high_ + (low < a.low_)};
    }
    friend constexpr two_words operator-(two_words a, two_words b) {
        return {a.low_ - b.low_, a.high_ - b.high_ - (a.low_ < b.low_)};
    }
    friend constexpr two_words operator*(two_words a, two_words b) {
        two_words product = product_of(a.low_, b.low_);
        product.high_ += a.low_ * b.high_ + a.high_ * b.low_;
        return product;
    }
    constexpr two_words& operator+=(two_words b) { return *this = *this + b; }
    /// Only for shifts by 64.
    friend constexpr two_words operator>>(two_words a, int) { return {a.high_, 0}; }
    /// Bit by bit. Precondition: 0 < p < 2^63.
    friend constexpr two_words operator%(two_words a, word p) {
        word rest = a.high_ % p;
        for (int bit = 63; bit >= 0; --bit) {
            rest = 2 * rest + (a.low_ >> bit & 1);
            if (rest >= p) rest -= p;
        }
        return rest;
    }

  private:
    constexpr two_words(word low, word high) : low_(low), high_(high) {}

    /// Multiplies half words; no intermediate sum exceeds a word.
    static constexpr two_words product_of(word a, word b) {
        constexpr word half = 0xffffffff;
        const word low = (a & half) * (b & half);
        const word cross = (a >> 32) * (b & half) + (low >> 32);
        const word middle = (a & half) * (b >> 32) + (cross & half);
        return {middle << 32 | (low & half),
                (a >> 32) * (b >> 32) + (cross >> 32) + (middle >> 32)};
    }

    word low_, high_ = 0;
};

#ifdef __SIZEOF_INT128__
__extension__ using double_word = unsigned __int128;
__extension__ using signed_double_word = __int128;
inline constexpr int native_bits = 128;  ///< width of the compiler's widest integer
#else
using double_word = two_words;
inline constexpr int native_bits = 64;
#endif

}  // namespace errbound::integers::words
