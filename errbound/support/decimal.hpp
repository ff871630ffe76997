// Floating-point numbers from decimals, of any locale's process.
#pragma once

#include <string_view>

namespace errbound::support {

enum class decimal_status { ok, malformed, overflow };

template <class T>
struct decimal {
    T value;  ///< 0 unless ok
    decimal_status status;
};

/// The float or double nearest to what std::from_chars takes, all of it: an optional minus, digits
/// with an optional point and exponent; infinities and NaN, too. What underflows is rounded.
template <class T>
decimal<T> parse_decimal(std::string_view text);

}  // namespace errbound::support
