// The number of a binary format nearest to a decimal, and its distance rounded up.
//   constexpr auto x = errbound::integers::nearest_decimal<double>(decimal_text("0.1"));
//   x.value;  // 0.1
//   x.error;  // |0.1 - x.value|, rounded up to a double
//
// Rounds once, to nearest, ties to even, by integers only: independent of the rounding direction.
// No allocation, no exceptions. Cost: 38 digits and a power of five of 128 bits almost always
// suffice. Otherwise products are as long as the exact decimal of a midpoint of two numbers (stack:
// 2 KiB for double, 24 for binary128).
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <errbound/detail/power_of_two.hpp>
#include <errbound/integers/magnitudes.hpp>
#include <errbound/number_traits.hpp>
#include <string_view>
#include <type_traits>

namespace errbound::integers {

using words::word;
using words::word_pair;

/// [+-]d...[.d...][(e|E)[+-]d...] as ±digits·10^exponent. Skips a literal's digit separators.
class decimal_text {
  public:
    static constexpr int leading_digits = 38;  ///< two words hold this many

    constexpr explicit decimal_text(std::string_view text) {
        std::size_t i = 0;
        negative_ = sign(text, i);
        bool well_formed = read_digits(text, i);
        if (well_formed && i < text.size() && (text[i] == 'e' || text[i] == 'E')) {
            ++i;
            const bool minus = sign(text, i);
            well_formed = is_digit(text, i);
            // Saturates at more than any text's length, so that no number of digits compensates.
            constexpr std::int64_t most = std::int64_t{1} << 58;
            std::int64_t e = 0;
            for (; is_digit(text, i); ++i) e = e < most / 10 ? 10 * e + (text[i] - '0') : most;
            exponent_ += minus ? -e : e;
        }
        well_formed_ = well_formed && i == text.size();
    }

    constexpr bool well_formed() const { return well_formed_; }
    constexpr bool negative() const { return negative_; }
    constexpr bool is_zero() const { return digits_ == 0; }
    /// n with 10^(n-1) <= |x| < 10^n. Precondition: x is not zero.
    constexpr std::int64_t magnitude() const { return digits_ + exponent_; }
    /// The first digits, at most 38, as an integer.
    constexpr word_pair leading() const {
        const auto more = static_cast<int>(std::min<std::int64_t>(digits_, leading_digits)) - 19;
        if (more <= 0) return {0, first_};
        word power = 1;
        for (int k = 0; k < more; ++k) power *= 10;
        word low = 0;
        const word high = words::multiply_by_word(&low, &first_, 1, power, next_);
        return {high, low};
    }
    constexpr std::int64_t leading_exponent() const {
        return exponent_ + std::max<std::int64_t>(digits_ - leading_digits, 0);
    }
    constexpr bool leading_is_all() const { return !has_rest_; }
    constexpr std::int64_t digits() const { return digits_; }
    constexpr std::int64_t exponent() const { return exponent_; }
    /// Calls visit(digit) for the first `count` digits. Returns true if a later digit is not zero.
    template <class Visit>
    constexpr bool for_digits(std::int64_t count, const Visit& visit) const {
        for (const char c : significant_) {
            if (c < '0' || c > '9') continue;
            if (count-- > 0)
                visit(static_cast<word>(c - '0'));
            else if (c != '0')
                return true;
        }
        return false;
    }

  private:
    static constexpr bool sign(std::string_view text, std::size_t& i) {
        const bool minus = i < text.size() && text[i] == '-';
        if (minus || (i < text.size() && text[i] == '+')) ++i;
        return minus;
    }
    static constexpr bool is_digit(std::string_view text, std::size_t i) {
        return i < text.size() && text[i] >= '0' && text[i] <= '9';
    }
    constexpr bool read_digits(std::string_view text, std::size_t& i) {
        std::size_t at = i, first = i;  // local variables stay in registers
        std::int64_t all = 0, count = 0, before_point = -1;
        word value = 0;
        for (; at < text.size(); ++at) {
            const auto digit = static_cast<word>(text[at]) - word{'0'};
            if (digit <= 9) {
                ++all;
                if (count == 0) {
                    if (digit == 0) continue;
                    first = at;
                } else if (count == 19) {
                    first_ = value;
                    value = 0;
                }
                if (count++ < leading_digits)
                    value = 10 * value + digit;
                else
                    has_rest_ = has_rest_ || digit != 0;
            } else if (text[at] == '.' && before_point < 0) {
                before_point = all;
            } else if (text[at] != '\'' || at == 0 || !is_digit(text, at - 1) ||
                       !is_digit(text, at + 1)) {
                break;
            }
        }
        (count > 19 ? next_ : first_) = value;
        digits_ = count;
        exponent_ = before_point < 0 ? 0 : before_point - all;
        significant_ = text.substr(first, at - first);
        i = at;
        return all > 0;
    }

    std::string_view significant_;  ///< from the first nonzero digit
    std::int64_t digits_ = 0, exponent_ = 0;
    word first_ = 0, next_ = 0;
    bool well_formed_ = false, negative_ = false, has_rest_ = false;
};

/// A number in [m, m + error]·2^exponent; m has 128 bits, the first one set.
struct leading_bits {
    word_pair m;
    int exponent;
    word error;
};

/// x·2^n modulo 2^128, 0 <= n <= 128.
constexpr word_pair shifted_up(word_pair x, int n) {
    if (n >= 64) return {n >= 128 ? 0 : x.low << (n - 64), 0};
    return {x.high << n | x.low >> 1 >> (63 - n), x.low << n};
}
constexpr word_pair shifted_down(word_pair x, int n) {
    if (n >= 64) return {0, n >= 128 ? 0 : x.high >> (n - 64)};
    return {x.high >> n, x.low >> n | x.high << 1 << (63 - n)};
}
constexpr word_pair sum_of(word_pair x, word y) {
    const word low = x.low + y;
    return {x.high + (low < y ? 1 : 0), low};
}
constexpr word_pair difference_of(word_pair x, word_pair y) {
    return {x.high - y.high - (x.low < y.low ? 1 : 0), x.low - y.low};
}
constexpr int width_of(word_pair x) {
    return static_cast<int>(x.high != 0 ? 64 + std::bit_width(x.high) : std::bit_width(x.low));
}

/// x·2^exponent with the error of x. Precondition: x is not zero.
constexpr leading_bits normalized(word_pair x, int exponent, word error) {
    const int shift = 128 - width_of(x);
    return {shifted_up(x, shift), exponent - shift, error == 0 ? 0 : error << shift};
}
/// (a + s)(b + t) exceeds ab by at most 2^128·(s + t) + st, or twice that if it is shifted by a
/// bit. Truncation loses less than a unit.
constexpr leading_bits operator*(const leading_bits& a, const leading_bits& b) {
    const std::array<word, 2> x{a.m.low, a.m.high}, y{b.m.low, b.m.high};
    std::array<word, 4> r{};
    words::multiply_rows(r.data(), x.data(), 2, y.data(), 2);
    const int shift = std::countl_zero(r[3]);  // at most 1
    const word_pair m = shift == 0 ? word_pair{r[3], r[2]}
                                   : word_pair{r[3] << 1 | r[2] >> 63, r[2] << 1 | r[1] >> 63};
    const bool cut = (r[1] << shift | r[0]) != 0;
    const bool exact = a.error == 0 && b.error == 0;
    return {m, a.exponent + b.exponent + 128 - shift,
            exact ? word{cut} : 2 * (a.error + b.error) + 2};
}

struct squares_of_five {
    static constexpr int count = 13;
    std::array<leading_bits, count> up{}, down{};
    constexpr squares_of_five() {
        constexpr word fifth = 0xcccccccccccccccc;
        up[0] = normalized({0, 5}, 0, 0);
        down[0] = {{fifth, fifth}, -130, 1};
        for (std::size_t i = 1; i < count; ++i) {
            up[i] = up[i - 1] * up[i - 1];
            down[i] = down[i - 1] * down[i - 1];
        }
    }
};
inline constexpr squares_of_five squares;
inline constexpr auto small_powers_of_five = [] {
    std::array<word, 28> powers{1};
    for (std::size_t i = 1; i < powers.size(); ++i) powers[i] = 5 * powers[i - 1];
    return powers;
}();

/// The leading digits times their power of ten, at most 5^±8191.
constexpr leading_bits leading_bits_of(const decimal_text& text) {
    word_pair digits = text.leading();
    int e = static_cast<int>(text.leading_exponent());
    const int binary = e;
    const word error = text.leading_is_all() ? 0 : 1;
    if (e < 0 && -e < static_cast<int>(small_powers_of_five.size()) && digits.high == 0) {
        const word power = small_powers_of_five[static_cast<std::size_t>(-e)];
        if (digits.low % power == 0) {
            digits.low /= power;
            e = 0;
        }
    }
    leading_bits x = normalized(digits, binary, error);
    const auto& powers = e < 0 ? squares.down : squares.up;
    auto rest = static_cast<unsigned>(e < 0 ? -e : e);
    for (std::size_t i = 0; rest != 0; ++i, rest >>= 1)
        if ((rest & 1) != 0) x = x * powers[i];
    return x;
}

struct rounded_decimal {
    word_pair units;
    int unit;
    word_pair distance;
    int distance_unit;
    bool certain;
};

/// Numbers of T up to 2^end are multiples of 2^unit_of(end).
template <class T>
struct binary_format {
    using traits = number_traits<T>;
    static constexpr int digits = traits::digits;
    static constexpr int least = traits::min_exponent - digits;  ///< 2^least is the smallest number
    static constexpr int unit_of(int end) { return (std::max)(end - digits, least); }
    static_assert(has_subnormals<T> && digits <= 113 && traits::max_exponent <= 16384,
                  "errbound: decimals need a binary format with subnormal numbers and at most "
                  "113 bits");

    /// units·2^unit. Precondition: units <= 2^digits, and the result is finite.
    static constexpr T number(word_pair units, int unit) {
        if constexpr (std::is_same_v<T, double>) {
            // The first bit adds 1 to the exponent field.
            return std::bit_cast<double>((static_cast<word>(unit - least) << 52) + units.low);
        } else if constexpr (digits < 53) {
            return static_cast<T>(static_cast<double>(units.low) * detail::power_of_two(unit));
        } else {
            T x = static_cast<T>(units.low);
            if (units.high != 0) x = traits::scale(static_cast<T>(units.high), 64) + x;
            return traits::scale(x, unit);
        }
    }
    static constexpr T rounded_up(word_pair x, int exponent) {
        if (width_of(x) == 0) return T(0);
        const int unit = unit_of(exponent + width_of(x)), drop = unit - exponent;
        if (drop <= 0) return number(shifted_up(x, -drop), unit);
        const word_pair units = shifted_down(x, (std::min)(drop, 128));
        const bool cut = drop > 128 || shifted_up(units, drop) != x;
        return number(sum_of(units, cut ? 1 : 0), unit);
    }
    /// Certain only if [m, m + error] rounds to one number and the distance is known to 1/1000.
    static constexpr rounded_decimal rounded(const leading_bits& x) {
        const int unit = unit_of(x.exponent + 128), drop = unit - x.exponent;
        const word_pair end = sum_of(x.m, x.error);
        if (drop > 128) return {{0, 0}, unit, end, x.exponent, x.m <= end};
        const word_pair units = shifted_down(x.m, drop), half = shifted_up({0, 1}, drop - 1);
        const word_pair rest = difference_of(x.m, shifted_up(units, drop));
        const bool up = rest > half || (rest == half && units.low % 2 == 1);
        const word_pair to_next = difference_of(shifted_up({0, 1}, drop), rest);
        rounded_decimal r{sum_of(units, up ? 1 : 0), unit, up ? to_next : rest, x.exponent, true};
        if (x.error == 0) return r;
        // Both ends of [m, m + error] must be far from the number and on one side of half.
        const word_pair to_half = up ? difference_of(rest, half) : difference_of(half, rest);
        const word_pair least_distance = up ? difference_of(r.distance, {0, x.error}) : r.distance;
        r.certain = x.error < (word{1} << 40) && is_far(to_half, x.error) &&
                    is_far(r.distance, x.error) && is_far(least_distance, x.error);
        if (!up) r.distance = sum_of(r.distance, x.error);
        return r;
    }

  private:
    static constexpr bool is_far(word_pair x, word error) {
        return x.high != 0 || x.low >> 10 > error;
    }
};

template <std::size_t Capacity>
class exact_natural {
  public:
    constexpr exact_natural() = default;
    constexpr int size() const { return size_; }
    constexpr int width() const {
        return size_ == 0 ? 0 : 64 * (size_ - 1) + static_cast<int>(std::bit_width(last()));
    }
    constexpr word last() const { return words_[static_cast<std::size_t>(size_ - 1)]; }
    constexpr word* data() { return words_.data(); }
    constexpr const word* data() const { return words_.data(); }

    constexpr void push(word w) { words_[static_cast<std::size_t>(size_++)] = w; }
    constexpr void trim() { size_ = words::trimmed(words_.data(), size_); }
    constexpr void multiply(word factor, word more = 0) {
        const word carry =
            words::multiply_by_word(words_.data(), words_.data(), size_, factor, more);
        if (carry != 0) push(carry);
    }
    constexpr void add(word more) { multiply(1, more); }
    constexpr void multiply_by_five_to(int n) {
        constexpr int most = static_cast<int>(small_powers_of_five.size()) - 1;
        for (; n > most; n -= most) multiply(small_powers_of_five[most]);
        multiply(small_powers_of_five[static_cast<std::size_t>(n)]);
    }
    constexpr void shift(int n) {
        if (size_ == 0) return;
        const int whole = n / 64;
        for (int i = size_ - 1; i >= 0; --i)
            words_[static_cast<std::size_t>(i + whole)] = words_[static_cast<std::size_t>(i)];
        std::fill_n(words_.begin(), whole, word(0));
        const word beyond =
            words::shift_left(words_.data() + whole, words_.data() + whole, size_, n % 64);
        size_ += whole;
        if (beyond != 0) push(beyond);
    }
    /// Precondition: y is not zero.
    constexpr exact_natural times(word_pair y) const {
        exact_natural r, high = *this;
        r = *this;
        r.multiply(y.low);
        r.trim();
        if (y.high == 0) return r;
        high.multiply(y.high);
        high.shift(64);
        while (r.size_ < high.size_) r.push(0);
        const word carry = words::add(r.data(), r.data(), r.size_, high.data(), high.size_);
        if (carry != 0) r.push(carry);
        return r;
    }
    constexpr exact_natural distance(const exact_natural& y) const {
        const bool less =
            size_ != y.size_ ? size_ < y.size_ : words::compare(data(), y.data(), size_) < 0;
        const exact_natural &a = less ? y : *this, &b = less ? *this : y;
        exact_natural r = a;
        if (a.size_ > 0) words::subtract(r.data(), a.data(), a.size_, b.data(), b.size_);
        r.trim();
        return r;
    }
    /// The first 128 bits of x/y, with error 1 if nonzero bits follow. Precondition: neither is
    /// zero.
    constexpr leading_bits quotient(exact_natural y) const {
        exact_natural x = *this;
        const int y_shift = (y.size_ < 2 ? 64 : 0) + (std::max)(0, x.width() - y.width() - 128);
        y.shift(y_shift);
        const int to_top = 64 * y.size_ - y.width();
        y.shift(to_top);
        const int x_shift = y.width() + 128 - x.width();
        x.shift(x_shift);
        x.push(0);
        std::array<word, 3> q{};
        words::divide_long(x.data(), x.size_ - 1, y.data(), y.size_,
                           [&](int i, word w) { q[static_cast<std::size_t>(i)] = w; });
        const bool rest = words::trimmed(x.data(), y.size_) > 0;
        const int more = static_cast<int>(std::bit_width(q[2]));
        const word_pair low{q[1], q[0]};
        const word_pair kept = shifted_down(low, more);
        const bool cut = shifted_up(kept, more) != low;
        word_pair m = kept;
        if (more > 0) m.high |= q[2] << (64 - more);
        return {m, more + y_shift + to_top - x_shift, word{rest || cut}};
    }

  private:
    int size_ = 0;
    std::array<word, Capacity> words_{};
};

/// Rounds exactly, from as many digits as a midpoint of T can have; one more digit stands for the
/// rest.
template <class T>
class exact_decimal {
    using format = binary_format<T>;
    static constexpr int places = 1 - format::least;  ///< binary places of the smallest midpoint
    /// The number of digits of j·2^-places for j < 2^(digits + 1).
    static constexpr int most_digits =
        places - (places - format::digits - 1) * 30102LL / 100000 + 2;
    static constexpr int most_power = most_digits + places * 30103LL / 100000 + 8;
    static constexpr int most_bits =
        std::max<std::int64_t>({(most_digits + 2) * 33220LL / 10000, most_power * 23220LL / 10000,
                                number_traits<T>::max_exponent}) +
        8;
    using natural = exact_natural<static_cast<std::size_t>(most_bits / 64 + 8)>;

  public:
    /// Precondition: the decimal is not certainly beyond the format's range.
    static constexpr rounded_decimal rounded(const decimal_text& text) {
        natural x, divisor;
        int e = 0;
        const bool truncated = read(text, x, e);
        divisor.push(1);
        (e < 0 ? divisor : x).multiply_by_five_to(e < 0 ? -e : e);
        leading_bits leading = x.quotient(divisor);
        leading.exponent += e;
        const int unit = format::unit_of(leading.exponent + 128), drop = unit - leading.exponent;
        word_pair units{0, 0};
        bool up = false;
        if (drop <= 128) {
            units = shifted_down(leading.m, drop);
            const word_pair half = shifted_up({0, 1}, drop - 1);
            const word_pair rest = difference_of(leading.m, shifted_up(units, drop));
            up = rest > half || (rest == half && (leading.error != 0 || units.low % 2 == 1));
            units = sum_of(units, up ? 1 : 0);
        }
        // The appended digit 1 stands for 0 to 10: use the farther end.
        if (truncated && up) x = x.distance(one());
        if (truncated && !up) x.add(9);
        return with_distance(x, divisor, e, units, unit);
    }

  private:
    static constexpr natural one() {
        natural x;
        x.push(1);
        return x;
    }
    static constexpr bool read(const decimal_text& text, natural& x, int& exponent) {
        word chunk = 0, power = 1;
        const auto flush = [&] {
            x.multiply(power, chunk);
            chunk = 0;
            power = 1;
        };
        const bool truncated = text.for_digits(most_digits, [&](word digit) {
            chunk = 10 * chunk + digit;
            power *= 10;
            if (power == 10'000'000'000'000'000'000U) flush();
        });
        flush();
        const std::int64_t left_out = std::max<std::int64_t>(text.digits() - most_digits, 0);
        exponent = static_cast<int>(text.exponent() + left_out);
        if (!truncated) return false;
        x.multiply(10, 1);
        --exponent;
        return true;
    }
    /// Let m = min(e, unit). |x/divisor·2^e − units·2^unit| = |x·2^(e − m) − units·divisor·2^(unit
    /// − m)|/divisor·2^m.
    static constexpr rounded_decimal with_distance(natural x, const natural& divisor, int e,
                                                   word_pair units, int unit) {
        const int least = (std::min)(e, unit);
        x.shift(e - least);
        if (width_of(units) != 0) {
            natural nearest = divisor.times(units);
            nearest.shift(unit - least);
            x = x.distance(nearest);
        }
        if (x.size() == 0) return {units, unit, {0, 0}, 0, true};
        const leading_bits d = x.quotient(divisor);
        const word_pair end = sum_of(d.m, d.error);
        const bool carried = end < d.m;
        return {units, unit, carried ? word_pair{word{1} << 63, 0} : end,
                d.exponent + least + (carried ? 1 : 0), true};
    }
};

/// A number and its distance from the decimal, rounded up. `finite` is false if the decimal rounds
/// to no finite T.
template <class T>
struct nearest_number {
    T value{}, error{};
    bool finite = false;
};

/// The number of T nearest to a well-formed decimal.
template <class T>
constexpr nearest_number<T> nearest_decimal(const decimal_text& text) {
    using format = binary_format<T>;
    constexpr auto tens = [](int e) { return e * 30103LL / 100000; };  // about e·log10(2)
    const auto signed_number = [&](const T& x) { return text.negative() ? T(-x) : x; };
    if (text.is_zero()) return {signed_number(T(0)), T(0), true};
    if (text.magnitude() > tens(number_traits<T>::max_exponent) + 2) return {};
    if (text.magnitude() < tens(format::least) - 2)
        return {signed_number(T(0)), number_traits<T>::underflow_unit(), true};
    rounded_decimal r = format::rounded(leading_bits_of(text));
    if (!r.certain) r = exact_decimal<T>::rounded(text);
    if (r.unit + width_of(r.units) > number_traits<T>::max_exponent) return {};
    const T value = format::number(r.units, r.unit);
    if (!number_traits<T>::is_finite(value)) return {};
    return {signed_number(value), format::rounded_up(r.distance, r.distance_unit), true};
}

}  // namespace errbound::integers
