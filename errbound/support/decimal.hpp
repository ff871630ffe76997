// Conversion of decimals to floating-point numbers, independent of the locale.
#pragma once

#include <string_view>

namespace errbound::support {

enum class decimal_status { ok, malformed, overflow };

template <class T>
struct decimal {
    T value;  ///< 0 unless ok
    decimal_status status;
};

/// Returns the float or double nearest to the whole text, in the format of std::from_chars:
/// decimals with optional minus, point and exponent, infinities and NaN. Underflow is rounded.
template <class T>
decimal<T> parse_decimal(std::string_view text);

}  // namespace errbound::support
