// Progress on a terminal.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdio>
#include <string>

#include "errbound/support/system/system.hpp"

namespace errbound::support {

/// A bar on standard error after the first second, removed at the end.
class progress_line {
  public:
    progress_line() = default;
    progress_line(const progress_line&) = delete;
    progress_line& operator=(const progress_line&) = delete;
    ~progress_line() { clear(); }

    /// `done` of `total` > 0 parts are done; `what` is running.
    void show(std::size_t done, std::size_t total, const std::string& what) {
        draw(static_cast<double>(done) / static_cast<double>(total),
             std::to_string(done) + '/' + std::to_string(total) + ' ' + what);
    }
    void show(double share, const std::string& what) {
        draw(share, std::to_string(static_cast<int>(100 * share)) + " % " + what);
    }
    void clear() {
        if (shown_) std::fputs("\r\x1b[K", stderr);
        shown_ = false;
    }

  private:
    void draw(double share, const std::string& text) {
        using std::chrono::steady_clock;
        if (!is_terminal_ || steady_clock::now() - start_ < std::chrono::seconds(1)) return;
        shown_ = true;
        constexpr std::size_t width = 30;
        std::string bar(static_cast<std::size_t>(share * width), '#');
        bar.resize(width, '.');
        std::fprintf(stderr, "\r\x1b[K[%s] %s", bar.c_str(), text.c_str());
        std::fflush(stderr);
    }

    bool is_terminal_ = system::is_terminal(2);
    bool shown_ = false;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace errbound::support
