// One knob for all random tests: ERRBOUND_TEST_SCALE, a factor on how much they try.
#pragma once

#include <algorithm>
#include <concepts>
#include <cstdlib>

namespace support {

/// `count` times the environment's ERRBOUND_TEST_SCALE (1 where it is not set), at least 1.
/// Sanitizers take less (tests/CMakeLists.txt), a night may take more.
template <std::integral T>
T scaled(T count) {
    const char* const text = std::getenv("ERRBOUND_TEST_SCALE");
    const double factor = text == nullptr ? 1 : std::strtod(text, nullptr);
    return std::max(T(1), static_cast<T>(static_cast<double>(count) * factor));
}

}  // namespace support
