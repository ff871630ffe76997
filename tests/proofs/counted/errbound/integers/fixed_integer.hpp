// In place of the library's header: integers of fixed width that count bits. Beside its words each
// has what it can be at most, which depends on how it was computed and not on its value, as
// expressions have in proofs/FixedWidths.v (`bound`); where that exceeds its words, it is told.
#pragma once

// The library's own, under another name.
#define fixed_integer words_alone
#include "include/errbound/integers/fixed_integer.hpp"
#undef fixed_integer

#include <algorithm>
#include <boost/multiprecision/cpp_int.hpp>
#include <compare>
#include <cstdint>
#include <map>
#include <string>
#include <type_traits>

namespace errbound::integers {

/// What was counted. Nothing is, and no bound is known, unless `on`.
struct bit_count {
    bool on = false;
    std::uint64_t numbers = 0, beyond = 0;
    std::map<int, int> fullest{};  ///< by words: the most bits, the sign's excluded
    std::string first{};           ///< the first that is beyond
};
inline bit_count counted;

template <int Words>
class fixed_integer {
    using bound_type = boost::multiprecision::cpp_int;
    using numbers = words_alone<Words>;

  public:
    static constexpr int width = numbers::width;

    fixed_integer() = default;
    fixed_integer(std::int64_t value) : x_(value) {
        if (counted.on) known(boost::multiprecision::abs(bound_type(value)), "a constant");
    }
    template <int Narrower>
    requires(Narrower < Words) fixed_integer(const fixed_integer<Narrower>& x) : x_(x.x_) {
        known(x.bound_, "conversion");
    }
    static fixed_integer shifted(words::word magnitude, int shift) {
        fixed_integer r{numbers::shifted(magnitude, shift), bound_type(magnitude) << shift,
                        "shifted"};
        r.is_unit_ = magnitude == 1;
        return r;
    }
    /// x, which is below 2^bits in size.
    static fixed_integer given(const numbers& x, int bits) {
        return {x, bound_type(1) << bits, "given"};
    }
    /// A coordinate modulo its width: differences of such are below 2^bits, and nothing else is
    /// known.
    static fixed_integer coordinate(const numbers& x, int bits) {
        fixed_integer r;
        r.x_ = x;
        r.difference_bits_ = bits;
        return r;
    }

    const numbers& plain() const { return x_; }
    words::word operator[](int i) const { return x_[i]; }
    bool negative() const { return x_.negative(); }

    friend fixed_integer operator+(const fixed_integer& a, const fixed_integer& b) {
        return {a.x_ + b.x_, a.bound_ + b.bound_, "+", a, b};
    }
    friend fixed_integer operator-(const fixed_integer& a, const fixed_integer& b) {
        if (a.difference_bits_ >= 0 && b.difference_bits_ == a.difference_bits_)
            return given(a.x_ - b.x_, a.difference_bits_);
        // The rest of the step after a place in it: both are at most the step, 2^bits, as places
        // are (proofs/CubicRoots.v, bracket_near_right; proofs/Places.v), which sums of bounds tell
        // not.
        if (a.is_unit_ && !b.negative() && b <= a) {
            b.bound_ = std::min(b.bound_, a.bound_);
            b.is_place_ = true;
            return {a.x_ - b.x_, a.bound_, "-", a, b};
        }
        if (a.is_place_ && b.is_place_)
            return {a.x_ - b.x_, std::max(a.bound_, b.bound_), "-", a, b};
        return {a.x_ - b.x_, a.bound_ + b.bound_, "-", a, b};
    }
    fixed_integer operator-() const { return {-x_, bound_, "opposite", *this, *this}; }
    friend fixed_integer operator<<(const fixed_integer& x, int bits) {
        return {x.x_ << bits, x.bound_ << bits, "<<", x, x};
    }
    friend bool operator==(const fixed_integer& a, const fixed_integer& b) { return a.x_ == b.x_; }
    friend std::strong_ordering operator<=>(const fixed_integer& a, const fixed_integer& b) {
        return a.x_ <=> b.x_;
    }
    friend sign_type sign_of(const fixed_integer& x) { return sign_of(x.x_); }
    int bit_length() const { return x_.bit_length(); }

    template <int Result>
    fixed_integer<Result> from_bit(int shift) const {
        return {x_.template from_bit<Result>(shift), (bound_ >> shift) + 1, "from_bit"};
    }
    /// Modulo 2^64, where that is meant.
    std::int64_t word_from_bit(int shift) const { return x_.word_from_bit(shift); }
    /// The number, which has to fit.
    std::int64_t low_word() const {
        if (counted.on && !(numbers(x_.low_word()) == x_)) told("low_word");
        return x_.low_word();
    }
    template <int B>
    fixed_integer<Words + B> times(const fixed_integer<B>& b) const {
        fixed_integer<Words + B> r{x_ * b.x_, bound_ * b.bound_, "*"};
        if (counted.on && (difference_bits_ >= 0 || b.difference_bits_ >= 0)) told("*");
        return r;
    }

  private:
    template <int>
    friend class fixed_integer;

    fixed_integer(const numbers& x, const bound_type& bound, const char* how) : x_(x) {
        known(bound, how);
    }
    fixed_integer(const numbers& x, const bound_type& bound, const char* how,
                  const fixed_integer& a, const fixed_integer& b)
        : fixed_integer(x, bound, how) {
        if (counted.on && (a.difference_bits_ >= 0 || b.difference_bits_ >= 0)) told(how);
    }
    void known(const bound_type& bound, const char* how) {
        if (!counted.on) return;
        bound_ = bound;
        ++counted.numbers;
        const int bits = bound_ == 0 ? 0 : static_cast<int>(boost::multiprecision::msb(bound_)) + 1;
        counted.fullest[Words] = std::max(counted.fullest[Words], bits);
        if (bits >= width) told(how);
    }
    static void told(const char* how) {
        if (counted.beyond++ == 0)
            counted.first = std::string(how) + " in " + std::to_string(Words) + " words";
    }

    numbers x_;
    mutable bound_type bound_ = 0;
    mutable bool is_place_ = false;
    bool is_unit_ = false;
    int difference_bits_ = -1;
};

template <int A, int B>
fixed_integer<A + B> operator*(const fixed_integer<A>& a, const fixed_integer<B>& b) {
    return a.times(b);
}
template <int Words>
fixed_integer<Words> scale(const fixed_integer<Words>& x, int e) {
    return x << e;
}

}  // namespace errbound::integers
