// Replaces the library's header by integers of fixed width that count bits. Each stores an upper
// bound next to its words, like `bound` of expressions in FixedWidths.v of the proofs. The bound
// depends on the computation, not on the value. Exceptions are constants, and positions in the
// step, which are at most the step. A bound that exceeds the words is reported.
#pragma once

// The library's class under another name.
#define fixed_integer words_alone
#include "include/errbound/integers/fixed_integer.hpp"
#undef fixed_integer

#include <algorithm>
#include <bit>
#include <compare>
#include <cstdint>
#include <map>
#include <string>
#include <type_traits>

namespace errbound::integers {

/// At most m·2^k, rounded up to 32 bits.
struct upper_bound {
    std::uint64_t m = 0;
    int k = 0;

    static constexpr upper_bound of(std::uint64_t m, int k) {
        for (; m >> 32 != 0; ++k) m = (m >> 1) + (m & 1);
        return {m, k};
    }
    /// A bound that is a multiple of 2^to. Precondition: to >= k.
    constexpr upper_bound raised(int to) const {
        const int by = to - k;
        if (m == 0 || by >= 32) return {std::uint64_t{m != 0}, to};
        return {(m + (std::uint64_t{1} << by) - 1) >> by, to};
    }
    friend constexpr upper_bound operator+(const upper_bound& a, const upper_bound& b) {
        const int k = std::max(a.k, b.k);
        return of(a.raised(k).m + b.raised(k).m, k);
    }
    friend constexpr upper_bound operator*(const upper_bound& a, const upper_bound& b) {
        return of(a.m * b.m, a.k + b.k);
    }
    friend constexpr bool operator<(const upper_bound& a, const upper_bound& b) {
        const int k = std::max(a.k, b.k);
        return a.raised(k).m < b.raised(k).m;
    }
    /// The bound times 2^e, rounded up to a whole number.
    constexpr upper_bound times_power(int e) const {
        const upper_bound whole = k + e < 0 ? raised(-e) : *this;
        return {whole.m, whole.k + e};
    }
    /// The number is below 2^bits().
    constexpr int bits() const { return m == 0 ? 0 : k + static_cast<int>(std::bit_width(m)); }
};

/// Counts while `on`; numbers made while it is off have no bound.
struct bit_count {
    bool on = false;
    std::uint64_t numbers = 0, beyond = 0;
    std::map<int, int> fullest{};  ///< the most bits without the sign, by the number of words
    std::string first{};           ///< the first number that exceeds its words
};
inline bit_count counted;

template <int Words>
class fixed_integer {
    using numbers = words_alone<Words>;

  public:
    static constexpr int width = numbers::width;

    constexpr fixed_integer() = default;
    constexpr fixed_integer(std::int64_t value) : x_(value) {
        const auto size = static_cast<std::uint64_t>(value);
        known(upper_bound::of(value < 0 ? 0 - size : size, 0), "a constant");
    }
    template <int Narrower>
    requires(Narrower < Words) constexpr fixed_integer(const fixed_integer<Narrower>& x)
        : x_(x.x_) {
        x.used("conversion");
        known(x.bound_, "conversion");
    }
    static constexpr fixed_integer shifted(words::word magnitude, int shift) {
        fixed_integer r{numbers::shifted(magnitude, shift), upper_bound::of(magnitude, shift),
                        "shifted"};
        r.is_unit_ = magnitude == 1;
        return r;
    }
    /// The number x with the bound 2^bits.
    static constexpr fixed_integer given(const numbers& x, int bits) {
        return {x, upper_bound{1, bits}, "given"};
    }
    /// A coordinate modulo its width, with an index of its axis and end of the step. Differences of
    /// coordinates with the same index are below 2^bits; nothing else has a bound.
    static constexpr fixed_integer coordinate(const numbers& x, int axis_and_end, int bits) {
        fixed_integer r;
        r.x_ = x;
        r.is_known_ = false;
        r.coordinate_ = axis_and_end;
        r.difference_bits_ = bits;
        return r;
    }

    constexpr const numbers& plain() const { return x_; }
    constexpr words::word operator[](int i) const { return x_[i]; }
    constexpr bool negative() const {
        used("a sign");
        return x_.negative();
    }

    friend constexpr fixed_integer operator+(const fixed_integer& a, const fixed_integer& b) {
        return {a.x_ + b.x_, a.bound_ + b.bound_, "+", a, b};
    }
    friend constexpr fixed_integer operator-(const fixed_integer& a, const fixed_integer& b) {
        if (a.coordinate_ >= 0 && b.coordinate_ == a.coordinate_)
            return given(a.x_ - b.x_, a.difference_bits_);
        // The rest of the step after a position in it: both are at most the step, 2^bits, which
        // sums of bounds do not show. Proof: proofs/contact/CubicRoots.v, bracket_near_right.
        if (a.is_unit_ && !b.x_.negative() && b.x_ <= a.x_) {
            b.bound_ = std::min(b.bound_, a.bound_);
            b.is_place_ = true;
            return {a.x_ - b.x_, a.bound_, "-", a, b};
        }
        if (a.is_place_ && b.is_place_)
            return {a.x_ - b.x_, std::max(a.bound_, b.bound_), "-", a, b};
        return {a.x_ - b.x_, a.bound_ + b.bound_, "-", a, b};
    }
    constexpr fixed_integer operator-() const { return {-x_, bound_, "opposite", *this, *this}; }
    friend constexpr fixed_integer operator<<(const fixed_integer& x, int bits) {
        return {x.x_ << bits, x.bound_.times_power(bits), "<<", x, x};
    }
    friend constexpr bool operator==(const fixed_integer& a, const fixed_integer& b) {
        a.used("=="), b.used("==");
        return a.x_ == b.x_;
    }
    friend constexpr std::strong_ordering operator<=>(const fixed_integer& a,
                                                      const fixed_integer& b) {
        a.used("<=>"), b.used("<=>");
        return a.x_ <=> b.x_;
    }
    friend constexpr sign_type sign_of(const fixed_integer& x) {
        x.used("a sign");
        return sign_of(x.x_);
    }
    constexpr int bit_length() const {
        used("bit_length");
        return x_.bit_length();
    }

    template <int Result>
    constexpr fixed_integer<Result> from_bit(int shift) const {
        used("from_bit");
        return {x_.template from_bit<Result>(shift), bound_.times_power(-shift) + upper_bound{1, 0},
                "from_bit"};
    }
    /// The number modulo 2^64, without a report.
    constexpr std::int64_t word_from_bit(int shift) const {
        used("word_from_bit");
        return x_.word_from_bit(shift);
    }
    /// The value, which must fit in a word, such as the difference of two positions in a bracket.
    constexpr std::int64_t low_word() const {
        used("low_word");
        if (counted.on && !(numbers(x_.low_word()) == x_)) told("low_word");
        return x_.low_word();
    }
    template <int B>
    constexpr fixed_integer<Words + B> times(const fixed_integer<B>& b) const {
        used("*"), b.used("*");
        return {x_ * b.x_, bound_ * b.bound_, "*"};
    }

  private:
    template <int>
    friend class fixed_integer;

    constexpr fixed_integer(const numbers& x, const upper_bound& bound, const char* how) : x_(x) {
        known(bound, how);
    }
    constexpr fixed_integer(const numbers& x, const upper_bound& bound, const char* how,
                            const fixed_integer& a, const fixed_integer& b)
        : fixed_integer(x, bound, how) {
        a.used(how), b.used(how);
    }
    /// Reports a use of a number without a bound.
    constexpr void used(const char* how) const {
        if (counted.on && !is_known_) told(how);
    }
    constexpr void known(const upper_bound& bound, const char* how) {
        is_known_ = counted.on;
        if (!counted.on) return;
        bound_ = bound;
        ++counted.numbers;
        counted.fullest[Words] = std::max(counted.fullest[Words], bound_.bits());
        if (bound_.bits() >= width) told(how);
    }
    static void told(const char* how) {
        if (counted.beyond++ == 0)
            counted.first = std::string(how) + " in " + std::to_string(Words) + " words";
    }

    numbers x_;
    mutable upper_bound bound_{};
    mutable bool is_place_ = false;
    bool is_known_ = true;  // zero
    bool is_unit_ = false;
    int coordinate_ = -1, difference_bits_ = 0;
};

template <int A, int B>
constexpr fixed_integer<A + B> operator*(const fixed_integer<A>& a, const fixed_integer<B>& b) {
    return a.times(b);
}
template <int Words>
constexpr fixed_integer<Words> scale(const fixed_integer<Words>& x, int e) {
    return x << e;
}

}  // namespace errbound::integers
