// Long doubles for lists of number types, also on processors where they are not IEEE numbers.
#pragma once

#include <errbound/environment.hpp>
#include <type_traits>

namespace support {

/// `long double`. If it is a pair of doubles, which the library rejects, double once more.
using long_double =
    std::conditional_t<errbound::detail::is_ieee_format<long double>, long double, double>;

/// True if std::fma compiles for T. On Windows it does not for long doubles.
template <class T>
#ifdef __MINGW32__
inline constexpr bool fuses = sizeof(T) <= sizeof(double);
#else
inline constexpr bool fuses = true;
#endif

}  // namespace support
