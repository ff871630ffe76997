// Evidence in chunks, whose sizes depend only on the work. Internal.
#pragma once

#include <algorithm>
#include <cstdint>
#include <errbound/validation/validation.hpp>

namespace errbound::validation {

/// Numbered cases in 1 to 400 chunks. A chunk's report takes some hundred kilobytes.
class chunks {
  public:
    /// Chunks have at least `least` cases, except the last.
    constexpr chunks(std::uint64_t cases, std::uint64_t least)
        : cases_(cases), size_(std::max(least, rounded_up(cases, most))) {}

    constexpr std::uint64_t count() const {
        return std::max<std::uint64_t>(rounded_up(cases_, size_), 1);
    }
    struct range {
        std::uint64_t begin, end;
    };
    constexpr range of(std::uint64_t chunk) const {
        return {std::min(cases_, chunk * size_), std::min(cases_, (chunk + 1) * size_)};
    }

  private:
    static constexpr std::uint64_t most = 400;
    static constexpr std::uint64_t rounded_up(std::uint64_t n, std::uint64_t d) {
        return n / d + (n % d > 0);
    }
    std::uint64_t cases_, size_;
};

/// Sets up MPFR on the calling thread, and frees its cache afterwards.
evidence with_mpfr(evidence examined);

}  // namespace errbound::validation
