// Random numbers that are the same everywhere. Internal.
#pragma once

#include <cstdint>

namespace errbound::validation {

/// SplitMix64 (Steele, Lea, Flood 2014): all seeds are equally good.
class random_source {
  public:
    explicit random_source(std::uint64_t seed) : state_(seed) {}

    std::uint64_t bits() {
        std::uint64_t z = (state_ += 0x9e3779b97f4a7c15U);
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
        return z ^ (z >> 31);
    }
    /// 0 <= result < n. For small n the bias is far below one in 2^30.
    int below(int n) { return static_cast<int>(bits() % static_cast<std::uint64_t>(n)); }
    int between(int first, int last) {
        const auto count = static_cast<std::uint64_t>(std::int64_t{last} - first + 1);
        return static_cast<int>(first + static_cast<std::int64_t>(bits() % count));
    }
    bool one_in(int n) { return below(n) == 0; }

  private:
    std::uint64_t state_;
};

}  // namespace errbound::validation
