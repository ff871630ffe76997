// Long doubles as std::to_chars should write them, by printf and strtold. libc++'s to_chars
// converts them to double, and libstdc++'s on Windows uses the locale's decimal point.
#pragma once

#include <algorithm>
#include <cfenv>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <string>

namespace errbound::detail {

/// Sets rounding to nearest, which printf and strtold obey.
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
    std::string text(64, '\0');
    for (;;) {
        const auto size =
            static_cast<std::size_t>(std::snprintf(text.data(), text.size(), format, precision, x));
        const bool fits = size < text.size();
        text.resize(fits ? size : size + 1);
        if (fits) return text;
    }
}
inline std::string printf_decimal(long double x, std::chars_format how, int precision) {
    const to_nearest rounding;
    std::string text =
        printf_text(how == std::chars_format::fixed ? "%.*Lf" : "%.*Le", precision, x);
    if (std::isfinite(x) && precision > 0) {  // the locale's decimal point, of any length
        const char* others = "+-e0123456789";
        const std::size_t point = text.find_first_not_of(others);
        text.replace(point, text.find_first_of(others, point) - point, ".");
    }
    return text;
}

/// A precision whose decimal reads back as x, by bisection; not always the least.
inline int precision_to_read_back(long double x) {
    const to_nearest rounding;
    int too_few = -1, enough = std::numeric_limits<long double>::max_digits10 - 1;
    while (enough - too_few > 1) {
        const int middle = too_few + (enough - too_few) / 2;
        const bool same = std::strtold(printf_text("%.*Le", middle, x).c_str(), nullptr) == x;
        (same ? enough : too_few) = middle;
    }
    return enough;
}
inline std::string printf_decimal(long double x, std::chars_format) {
    return printf_decimal(x, std::chars_format::scientific,
                          std::isfinite(x) ? precision_to_read_back(x) : 0);
}
/// In scientific notation if that is shorter.
inline std::string printf_decimal(long double x) {
    if (!std::isfinite(x)) return printf_decimal(x, std::chars_format::fixed, 0);
    const int precision = precision_to_read_back(x);
    std::string scientific = printf_decimal(x, std::chars_format::scientific, precision);
    const int exponent = std::atoi(scientific.c_str() + scientific.find('e') + 1);
    // Each digit before the point and zero after it takes one character.
    if (std::abs(exponent) > static_cast<int>(scientific.size())) return scientific;
    std::string fixed =
        printf_decimal(x, std::chars_format::fixed, (std::max)(0, precision - exponent));
    return fixed.size() <= scientific.size() ? fixed : scientific;
}

}  // namespace errbound::detail
