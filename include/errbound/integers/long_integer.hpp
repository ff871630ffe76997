// Exact integers of run-time length up to a compile-time capacity: no allocation. Products skip
// words that are all zero or all ones. Such words are frequent in numbers made of doubles far apart
// in size.
#pragma once

#include <array>
#include <cstdint>
#include <errbound/detail/bits.hpp>
#include <errbound/integers/fixed_integer.hpp>
#include <errbound/sign.hpp>
#include <type_traits>

namespace errbound::integers {

namespace words {

/// A two's complement number as a sum of signed words times powers of 2^64: visit(index, magnitude,
/// negative) for the nonzero ones, ascending. A word before an all-ones word, and the last word of
/// a negative number, counts as negative and passes on a carry: w = 2^64 − (2^64 − w). A partial
/// sum is negative if and only if its last word is. Proof: proofs/integers/Words.v,
/// signed_words_exact.
template <class Visit>
constexpr void for_signed_words(const word* x, int n, const Visit& visit) {
    word carry = 0;
    for (int i = 0; i < n; ++i) {
        const word w = x[i] + carry;
        if (w == 0) continue;  // a carry persists
        carry = i + 1 < n ? x[i + 1] == ~word(0) : x[i] >> 63;
        visit(i, carry != 0 ? 0 - w : w, carry != 0);
    }
}

constexpr int count_filled(const word* x, int n) {
    int count = 0;
    for (int i = 0; i < n; ++i) count += x[i] + 1 > 1;
    return count;
}

/// r −= a·b for n words; returns the borrow. Proof: proofs/integers/SparseProduct.v,
/// sparse_product_exact.
[[gnu::always_inline]] constexpr word subtract_multiple(word* r, word a, const word* b, int n) {
    word carry = 0;
    for (int j = 0; j < n; ++j) {
        const auto product = double_word(a) * b[j] + carry;
        const word difference = r[j] - static_cast<word>(product);
        carry = static_cast<word>(product >> 64) + (difference > r[j]);
        r[j] = difference;
    }
    return carry;
}

/// r = a·b in two's complement, of m, n and m + n words, by the signed words of a. Precondition: b
/// is not zero. Proof: proofs/integers/SparseProduct.v, sparse_product_exact.
[[gnu::noinline]] constexpr void multiply_sparse(word* r, const word* a, int m, const word* b,
                                                 int n) {
    int low = 0;
    while (b[low] == 0) ++low;
    // Words before `end` hold the sum so far, modulo a power of 2^64; later ones are `beyond`.
    int end = low;
    word beyond = 0;
    for (int i = 0; i < low; ++i) r[i] = 0;
    for_signed_words(a, m, [&](int i, word factor, bool negative) {
        for (; end <= i + n; ++end) r[end] = beyond;
        word* const sum = r + i;
        if (negative) {
            sum[n] -= subtract_multiple(sum + low, factor, b + low, n - low);
        } else {
            sum[n] += add_multiple(sum + low, factor, b + low, n - low);
        }
        beyond = negative ? ~word(0) : 0;
    });
    for (; end < m + n; ++end) r[end] = beyond;
    // The words of b were taken as positive, which is 2^(64n) too much if b is negative.
    if (b[n - 1] >> 63 != 0) {
        unsigned char borrow = 0;
        for (int i = 0; i < m; ++i) r[n + i] = subtract_with_borrow(r[n + i], a[i], borrow);
    }
}

/// r = a·b of m + n words, not trimmed. Proof: proofs/integers/SparseProduct.v, any_product_exact.
[[gnu::noinline]] constexpr void multiply_any(word* r, const word* a, int m, const word* b, int n) {
    constexpr int worth = 4;  // pays only if most words are skipped
    const auto is_sparse = [](const word* x, int size) {
        return worth * count_filled(x, size) < size;
    };
    if (is_sparse(a, m) && (n > 1 || b[0] != 0))
        multiply_sparse(r, a, m, b, n);
    else if (is_sparse(b, n) && (m > 1 || a[0] != 0))
        multiply_sparse(r, b, n, a, m);
    else
        multiply_long(r, a, m, b, n);
}

/// Word i of a two's complement number, also beyond its end.
constexpr word word_or_sign(const word* x, int n, int i) {
    return i < n ? x[i] : sign_word(x[n - 1]);
}
/// The size of x without words that repeat its sign. Proof: proofs/integers/Words.v, trim_exact.
constexpr int trimmed_size(const word* x, int n) {
    while (n > 1 && x[n - 1] == sign_word(x[n - 2])) --n;
    return n;
}
/// r = a ± b, of up to `capacity` words; returns the trimmed size. Compiled once for all
/// capacities.
template <word (*Step)(word, word, unsigned char&)>
[[gnu::noinline]] constexpr int combine(word* r, int capacity, const word* a, int m, const word* b,
                                        int n) {
    const int shorter = m < n ? m : n;
    const int longer = m < n ? n : m;
    const int size = longer < capacity ? longer + 1 : capacity;
    unsigned char carry = 0;
    for (int i = 0; i < shorter; ++i) r[i] = Step(a[i], b[i], carry);
    for (int i = shorter; i < size; ++i)
        r[i] = Step(word_or_sign(a, m, i), word_or_sign(b, n, i), carry);
    return trimmed_size(r, size);
}

}  // namespace words

/// A two's complement number of at most Words words. Sums and products must fit.
template <int Words>
class long_integer {
    using word = words::word;

  public:
    constexpr long_integer() : long_integer(0) {}
    constexpr long_integer(std::int64_t value) : size_(1) { at(0) = static_cast<word>(value); }
    /// ±magnitude·2^shift. Proof: proofs/integers/WordBits.v, long_shifted_exact.
    constexpr long_integer(word magnitude, int shift, bool negative) {
        const int whole = shift / 64, bits = shift % 64;
        const word low = magnitude << bits, high = bits == 0 ? 0 : magnitude >> (64 - bits);
        size_ = whole + 3 < Words ? whole + 3 : Words;
        for (int i = 0; i < whole; ++i) at(i) = 0;
        unsigned char carry = negative;
        for (int i = whole; i < size_; ++i) {
            const word w = i == whole ? low : i == whole + 1 ? high : 0;
            at(i) = words::add_with_carry(negative ? ~w : w, 0, carry);
        }
        trim();
    }
    constexpr long_integer(const long_integer& x) : size_(x.size()) { copy(x); }
    /// Proof: proofs/integers/Words.v, trim_exact.
    template <int Other>
    requires(Other <= Words) constexpr long_integer(const fixed_integer<Other>& x) : size_(Other) {
        copy(x);
        trim();
    }
    /// Precondition: x fits.
    template <int Other>
    constexpr long_integer(const long_integer<Other>& x) : size_(x.size()) {
        copy(x);
    }
    constexpr long_integer& operator=(const long_integer& x) {
        size_ = x.size();
        copy(x);
        return *this;
    }

    constexpr int size() const { return size_; }
    constexpr word operator[](int i) const { return words_[static_cast<std::size_t>(i)]; }
    constexpr bool negative() const { return (*this)[size_ - 1] >> 63 != 0; }

    /// Proof: proofs/integers/Words.v, long_sum_exact.
    template <int A, int B>
    static constexpr long_integer sum(const long_integer<A>& a, const long_integer<B>& b) {
        return combined<words::add_with_carry>(a, b);
    }
    /// Proof: proofs/integers/Words.v, long_difference_exact.
    template <int A, int B>
    static constexpr long_integer difference(const long_integer<A>& a, const long_integer<B>& b) {
        return combined<words::subtract_with_borrow>(a, b);
    }
    /// Proof: proofs/integers/SparseProduct.v, long_product_exact.
    template <int A, int B>
    static constexpr long_integer product(const long_integer<A>& a, const long_integer<B>& b) {
        return {a, b};
    }
    friend constexpr long_integer operator+(const long_integer& a, const long_integer& b) {
        return sum(a, b);
    }
    friend constexpr long_integer operator-(const long_integer& a, const long_integer& b) {
        return difference(a, b);
    }
    constexpr long_integer operator-() const { return difference(long_integer(), *this); }
    /// x·2^bits, bits >= 0. Proof: that of product, and proofs/integers/WordBits.v,
    /// long_shifted_exact.
    friend constexpr long_integer operator<<(const long_integer& x, int bits) {
        return product(x, long_integer<Words>(1, bits, false));
    }
    friend constexpr bool operator==(const long_integer& a, const long_integer& b) {
        if (a.size() != b.size()) return false;
        for (int i = 0; i < a.size(); ++i)
            if (a[i] != b[i]) return false;
        return true;
    }
    friend constexpr sign_type sign_of(const long_integer& x) {
        if (x.negative()) return sign_type::negative;
        return x.size_ == 1 && x[0] == 0 ? sign_type::zero : sign_type::positive;
    }

    /// The least n with −2^n <= x < 2^n. Proof: proofs/integers/WordBits.v, long_bit_length_exact.
    constexpr int bit_length() const {
        const word invert = words::sign_word((*this)[size_ - 1]);
        // The number is trimmed, so at most the last word repeats the sign.
        const int last = size_ > 1 && (*this)[size_ - 1] == invert ? size_ - 2 : size_ - 1;
        return 64 * last + detail::bit_width((*this)[last] ^ invert);
    }
    /// ⌊x/2^shift⌋ modulo 2^64, shift >= 0. Proof, of one word: proofs/integers/WordBits.v,
    /// from_bit_exact.
    constexpr std::int64_t word_from_bit(int shift) const {
        const int whole = shift / 64, bits = shift % 64;
        return static_cast<std::int64_t>(or_sign(whole) >> bits | or_sign(whole + 1)
                                                                      << 1 << (63 - bits));
    }

  private:
    template <int>
    friend class long_integer;
    struct uninitialised {};

    constexpr explicit long_integer(uninitialised) : size_(1) {}
    template <word (*Step)(word, word, unsigned char&), int A, int B>
    static constexpr long_integer combined(const long_integer<A>& a, const long_integer<B>& b) {
        long_integer r(uninitialised{});
        r.size_ = words::combine<Step>(r.words_.data(), Words, a.words_.data(), a.size(),
                                       b.words_.data(), b.size());
        return r;
    }
    template <int A, int B>
    constexpr long_integer(const long_integer<A>& a, const long_integer<B>& b) {
        const int whole = a.size() + b.size();
        if (whole <= Words) {
            words::multiply_any(words_.data(), a.words_.data(), a.size(), b.words_.data(),
                                b.size());
            size_ = whole;
        } else {  // before trimming
            std::array<word, std::size_t{A + B}> r;
            words::multiply_any(r.data(), a.words_.data(), a.size(), b.words_.data(), b.size());
            size_ = Words;
            for (int i = 0; i < size_; ++i) at(i) = r[static_cast<std::size_t>(i)];
        }
        trim();
    }

    template <class Other>
    constexpr void copy(const Other& x) {
        for (int i = 0; i < size_; ++i) at(i) = x[i];
    }
    constexpr word& at(int i) { return words_[static_cast<std::size_t>(i)]; }
    constexpr word or_sign(int i) const { return words::word_or_sign(words_.data(), size_, i); }
    constexpr void trim() { size_ = words::trimmed_size(words_.data(), size_); }

    int size_;
    std::array<word, std::size_t{Words}> words_;  ///< never read beyond the size
};

template <int A, int B>
constexpr long_integer<A + B> operator*(const long_integer<A>& a, const long_integer<B>& b) {
    return long_integer<A + B>::product(a, b);
}

template <int Words>
constexpr long_integer<Words> scale(const long_integer<Words>& x, int e) {
    return x << e;
}

}  // namespace errbound::integers
