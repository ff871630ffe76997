// Termination signals, for long work that can be resumed.
#pragma once

#include <array>
#include <atomic>
#include <string>

namespace errbound::support {

/// While it lives, the first SIGINT or SIGTERM sets a number and prints a line to standard error;
/// the next ends the program. Ignored signals stay ignored. At most one object at a time.
class awaited_signals {
  public:
    /// `line`, if not empty, is printed at once, as the sender may not wait for long.
    explicit awaited_signals(const std::string& line = {});
    ~awaited_signals();
    awaited_signals(const awaited_signals&) = delete;
    awaited_signals& operator=(const awaited_signals&) = delete;

    const std::atomic<int>& arrived() const;  ///< the signal that arrived, or 0

  private:
    std::array<void (*)(int), 2> before_;
};

}  // namespace errbound::support
