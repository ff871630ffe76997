// Signals that stop a program whose work can be continued later.
#pragma once

#include <array>
#include <atomic>
#include <string>

namespace errbound::support {

/// While an object lives, the first SIGINT or SIGTERM sets a number and prints a line to standard
/// error; the second ends the program. Ignored signals stay ignored. At most one object at a time.
class awaited_signals {
  public:
    /// `line` is printed at once when a signal arrives, unless empty.
    explicit awaited_signals(const std::string& line = {});
    ~awaited_signals();
    awaited_signals(const awaited_signals&) = delete;
    awaited_signals& operator=(const awaited_signals&) = delete;

    const std::atomic<int>& arrived() const;

  private:
    std::array<void (*)(int), 2> before_;
};

}  // namespace errbound::support
