// Handlers of the signals that end long work.
#include "errbound/support/signals.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstddef>

namespace errbound::support {
namespace {

constexpr std::array signals{SIGINT, SIGTERM};
std::atomic<bool> caught = false;
std::atomic<int> which = 0;
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free,
              "set by a signal handler");

// A handler may not allocate.
std::array<char, 4096> line_to_print;
std::size_t line_length = 0;

void catch_signal(int signal) {
    which = signal;
    if (caught.exchange(true)) return;
    [[maybe_unused]] const ssize_t ignored =
        ::write(STDERR_FILENO, line_to_print.data(), line_length);
}

}  // namespace

awaited_signals::awaited_signals(const std::string& line) {
    caught = false;
    line_length = std::min(line.size(), line_to_print.size());
    std::copy_n(line.begin(), line_length, line_to_print.begin());
    struct sigaction action {};
    action.sa_handler = catch_signal;
    action.sa_flags = SA_RESTART | static_cast<int>(SA_RESETHAND);
    for (std::size_t i = 0; i < signals.size(); ++i) {
        sigaction(signals[i], nullptr, &before_[i]);
        if (before_[i].sa_handler != SIG_IGN) sigaction(signals[i], &action, nullptr);
    }
}

awaited_signals::~awaited_signals() {
    for (std::size_t i = 0; i < signals.size(); ++i) sigaction(signals[i], &before_[i], nullptr);
}

const std::atomic<bool>& awaited_signals::arrived() const {
    return caught;
}

int awaited_signals::signal() const {
    return which;
}

}  // namespace errbound::support
