// Progress, for a person at a terminal.
#pragma once

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <string>

namespace ccd::program {

/// A line on a terminal's standard error that says how far the work is, once it takes a second.
class progress_line {
  public:
    progress_line() = default;
    progress_line(const progress_line&) = delete;
    progress_line& operator=(const progress_line&) = delete;
    ~progress_line() { clear(); }

    /// `share` of the work is done, from 0 to 1; `what` comes next.
    void show(double share, const std::string& what) {
        const auto now = std::chrono::steady_clock::now();
        if (!is_terminal_ || now - last_ < (shown_ ? 100 : 1000) * std::chrono::milliseconds(1))
            return;
        shown_ = true;
        last_ = now;
        constexpr int width = 24;
        const int filled = static_cast<int>(std::clamp(share, 0.0, 1.0) * width);
        std::fprintf(stderr, "\r\x1b[K[%s%s] %3.0f %%  %.100s", std::string(filled, '#').c_str(),
                     std::string(width - filled, '.').c_str(), 100 * share, what.c_str());
        std::fflush(stderr);
    }
    void clear() {
        if (shown_) std::fputs("\r\x1b[K", stderr);
        shown_ = false;
    }

  private:
    bool is_terminal_ = isatty(STDERR_FILENO) != 0;
    bool shown_ = false;
    std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace ccd::program
