// Signal handlers. Some systems remove a handler when they call it.
#include "errbound/support/signals.hpp"

#include <algorithm>
#include <csignal>
#include <cstddef>

#include "errbound/support/system/system.hpp"

namespace errbound::support {
namespace {

constexpr std::array signals{SIGINT, SIGTERM};
std::atomic<int> caught = 0;  // int: on RISC-V atomic bytes are not always lock-free before g++ 13
static_assert(std::atomic<int>::is_always_lock_free, "set by a signal handler");

std::array<char, 4096> line_to_print;  // a handler must not allocate
std::size_t line_length = 0;

void catch_signal(int signal) {
    std::signal(signal, SIG_DFL);
    if (caught.exchange(signal) == 0) system::write(2, line_to_print.data(), line_length);
}

}  // namespace

awaited_signals::awaited_signals(const std::string& line) {
    caught = 0;
    line_length = std::min(line.size(), line_to_print.size());
    std::copy_n(line.begin(), line_length, line_to_print.begin());
    for (std::size_t i = 0; i < signals.size(); ++i) {
        before_[i] = std::signal(signals[i], catch_signal);
        if (before_[i] == SIG_IGN) std::signal(signals[i], SIG_IGN);
    }
}

awaited_signals::~awaited_signals() {
    for (std::size_t i = 0; i < signals.size(); ++i) std::signal(signals[i], before_[i]);
}

const std::atomic<int>& awaited_signals::arrived() const {
    return caught;
}

}  // namespace errbound::support
