// Prints tracked numbers as decimals: certain digits, or value and radius.
//   std::cout << x;                         // 0.300000000000000
//   std::cout << errbound::with_radius(x);  // 0.30000000000000004 ± 6.7e-17
//   std::format("{:>20}", x);               // if the standard library has it
//
// A decimal printed by `<<` is within one unit of its last digit of the exact number, so trailing
// zeros count. With no certain digit it is a zero, 0.00 or 0e+05, of the possible size. Exact
// numbers print as the shortest decimal that reads back; infinite errors print "unknown". Width and
// alignment apply, as for a string; stream precision does not.
#pragma once

#include <array>
#include <charconv>
#include <cmath>
#include <concepts>
#include <cstdlib>
#include <errbound/detail/printf_decimal.hpp>
#include <errbound/small_floats.hpp>
#include <errbound/tracked.hpp>
#include <limits>
#include <ostream>
#include <string>
#include <string_view>
#include <system_error>
#include <version>
#if defined(__cpp_lib_format)
#include <format>
#endif

namespace errbound {

namespace detail {

template <class>
inline constexpr bool is_small_float = false;
template <int P, int E, bool HasInfinity>
inline constexpr bool is_small_float<small_float<P, E, HasInfinity>> = true;

}  // namespace detail

/// float, double, long double, and small_float. Convert other types first (errbound::convert).
template <class T>
concept printable_number = std::same_as<T, float> || std::same_as<T, double> ||
    std::same_as<T, long double> || detail::is_small_float<T>;

namespace detail {

template <class T>
using printed_type = std::conditional_t<std::floating_point<T>, T, float>;

/// True if std::to_chars converts wider types to double, or uses the locale's decimal point.
#if defined(_LIBCPP_VERSION) || defined(_WIN32)
template <class T>
inline constexpr bool to_chars_is_wrong =
    std::numeric_limits<T>::digits > std::numeric_limits<double>::digits;
#else
template <class>
inline constexpr bool to_chars_is_wrong = false;
#endif

/// std::to_chars, which rounds exactly. `how`: format and precision; default: shortest.
template <std::floating_point T, class... How>
std::string decimal(T x, How... how) {
    if (std::isnan(x)) return "nan";  // the sign of NaN depends on the processor
    if constexpr (to_chars_is_wrong<T>) return printf_decimal(x, how...);
    std::string text(64, '\0');
    for (;;) {
        const auto [end, status] = std::to_chars(text.data(), text.data() + text.size(), x, how...);
        if (status == std::errc()) {
            text.resize(static_cast<std::size_t>(end - text.data()));
            return text;
        }
        text.resize(2 * text.size());
    }
}
/// The exponent of d.ddde±dd.
inline int decimal_exponent(const std::string& scientific) {
    return std::atoi(scientific.c_str() + scientific.find('e') + 1);
}
inline std::string with_exponent(std::string_view digits, int exponent) {
    const int size = std::abs(exponent);
    return std::string(digits) + (exponent < 0 ? "e-" : "e+") + (size < 10 ? "0" : "") +
           std::to_string(size);
}

/// Let 10^(k−1) <= 2·error < 10^k. Rounding to 10^k adds at most half a unit, the error another.
template <std::floating_point T>
std::string certain_digits(T value, T error) {
    if (!std::isfinite(value) || !std::isfinite(error)) return "unknown";
    if (error == 0) return decimal(value == 0 ? T(0) : value);
    constexpr int digits = 17;  // 18 digits may round up to the next power of ten, never below one
    const bool doubles = error <= (std::numeric_limits<T>::max)() / 2;
    const T scaled = doubles ? 2 * error : error;
    const int k = decimal_exponent(decimal(scaled, std::chars_format::scientific, digits)) +
                  (doubles ? 1 : 2);
    if (value == 0) return with_exponent("0", k);
    const std::string size = decimal(std::abs(value), std::chars_format::scientific, digits);
    const int leading = decimal_exponent(size);
    if (k <= 0 && leading >= -5) {
        const std::string fixed = decimal(value, std::chars_format::fixed, -k);
        const bool is_zero = fixed.find_first_not_of("-0.") == std::string::npos;
        return is_zero && fixed[0] == '-' ? fixed.substr(1) : fixed;
    }
    if (leading >= k) {
        const std::string rounded = decimal(value, std::chars_format::scientific, leading - k);
        // Still below 10^leading: `size` had been rounded up to it.
        if (decimal_exponent(rounded) >= leading) return rounded;
        return decimal(value, std::chars_format::scientific, leading - k - 1);
    }
    if (leading + 1 < k) return with_exponent("0", k);
    // The digits decide which half of 10^k |value| is in, unless they equal 5.
    const std::string_view half = "5.00000000000000000";
    const std::string_view mantissa = std::string_view(size).substr(0, half.size());
    if (mantissa > half) return with_exponent(value < 0 ? "-1" : "1", k);
    return with_exponent("0", mantissa < half ? k : k + 1);
}

/// Two digits that read back as at least x > 0: at least its shortest decimal, since reading is
/// monotone. (std::from_chars lacks floating point in libc++ before 20.)
template <std::floating_point T>
std::string decimal_not_below(T x) {
    const std::string text = decimal(x, std::chars_format::scientific, 1);
    const std::string shortest = decimal(x, std::chars_format::scientific);
    std::string mantissa = shortest.substr(0, shortest.find('e'));
    if (mantissa.size() == 1) mantissa += ".0";
    if (decimal_exponent(text) > decimal_exponent(shortest) || text.substr(0, 3) >= mantissa)
        return text;
    int exponent = decimal_exponent(text);
    std::string digits = text.substr(0, 3);
    if (digits[2] != '9') {
        ++digits[2];
    } else if (digits[0] != '9') {
        ++digits[0];
        digits[2] = '0';
    } else {
        digits = "1.0";
        ++exponent;
    }
    return with_exponent(digits, exponent);
}

template <std::floating_point T>
std::string value_and_radius(T value, T error) {
    const std::string radius = !std::isfinite(value) || !std::isfinite(error) ? "unknown"
                               : error == 0                                   ? "0"
                                            : decimal_not_below(error);
    return decimal(value) + " ± " + radius;
}

}  // namespace detail

template <printable_number T, class Rule>
std::string certain_digits(const tracked<T, Rule>& x) {
    using printed = detail::printed_type<T>;
    return detail::certain_digits(static_cast<printed>(x.value()), static_cast<printed>(x.error()));
}

template <printable_number T, class Rule>
std::ostream& operator<<(std::ostream& to, const tracked<T, Rule>& x) {
    return to << certain_digits(x);
}

/// value ± radius: the shortest decimal that reads back as the value, and two digits that read back
/// as at least the error (or `unknown`). tracked::within of both encloses the exact number.
template <printable_number T, class Rule>
std::string with_radius(const tracked<T, Rule>& x) {
    using printed = detail::printed_type<T>;
    return detail::value_and_radius(static_cast<printed>(x.value()),
                                    static_cast<printed>(x.error()));
}

}  // namespace errbound

#if defined(__cpp_lib_format)
/// Formats certain digits, as `<<`. A precision is a format error.
template <errbound::printable_number T, class Rule>
struct std::formatter<errbound::tracked<T, Rule>, char> : std::formatter<std::string_view, char> {
  private:
    using of_text = std::formatter<std::string_view, char>;
    static constexpr bool has_precision(std::string_view specification) {
        if (specification.size() > 1 && specification[0] != '}' &&
            std::string_view("<>^").find(specification[1]) != std::string_view::npos)
            specification.remove_prefix(2);  // the fill character may be a full stop
        int depth = 0;                       // for a width that is an argument
        for (const char c : specification) {
            if (c == '.') return true;
            if (c == '}' && depth == 0) return false;
            if (c == '{') ++depth;
            if (c == '}') --depth;
        }
        return false;
    }

  public:
    constexpr auto parse(std::format_parse_context& context) {
        if (has_precision({context.begin(), context.end()}))
            throw std::format_error("errbound: a tracked number takes no precision");
        return of_text::parse(context);
    }
    template <class Context>
    auto format(const errbound::tracked<T, Rule>& x, Context& context) const {
        return of_text::format(errbound::certain_digits(x), context);
    }
};
#endif
