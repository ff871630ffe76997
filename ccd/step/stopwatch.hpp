#pragma once

#include <chrono>
#include <utility>

namespace ccd::detail {

/// Seconds since construction or the last lap.
class stopwatch {
  public:
    double lap() {
        const auto now = std::chrono::steady_clock::now();
        return std::chrono::duration<double>(now - std::exchange(last_, now)).count();
    }

  private:
    std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace ccd::detail
