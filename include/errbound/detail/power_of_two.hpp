// Powers of two as doubles, also in constant expressions.
#pragma once

#include <bit>
#include <cstdint>

namespace errbound::detail {

/// 2^e, −1022 <= e <= 1023.
constexpr double power_of_two(int e) {
    return std::bit_cast<double>(static_cast<std::uint64_t>(e + 1023) << 52);
}

}  // namespace errbound::detail
