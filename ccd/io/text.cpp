#include "ccd/io/text.hpp"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <errbound/integers/integer.hpp>
#include <errbound/support/error.hpp>
#include <limits>
#include <numeric>
#include <system_error>

#include "errbound/support/decimal.hpp"

namespace ccd::io {
namespace {

using errbound::integer;

constexpr number fail(number_status status) {
    return {0, status};
}

constexpr std::string_view blanks = " \t";

/// Takes an optional sign off the front. Returns true for a minus.
bool take_sign(std::string_view& token) {
    const bool negative = token.starts_with('-');
    if (negative || token.starts_with('+')) token.remove_prefix(1);
    return negative;
}

/// The double equal to n/d (n, d > 0), or with `round` the nearest one.
number nearest_quotient(const integer& n, const integer& d, bool round) {
    // e = floor(log2(n/d)); the first value may be one too large.
    int e = msb(n) - msb(d);
    if (e >= 0 ? n < (d << e) : (n << -e) < d) --e;
    if (e > 1023) return fail(number_status::overflow);

    // The result is q·2^lsb: 53 bits of n/d, or fewer where the format ends at 2^-1074.
    const int lsb = std::max(e - 52, -1074);
    const integer divisor = lsb > 0 ? d << lsb : d;
    const integer dividend = lsb < 0 ? n << -lsb : n;
    integer q = dividend / divisor;
    if (const integer r = dividend - q * divisor; r != 0) {
        if (!round) return fail(number_status::inexact);
        const auto half = (r << 1) <=> divisor;
        if (half > 0 || (half == 0 && q % 2 != 0)) ++q;
    }
    // q ≤ 2^53, so the conversion is exact, and ldexp is exact or overflows.
    const double value = std::ldexp(static_cast<double>(q), lsb);
    if (std::isinf(value)) return fail(number_status::overflow);
    return {value, number_status::ok};
}

struct integer_text {
    bool negative = false;
    std::string_view digits;
    std::optional<std::uint64_t> small;

    integer magnitude() const { return small ? integer(*small) : integer::from_string(digits); }
};

std::optional<integer_text> parse_integer(std::string_view token) {
    integer_text result;
    result.negative = take_sign(token);
    if (token.empty() || token.find_first_not_of("0123456789") != token.npos) return std::nullopt;
    token.remove_prefix(std::min(token.find_first_not_of('0'), token.size() - 1));
    result.digits = token;
    std::uint64_t value = 0;
    if (std::from_chars(token.data(), token.data() + token.size(), value).ec == std::errc{}) {
        result.small = value;
    }
    return result;
}

/// A hexadecimal float after its sign and "0x".
number parse_hexadecimal(std::string_view token, bool round) {
    const std::size_t end = std::min(token.find_first_of("pP"), token.size());
    std::string digits(token.substr(0, end));
    long exponent = 0;
    if (const std::size_t point = digits.find('.'); point != std::string::npos) {
        digits.erase(point, 1);
        exponent = -4 * static_cast<long>(digits.size() - point);
    }
    if (digits.empty() || digits.find_first_not_of("0123456789abcdefABCDEF") != std::string::npos)
        return fail(number_status::malformed);
    if (end < token.size()) {
        const std::optional<integer_text> power = parse_integer(token.substr(end + 1));
        if (!power) return fail(number_status::malformed);
        constexpr std::uint64_t most = 1'000'000'000;
        const auto size = static_cast<long>(std::min(power->small.value_or(most), most));
        exponent += power->negative ? -size : size;
    }
    digits.erase(0, digits.find_first_not_of('0'));
    if (digits.empty()) return {0, number_status::ok};
    if (digits.size() > longest_number) return fail(number_status::too_long);

    const integer mantissa = integer::from_string(digits, 16);
    // These returns bound the shifts below.
    const long top = msb(mantissa) + exponent;
    if (top > 1023) return fail(number_status::overflow);
    if (top < -1080) return round ? number{} : fail(number_status::inexact);
    if (exponent >= 0) return nearest_quotient(mantissa << exponent, 1, round);
    return nearest_quotient(mantissa, integer(1) << -exponent, round);
}

/// A decimal number after its sign.
template <class T>
number parse_decimal(std::string_view token) {
    using errbound::support::decimal_status;
    // parse_decimal would accept a second minus.
    if (token.starts_with('-')) return fail(number_status::malformed);
    const auto [value, status] = errbound::support::parse_decimal<T>(token);
    if (status == decimal_status::malformed) return fail(number_status::malformed);
    if (status == decimal_status::overflow) return fail(number_status::overflow);
    if (!std::isfinite(value)) return fail(number_status::not_finite);
    return {static_cast<double>(value), number_status::ok};
}

template <class T>
number parse_real(std::string_view token, bool round) {
    const bool negative = take_sign(token);
    number result;
    if (token.starts_with("0x") || token.starts_with("0X")) {
        result = parse_hexadecimal(token.substr(2), round);
        if (result.status == number_status::ok) {
            if (result.value > static_cast<double>(std::numeric_limits<T>::max())) {
                return fail(number_status::overflow);
            }
            if (static_cast<double>(static_cast<T>(result.value)) != result.value) {
                return fail(number_status::inexact);
            }
        }
    } else if (token.starts_with("1.#") || (token.starts_with("nan(") && token.ends_with(')'))) {
        return fail(number_status::not_finite);  // as Microsoft's C libraries print it
    } else {
        result = parse_decimal<T>(token);
    }
    if (negative) result.value = -result.value;
    return result;
}

}  // namespace

std::string excerpt(std::string_view found) {
    constexpr std::size_t longest = 40;
    std::string result = "'";
    for (const char c : found) {
        std::string piece(1, c);
        if (c < ' ' || c > '~') {
            constexpr char hex[] = "0123456789abcdef";
            const auto byte = static_cast<unsigned char>(c);
            piece = {'\\', 'x', hex[byte >> 4], hex[byte & 15]};
        }
        if (result.size() + piece.size() > longest - 3 + 1) {
            result += "...";
            break;
        }
        result += piece;
    }
    return result + "'";
}

std::string_view without_byte_order_mark(std::string_view text, const std::string& name) {
    if (text.starts_with("\xfe\xff") || text.starts_with("\xff\xfe"))
        throw errbound::support::file_error(
            name + ": encoding is UTF-16 or UTF-32; expected ASCII or UTF-8");
    if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
    return text;
}

std::string_view without_end_mark(std::string_view text) {
    const std::size_t last = text.find_last_not_of(" \t\r\n");
    if (last == std::string_view::npos || text[last] != '\x1a') return text;
    return text.substr(0, text.find_last_not_of(" \t\r\n\x1a") + 1);
}

std::string_view trimmed(std::string_view text) {
    const std::size_t first = text.find_first_not_of(blanks);
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

std::optional<std::string_view> take_line(std::string_view& text) {
    if (text.empty()) return std::nullopt;
    const auto end =
        std::ranges::find_if(text, [](char c) { return c == '\n' || c == '\r'; }) - text.begin();
    const std::string_view line = text.substr(0, static_cast<std::size_t>(end));
    text.remove_prefix(line.size());
    const std::size_t end_size = text.starts_with("\r\n") ? 2 : 1;
    text.remove_prefix(std::min(end_size, text.size()));
    return line;
}

std::string_view take_word(std::string_view& line) {
    line.remove_prefix(std::min(line.find_first_not_of(blanks), line.size()));
    const std::string_view word = line.substr(0, line.find_first_of(blanks));
    line.remove_prefix(word.size());
    return word;
}

void fail_at(const std::string& name, std::size_t line, const std::string& what) {
    throw errbound::support::file_error(name + ":" + std::to_string(line) + ": " + what);
}

std::string describe(number_status status, const std::string& name, const std::string& found) {
    std::string expected = "; expected a number";
    switch (status) {
        case number_status::ok:
        case number_status::malformed:
            break;
        case number_status::not_finite:
            expected = "; expected a finite number";
            break;
        case number_status::overflow:
            expected = ", which overflows; expected a finite number";
            break;
        case number_status::inexact:
            expected = ", which no double equals; expected an exact double";
            break;
        case number_status::zero_denominator:
            expected = "; expected a nonzero denominator";
            break;
        case number_status::too_long:
            expected =
                ", which has too many digits; expected at most " + std::to_string(longest_number);
    }
    return name + " is " + found + expected;
}

number parse_double(std::string_view token, bool round) {
    return parse_real<double>(token, round);
}

number parse_float(std::string_view token) {
    return parse_real<float>(token, false);
}

number parse_quotient(std::string_view numerator, std::string_view denominator, bool round) {
    const std::optional<integer_text> n = parse_integer(numerator);
    const std::optional<integer_text> d = parse_integer(denominator);
    if (!n || !d) return fail(number_status::malformed);
    if (d->small == 0U) return fail(number_status::zero_denominator);
    if (n->small == 0U) return {0, number_status::ok};
    const double sign = n->negative != d->negative ? -1 : 1;

    if (n->small && d->small) {
        const std::uint64_t divisor = std::gcd(*n->small, *d->small);
        const std::uint64_t reduced_n = *n->small / divisor, reduced_d = *d->small / divisor;
        const bool n_is_exact =
            static_cast<int>(std::bit_width(reduced_n)) - std::countr_zero(reduced_n) <= 53;
        if (n_is_exact && std::has_single_bit(reduced_d)) {
            // Both convert exactly, and dividing by a power of two up to 2^63 is exact too.
            return {sign * (static_cast<double>(reduced_n) / static_cast<double>(reduced_d)),
                    number_status::ok};
        }
        if (!round) return fail(number_status::inexact);
    }
    if (std::max(n->digits.size(), d->digits.size()) > longest_number) {
        return fail(number_status::too_long);
    }
    number result = nearest_quotient(n->magnitude(), d->magnitude(), round);
    result.value *= sign;
    return result;
}

}  // namespace ccd::io
