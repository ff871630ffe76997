// Long doubles as std::to_chars writes them, by printf and strtold: libc++'s converts them to doubles
// first, which are others.
#pragma once

#include <cfenv>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <string>

namespace errbound::detail {

/// Both round as the environment says: while one lives, to nearest.
class to_nearest {
  public:
    to_nearest() { std::fesetround(FE_TONEAREST); }
    ~to_nearest() { std::fesetround(before_); }
    to_nearest(const to_nearest&) = delete;
    to_nearest& operator=(const to_nearest&) = delete;

  private:
    int before_ = std::fegetround();
};

inline std::string printf_text(const char* format, int precision, long double x) {
    const int size = std::snprintf(nullptr, 0, format, precision, x);
    std::string text(static_cast<std::size_t>(size) + 1, '\0');
    std::snprintf(text.data(), text.size(), format, precision, x);
    text.pop_back();
    return text;
}
inline std::string printf_decimal(long double x, std::chars_format how, int precision) {
    const to_nearest rounding;
    std::string text =
        printf_text(how == std::chars_format::fixed ? "%.*Lf" : "%.*Le", precision, x);
    if (std::isfinite(x) && precision > 0) {  // the locale's point, of any length
        const char* others = "+-e0123456789";
        const std::size_t point = text.find_first_not_of(others);
        text.replace(point, text.find_first_of(others, point) - point, ".");
    }
    return text;
}

/// How many digits after the first x takes to be read back.
inline int digits_to_read_back(long double x) {
    const to_nearest rounding;
    int precision = 0;
    while (precision + 1 < std::numeric_limits<long double>::max_digits10 &&
           std::strtold(printf_text("%.*Le", precision, x).c_str(), nullptr) != x)
        ++precision;
    return precision;
}
/// The shortest of the decimals nearest to x that reads back as x. (Next to powers of two one that
/// is not the nearest may have a digit less.)
inline std::string printf_decimal(long double x, std::chars_format how) {
    return printf_decimal(x, how, std::isfinite(x) ? digits_to_read_back(x) : 0);
}
/// With an exponent where that is shorter.
inline std::string printf_decimal(long double x) {
    const std::string scientific = printf_decimal(x, std::chars_format::scientific);
    if (!std::isfinite(x)) return scientific;
    const int exponent = std::atoi(scientific.c_str() + scientific.find('e') + 1);
    const int digits = digits_to_read_back(x);
    const std::string fixed =
        printf_decimal(x, std::chars_format::fixed, digits > exponent ? digits - exponent : 0);
    return fixed.size() <= scientific.size() ? fixed : scientific;
}

}  // namespace errbound::detail
