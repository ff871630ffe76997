// Floating-point numbers from decimals, independent of the locale.
#pragma once

#include <string_view>

namespace errbound::support {

enum class decimal_status { ok, malformed, overflow };

template <class T>
struct decimal {
    T value;  ///< 0 unless ok
    decimal_status status;
};

/// The nearest float or double to a whole text that std::from_chars accepts: optional minus,
/// digits, optional point and exponent; infinity and NaN. Underflow is rounded.
template <class T>
decimal<T> parse_decimal(std::string_view text);

}  // namespace errbound::support
