// Signals that end a program, for long work that can go on later.
#pragma once

#include <array>
#include <atomic>
#include <string>

namespace errbound::support {

/// While one lives, the first SIGINT or SIGTERM sets a number and prints a line to standard error;
/// another ends the program. Those that the process ignores stay ignored. At most one at a time.
class awaited_signals {
  public:
    /// `line`, if not empty, is printed at once: whoever sends the signal may not wait for long.
    explicit awaited_signals(const std::string& line = {});
    ~awaited_signals();
    awaited_signals(const awaited_signals&) = delete;
    awaited_signals& operator=(const awaited_signals&) = delete;

    /// Which has, or 0.
    const std::atomic<int>& arrived() const;

  private:
    std::array<void (*)(int), 2> before_;
};

}  // namespace errbound::support
