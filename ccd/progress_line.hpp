// How far the work is, for people at a terminal.
#pragma once

#include <unistd.h>

#include <chrono>
#include <cstddef>
#include <cstdio>
#include <string>

namespace ccd::program {

/// A bar on a terminal's standard error, once the work takes a second; gone at the end.
class progress_line {
  public:
    progress_line() = default;
    progress_line(const progress_line&) = delete;
    progress_line& operator=(const progress_line&) = delete;
    ~progress_line() {
        if (shown_) std::fputs("\r\x1b[K", stderr);
    }

    /// Of `total` > 0 parts `done` are done, and `what` is under way.
    void show(std::size_t done, std::size_t total, const std::string& what) {
        using std::chrono::steady_clock;
        if (!is_terminal_ || steady_clock::now() - start_ < std::chrono::seconds(1)) return;
        shown_ = true;
        constexpr std::size_t width = 30;
        std::string bar(done * width / total, '#');
        bar.resize(width, '.');
        std::fprintf(stderr, "\r\x1b[K[%s] %zu/%zu %s", bar.c_str(), done, total, what.c_str());
        std::fflush(stderr);
    }

  private:
    bool is_terminal_ = isatty(STDERR_FILENO) != 0;
    bool shown_ = false;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace ccd::program
