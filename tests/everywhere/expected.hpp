// The hashes of all sections (tests/everywhere/sections.hpp). They change only if the sections
// change or an answer was wrong.
#pragma once

#include <cstdint>

namespace everywhere::expected {

inline constexpr std::uint64_t decisions = 0x228a7aa44e4b893c;
inline constexpr std::uint64_t times = 0xc2508c3f74182bc4;
inline constexpr std::uint64_t batches = 0xcffb6acc32b8e451;
inline constexpr std::uint64_t steps = 0xae646a8e57bedb08;
inline constexpr std::uint64_t predicates = 0x55497a9f5aa579e5;
inline constexpr std::uint64_t roots = 0x2e77b39a5ec6cd3b;
inline constexpr std::uint64_t bounds = 0x807084e8c61e0216;
inline constexpr std::uint64_t all = 0xa0a59876b6e23bd6;

}  // namespace everywhere::expected
