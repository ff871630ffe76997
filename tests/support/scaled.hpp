// The scale of all random tests: the environment's ERRBOUND_TEST_SCALE multiplies their counts.
#pragma once

#include <algorithm>
#include <concepts>
#include <cstdlib>

namespace support {

/// `count` times ERRBOUND_TEST_SCALE (default 1), at least 1. Sanitizers use less
/// (tests/CMakeLists.txt), nightly tests more.
template <std::integral T>
T scaled(T count) {
    const char* const text = std::getenv("ERRBOUND_TEST_SCALE");
    const double factor = text == nullptr ? 1 : std::strtod(text, nullptr);
    return std::max(T(1), static_cast<T>(static_cast<double>(count) * factor));
}

}  // namespace support
