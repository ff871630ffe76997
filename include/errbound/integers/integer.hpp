// An integer of any size, errbound::integer.
//   errbound::integer x = 5;
//   x = (x << 100) + 1;  // built-in integers convert implicitly
//   const auto y = errbound::integer::from_string("-12345678901234567890");
//   std::cout << x * y / 7 << ' ' << gcd(x, y) << '\n';
//
// Operators as for built-in integers: quotients truncate, x = x/y·y + x % y, and x >> n is ⌊x/2^n⌋.
// Throws std::bad_alloc if memory runs out or at 2^31 bits, and then changes no number.
// Preconditions (asserted): nonzero divisors, finite doubles, shifts >= 0. Numbers of up to 256
// bits need no allocation. Cost: schoolbook arithmetic, Karatsuba's for long products.
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <compare>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <errbound/detail/bits.hpp>
#include <errbound/integers/binary_double.hpp>
#include <errbound/integers/magnitudes.hpp>
#include <errbound/sign.hpp>
#include <iosfwd>
#include <limits>
#include <memory>
#include <new>
#include <numeric>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

namespace errbound {

namespace integers {

/// A built-in integer of at most 64 bits. (With some compiler options std::integral includes wider
/// types.)
template <class T>
concept built_in_integer = std::integral<T> && sizeof(T) <= sizeof(words::word);

template <built_in_integer T>
constexpr bool is_negative(T x) {
    if constexpr (std::is_signed_v<T>) return x < 0;
    return false;
}

/// Scratch words, on the stack if they are few.
class scratch_words {
    static constexpr int few = 64;

  public:
    explicit scratch_words(int n)
        : many_(n > few ? new words::word[static_cast<std::size_t>(n)] : nullptr) {}
    words::word* data() { return many_ ? many_.get() : few_; }

  private:
    std::unique_ptr<words::word[]> many_;
    words::word few_[few];
};

}  // namespace integers

/// An integer of any size. Cost, limits and exceptions: head of errbound/integers/integer.hpp.
class integer {
    using word = integers::words::word;
    using double_word = integers::words::double_word;

  public:
    integer() noexcept = default;
    template <integers::built_in_integer T>
    integer(T value) noexcept {
        const bool negative = integers::is_negative(value);
        few_[0] = negative ? 0 - static_cast<word>(value) : static_cast<word>(value);
        size_ = negative ? -1 : few_[0] != 0;
    }
    /// Truncates towards zero.
    explicit integer(double value) {
        assert(std::isfinite(value));
        const integers::binary_double d(value);
        *this = integer(d.exponent < 0 ? d.magnitude >> (std::min)(-d.exponent, 63) : d.magnitude)
                << (std::max)(d.exponent, 0);
        if (d.negative) size_ = -size_;
    }
    integer(const integer& x) : size_(x.size_) {
        if (const int n = x.size(); n > inline_words) {
            many_ = new_words(n);
            capacity_ = n;
            std::copy_n(x.many_, n, many_);
        } else {
            copy_few(x.data(), n, few_);
        }
    }
    integer(integer&& x) noexcept { take(x); }
    integer& operator=(const integer& x) {
        if (this == &x) return *this;
        const int n = x.size();
        if (n > capacity_) adopt(room_for(n));
        if (n > inline_words)
            std::copy_n(x.many_, n, many_);
        else
            copy_few(x.data(), n, data());
        size_ = x.size_;
        return *this;
    }
    /// A moved-from integer is zero.
    integer& operator=(integer&& x) noexcept {
        if (this == &x) return *this;
        release();
        take(x);
        return *this;
    }
    ~integer() { release(); }

    /// Modulo 2^(bits of T), as built-in conversions.
    template <integers::built_in_integer T>
    explicit operator T() const {
        if constexpr (std::is_same_v<T, bool>)
            return size_ != 0;
        else
            return static_cast<T>(size_ < 0 ? 0 - low_word() : low_word());
    }
    explicit operator double() const;  ///< the nearest, ties to even; infinite beyond the largest

    friend integer operator+(const integer& a, const integer& b) {
        integer r;
        r.assign_sum(a, b, false);
        return r;
    }
    friend integer operator+(integer&& a, const integer& b) { return std::move(a += b); }
    friend integer operator-(const integer& a, const integer& b) {
        integer r;
        r.assign_sum(a, b, true);
        return r;
    }
    friend integer operator-(integer&& a, const integer& b) { return std::move(a -= b); }
    integer& operator+=(const integer& b) {
        assign_sum(*this, b, false);
        return *this;
    }
    integer& operator-=(const integer& b) {
        assign_sum(*this, b, true);
        return *this;
    }
    friend integer operator-(integer x) noexcept {
        x.size_ = -x.size_;
        return x;
    }
    friend integer abs(integer x) noexcept {
        x.size_ = x.size();
        return x;
    }
    integer& operator++() { return *this += 1; }
    integer& operator--() { return *this -= 1; }

    friend integer operator*(const integer& a, const integer& b) {
        integer r;
        r.assign_product(a, b);
        return r;
    }
    friend integer operator/(const integer& a, const integer& b) {
        integer r;
        r.assign_quotient(a, b);
        return r;
    }
    friend integer operator%(const integer& a, const integer& b) {
        integer r;
        r.assign_remainder(a, b);
        return r;
    }
    integer& operator*=(const integer& b) {
        assign_product(*this, b);
        return *this;
    }
    integer& operator/=(const integer& b) {
        assign_quotient(*this, b);
        return *this;
    }
    integer& operator%=(const integer& b) {
        assign_remainder(*this, b);
        return *this;
    }

    friend integer operator<<(const integer& x, std::integral auto n) {
        integer r;
        r.assign_shifted_left(x, shift(n));
        return r;
    }
    friend integer operator>>(const integer& x, std::integral auto n) {
        integer r;
        r.assign_shifted_right(x, shift(n));
        return r;
    }
    friend integer operator>>(integer&& x, std::integral auto n) { return std::move(x >>= n); }
    integer& operator<<=(std::integral auto n) {
        assign_shifted_left(*this, shift(n));
        return *this;
    }
    integer& operator>>=(std::integral auto n) {
        assign_shifted_right(*this, shift(n));
        return *this;
    }
    friend integer scale(const integer& x, int e) { return x << e; }
    /// ⌊log2 |x|⌋, the position of the highest bit set; lsb returns that of the lowest.
    /// Precondition: x is not zero.
    friend int msb(const integer& x) {
        assert(x.size_ != 0);
        return 64 * x.size() - 1 - detail::countl_zero(x.data()[x.size() - 1]);
    }
    friend int floor_log2(const integer& x) { return msb(x); }
    friend int lsb(const integer& x) {
        assert(x.size_ != 0);
        int i = 0;
        while (x.data()[i] == 0) ++i;
        return 64 * i + detail::countr_zero(x.data()[i]);
    }

    friend bool operator==(const integer& a, const integer& b) noexcept {
        return a.size_ == b.size_ && std::equal(a.data(), a.data() + a.size(), b.data());
    }
    friend std::strong_ordering operator<=>(const integer& a, const integer& b) noexcept {
        if (a.size_ != b.size_) return a.size_ <=> b.size_;
        return a.size_ < 0 ? integers::words::compare(b.data(), a.data(), a.size())
                           : integers::words::compare(a.data(), b.data(), a.size());
    }
    template <integers::built_in_integer T>
    friend bool operator==(const integer& a, T b) noexcept {
        return b == 0 ? a.size_ == 0 : a == integer(b);
    }
    template <integers::built_in_integer T>
    friend std::strong_ordering operator<=>(const integer& a, T b) noexcept {
        return b == 0 ? a.size_ <=> 0 : a <=> integer(b);
    }

    /// Reads digits in base 2 to 36 after an optional sign. Throws std::invalid_argument for any
    /// other text.
    static integer from_string(std::string_view digits, int base = 10);
    friend std::string to_string(const integer& x, int base = 10) { return x.text(base); }
    template <class Traits>
    friend std::basic_ostream<char, Traits>& operator<<(std::basic_ostream<char, Traits>& out,
                                                        const integer& x) {
        return out << x.text(10).c_str();
    }

    /// At least 0; 0 if both are 0.
    friend integer gcd(integer a, integer b) { return common_divisor(a, b); }
    /// At least 0; 0 if one is 0.
    friend integer lcm(const integer& a, const integer& b) {
        if (a == 0 || b == 0) return 0;
        return abs(a / gcd(a, b) * b);
    }

  private:
    static constexpr int inline_words = 4;
    static constexpr int max_words = (std::numeric_limits<int>::max)() / 64;

    /// Words for a result: the number's own words if they suffice, otherwise new words. So the
    /// number itself may be an operand, and nothing changes if memory runs out.
    struct room {
        word* words;
        int capacity;
    };

    word* data() noexcept { return capacity_ > inline_words ? many_ : few_; }
    const word* data() const noexcept { return capacity_ > inline_words ? many_ : few_; }
    int size() const noexcept { return size_ < 0 ? -size_ : size_; }
    word low_word() const noexcept { return size_ == 0 ? 0 : data()[0]; }

    static word* new_words(int n) {
        if (n > max_words) throw std::bad_alloc();
        return new word[static_cast<std::size_t>(n)];
    }
    room room_for(int n) {
        if (n <= capacity_) return {data(), capacity_};
        const int capacity = (std::max)(n, capacity_ + capacity_ / 2);
        return {new_words(capacity), capacity};
    }
    /// Takes the words written to `from`, without leading zeros.
    void keep(const room& from, int size, bool negative) noexcept {
        if (from.words != data()) adopt(from);
        size = integers::words::trimmed(from.words, size);
        size_ = negative ? -size : size;
    }
    void adopt(const room& from) noexcept {
        release();
        many_ = from.words;
        capacity_ = from.capacity;
    }
    /// Copies word by word, since loading pairs of words that were just stored singly stalls.
    static void copy_few(const word* from, int n, word* to) noexcept {
        if (n > 0) to[0] = from[0];
        if (n > 1) to[1] = from[1];
        if (n > 2) to[2] = from[2];
        if (n > 3) to[3] = from[3];
    }
    void release() noexcept {
        if (capacity_ > inline_words) delete[] many_;
    }
    void take(integer& x) noexcept {
        // Copying size and capacity together would load both as one word, which stalls.
        size_ = x.size_;
        if (x.capacity_ > inline_words) {
            capacity_ = x.capacity_;
            many_ = x.many_;
        } else {
            capacity_ = inline_words;
            for (int i = 0; i < inline_words; ++i) few_[i] = x.few_[i];
        }
        x.size_ = 0;
        x.capacity_ = inline_words;
    }
    void assign_words(word low, word high, bool negative) noexcept {
        word* const to = data();
        to[0] = low;
        to[1] = high;
        const int size = high != 0 ? 2 : low != 0;
        size_ = negative ? -size : size;
    }

    static std::uint64_t shift(std::integral auto n) {
        assert(!integers::is_negative(n));
        return static_cast<std::uint64_t>(n);
    }

    void assign_sum(const integer& a, const integer& b, bool subtract) {
        const bool a_negative = a.size_ < 0, b_negative = (b.size_ < 0) != subtract;
        if (a.size() > 1 || b.size() > 1) {
            if (a_negative == b_negative || b.size_ == 0)
                assign_larger(a, b, a_negative);
            else
                assign_difference(a, b, a_negative);
            return;
        }
        // In two's complement without branches: signs are often unpredictable.
        const word x = a.low_word(), y = b.low_word();
        const word if_x = 0 - word(a_negative), if_y = 0 - word(b_negative);
        const word s = (x ^ if_x) - if_x, t = (y ^ if_y) - if_y, low = s + t;
        const word high = (x == 0 ? 0 : if_x) + (y == 0 ? 0 : if_y) + (low < s);
        const word if_sum = integers::words::sign_word(high);
        const word size = (low ^ if_sum) - if_sum;
        assign_words(size, (high ^ if_sum) + (if_sum & word(size == 0)), if_sum != 0);
    }
    void assign_larger(const integer& a, const integer& b, bool negative) {
        const integer &longer = a.size() < b.size() ? b : a, &shorter = a.size() < b.size() ? a : b;
        const int m = longer.size(), n = shorter.size();
        const bool carries = longer.data()[m - 1] >= ~(n == m ? shorter.data()[m - 1] : word(0));
        const room to = room_for(m + carries);
        const word carry = integers::words::add(to.words, longer.data(), m, shorter.data(), n);
        if (carries) to.words[m] = carry;
        keep(to, m + carries, negative);
    }
    void assign_difference(const integer& a, const integer& b, bool negative) {
        const int m = a.size(), n = b.size();
        const bool a_is_larger =
            m != n ? m > n : integers::words::compare(a.data(), b.data(), m) >= 0;
        const integer &larger = a_is_larger ? a : b, &other = a_is_larger ? b : a;
        const room to = room_for(larger.size());
        integers::words::subtract(to.words, larger.data(), larger.size(), other.data(),
                                  other.size());
        keep(to, larger.size(), negative == a_is_larger);
    }

    void assign_product(const integer& a, const integer& b) {
        const bool negative = (a.size_ < 0) != (b.size_ < 0);
        if (a.size() <= 1 && b.size() <= 1) {
            const auto product = double_word(a.low_word()) * b.low_word();
            assign_words(static_cast<word>(product), static_cast<word>(product >> 64), negative);
        } else if (a.size() < b.size()) {
            assign_long_product(b, a, negative);
        } else {
            assign_long_product(a, b, negative);
        }
    }
    void assign_long_product(const integer& longer, const integer& shorter, bool negative) {
        constexpr int few = 16;
        const int m = longer.size(), n = shorter.size();
        const bool is_operand = this == &longer || this == &shorter;
        if (n <= 1) {
            const word factor = shorter.low_word();
            const bool carries =
                detail::bit_width(factor) + detail::bit_width(longer.data()[m - 1]) > 64;
            const room to = room_for(m + carries);
            const word carry =
                integers::words::multiply_by_word(to.words, longer.data(), m, factor);
            if (carries) to.words[m] = carry;
            keep(to, m + carries, negative);
        } else if (m + n <= few && (is_operand || m + n == capacity_ + 1)) {
            word product[few];
            integers::words::multiply_rows(product, shorter.data(), n, longer.data(), m);
            const int size = m + n - (product[m + n - 1] == 0);
            const room to = room_for(size);
            std::copy_n(product, size, to.words);
            keep(to, size, negative);
        } else {
            integers::scratch_words scratch(integers::words::product_scratch(n));
            const room to = is_operand ? room{new_words(m + n), m + n} : room_for(m + n);
            integers::words::multiply_natural(to.words, longer.data(), m, shorter.data(), n,
                                              scratch.data());
            keep(to, m + n, negative);
        }
    }

    void assign_quotient(const integer& a, const integer& b) {
        assert(b.size_ != 0);
        const bool negative = (a.size_ < 0) != (b.size_ < 0);
        const int m = a.size(), n = b.size();
        if (m < n) {
            size_ = 0;
        } else if (m <= 1) {
            assign_words(a.low_word() / b.low_word(), 0, negative);
        } else {
            const int size = m - n + 1;
            if (n == 1) {
                const word divisor = b.low_word();
                const room to = room_for(size);
                integers::words::divide_by_word(a.data(), m, divisor,
                                                [&](int i, word q) { to.words[i] = q; });
                keep(to, size, negative);
            } else {
                long_division by(a, b);
                const room to = room_for(size);
                by.divide([&](int i, word q) { to.words[i] = q; });
                keep(to, size, negative);
            }
        }
    }
    void assign_remainder(const integer& a, const integer& b) {
        assert(b.size_ != 0);
        const bool negative = a.size_ < 0;
        const int m = a.size(), n = b.size();
        if (m < n) {
            *this = a;
        } else if (m <= 1) {
            assign_words(a.low_word() % b.low_word(), 0, negative);
        } else if (n == 1) {
            assign_words(
                integers::words::divide_by_word(a.data(), m, b.low_word(), [](int, word) {}), 0,
                negative);
        } else {
            long_division by(a, b);
            const room to = room_for(n);
            by.divide([](int, word) {});
            by.take_remainder(to.words);
            keep(to, n, negative);
        }
    }
    /// Copies of a and b, shifted so that b's first bit is set. Precondition: 2 <= b's size <= a's.
    class long_division {
      public:
        long_division(const integer& a, const integer& b)
            : m_(a.size()),
              n_(b.size()),
              shift_(detail::countl_zero(b.data()[n_ - 1])),
              copies_(m_ + 1 + n_),
              a_(copies_.data()),
              b_(a_ + m_ + 1) {
            a_[m_] = integers::words::shift_left(a_, a.data(), m_, shift_);
            integers::words::shift_left(b_, b.data(), n_, shift_);
        }
        template <class Store>
        void divide(const Store& store) {
            integers::words::divide_long(a_, m_, b_, n_, store);
        }
        void take_remainder(word* to) const { integers::words::shift_right(to, a_, n_, shift_); }

      private:
        int m_, n_, shift_;
        integers::scratch_words copies_;
        word *a_, *b_;
    };

    void assign_shifted_left(const integer& x, std::uint64_t n) {
        const int m = x.size();
        if (m == 0 || n == 0) {
            *this = x;
            return;
        }
        if (n / 64 >= max_words) throw std::bad_alloc();
        const int whole = static_cast<int>(n / 64), bits = static_cast<int>(n % 64);
        const bool carries = x.data()[m - 1] >> 1 >> (63 - bits) != 0;
        const room to = room_for(m + whole + carries);
        const word beyond = integers::words::shift_left(to.words + whole, x.data(), m, bits);
        std::fill_n(to.words, whole, word(0));
        if (carries) to.words[m + whole] = beyond;
        keep(to, m + whole + carries, x.size_ < 0);
    }
    void assign_shifted_right(const integer& x, std::uint64_t n) {
        const int m = x.size();
        const bool negative = x.size_ < 0;
        if (n / 64 >= static_cast<std::uint64_t>(m)) {
            assign_words(negative, 0, true);
            return;
        }
        const int whole = static_cast<int>(n / 64), bits = static_cast<int>(n % 64);
        const bool up = negative && static_cast<std::uint64_t>(lsb(x)) < n;  // ⌊−a/2^n⌋ = −⌈a/2^n⌉
        const int size = m - whole;
        const room to = room_for(size + up);
        integers::words::shift_right(to.words, x.data() + whole, size, bits);
        if (up) {
            constexpr word one = 1;
            to.words[size] = integers::words::add(to.words, to.words, size, &one, 1);
        }
        keep(to, size + up, negative);
    }

    /// Lehmer's steps for a >= b > 0, b of at least three words, or one division.
    static void euclid_steps(integer& a, integer& b) {
        const int n = a.size(), shift = detail::countl_zero(a.data()[n - 1]);
        const auto first_bits = [&](const integer& x) {
            const auto word_at = [&](int i) { return i < x.size() ? x.data()[i] : 0; };
            return word_at(n - 1) << shift | word_at(n - 2) >> 1 >> (63 - shift);
        };
        const auto steps = integers::words::common_steps(first_bits(a), first_bits(b));
        if (steps.none()) {
            a %= b;
            std::swap(a, b);
        } else {
            const room to = b.room_for(n);
            std::copy_n(b.data(), b.size(), to.words);
            std::fill_n(to.words + b.size(), n - b.size(), word(0));
            integers::words::apply(steps, a.data(), to.words, n);
            a.keep({a.data(), a.capacity_}, n, false);
            b.keep(to, n, false);
        }
    }
    static integer common_divisor(integer& a, integer& b) {
        a.size_ = a.size();
        b.size_ = b.size();
        if (a < b) std::swap(a, b);
        while (b.size_ > 2) euclid_steps(a, b);
        if (a.size_ > 2 && b.size_ != 0) {
            a %= b;
            std::swap(a, b);
        }
        if (b.size_ == 0) return std::move(a);
        const int twos = (std::min)(lsb(a), lsb(b));
        const auto odd = [](const integer& x) {
            return integers::words::odd_part({x.size() > 1 ? x.data()[1] : 0, x.data()[0]});
        };
        const auto divisor = integers::words::odd_common_divisor(odd(a), odd(b));
        a.assign_words(divisor.low, divisor.high, false);
        return std::move(a <<= twos);
    }

    std::string text(int base) const;

    int size_ = 0;  ///< words of the magnitude, the last not 0; negated for negative numbers
    int capacity_ = inline_words;
    union {
        word few_[inline_words] = {};
        word* many_;  ///< if the capacity is larger
    };
};

template <>
inline constexpr bool is_exact_number<integer> = true;

inline integer::operator double() const {
    const int excess = size() <= 1 ? 0 : msb(*this) - 63;
    if (excess <= 0) {
        const auto x = static_cast<double>(low_word());
        return size_ < 0 ? -x : x;
    }
    // Takes the first 64 bits and sets the last if any later bit is set. They round to the same
    // double.
    const int whole = excess / 64, bits = excess % 64;
    const word* const w = data();
    word head = w[whole] >> bits;
    if (bits > 0) head |= w[whole + 1] << (64 - bits);
    head |= lsb(*this) < excess;
    const double x = std::ldexp(static_cast<double>(head), excess);
    return size_ < 0 ? -x : x;
}

namespace integers {

struct power_in_word {
    words::word power = 1;
    int digits = 0;

    constexpr explicit power_in_word(int base) {
        const auto b = static_cast<words::word>(base);
        for (; power <= ~words::word(0) / b; ++digits) power *= b;
    }
};

}  // namespace integers

inline std::string integer::text(int base) const {
    assert(2 <= base && base <= 36);
    if (size_ == 0) return "0";
    const integers::power_in_word piece(base);
    std::string reversed;
    for (integer rest = *this; rest.size_ != 0;) {
        // Computes the remainder first, since the quotient overwrites the number.
        word digits = integer(rest % integer(piece.power)).low_word();
        rest /= integer(piece.power);
        for (int i = 0; i < piece.digits && (digits != 0 || rest.size_ != 0); ++i) {
            reversed += "0123456789abcdefghijklmnopqrstuvwxyz"[digits % static_cast<word>(base)];
            digits /= static_cast<word>(base);
        }
    }
    if (size_ < 0) reversed += '-';
    return {reversed.rbegin(), reversed.rend()};
}

inline integer integer::from_string(std::string_view digits, int base) {
    assert(2 <= base && base <= 36);
    const bool negative = digits.starts_with('-');
    if (negative || digits.starts_with('+')) digits.remove_prefix(1);
    if (digits.empty())
        throw std::invalid_argument(
            "errbound::integer: number has no digits; expected at least one");
    const auto value_of = [&](char c) {
        const int value = c >= '0' && c <= '9'   ? c - '0'
                          : c >= 'a' && c <= 'z' ? c - 'a' + 10
                          : c >= 'A' && c <= 'Z' ? c - 'A' + 10
                                                 : base;
        if (value >= base)
            throw std::invalid_argument(
                "errbound::integer: a character is not a digit; expected digits of the base");
        return static_cast<word>(value);
    };
    const auto b = static_cast<word>(base);
    const auto at_once = static_cast<std::size_t>(integers::power_in_word(base).digits);
    integer x;
    while (!digits.empty()) {
        word piece = 0, power = 1;
        for (const char c : digits.substr(0, at_once)) {
            piece = piece * b + value_of(c);
            power *= b;
        }
        x *= integer(power);
        x += integer(piece);
        digits.remove_prefix((std::min)(at_once, digits.size()));
    }
    return negative ? -std::move(x) : x;
}

}  // namespace errbound

template <>
class std::numeric_limits<errbound::integer> {
    using integer = errbound::integer;

  public:
    static constexpr bool is_specialized = true, is_signed = true, is_integer = true,
                          is_exact = true;
    static constexpr bool is_bounded = false, is_modulo = false, is_iec559 = false, traps = false,
                          tinyness_before = false;
    static constexpr bool has_infinity = false, has_quiet_NaN = false, has_signaling_NaN = false,
                          has_denorm_loss = false;
    static constexpr float_denorm_style has_denorm = denorm_absent;
    static constexpr float_round_style round_style = round_toward_zero;
    /// Numbers are unbounded: there is no largest one, and digits has no meaning.
    static constexpr int radix = 2, digits = 0, digits10 = 0, max_digits10 = 0, min_exponent = 0,
                         min_exponent10 = 0, max_exponent = 0, max_exponent10 = 0;
    static integer(min)() { return 0; }
    static integer(max)() { return 0; }
    static integer lowest() { return 0; }
    static integer epsilon() { return 0; }
    static integer round_error() { return 0; }
    static integer infinity() { return 0; }
    static integer quiet_NaN() { return 0; }
    static integer signaling_NaN() { return 0; }
    static integer denorm_min() { return 0; }
};
