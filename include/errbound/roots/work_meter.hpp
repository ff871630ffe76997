// Limits of what finding roots may cost, for callers that must not wait, and the meter that counts.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <utility>

namespace errbound {

/// What a call may spend before it gives up.
struct root_limits {
    static constexpr std::uint64_t none = (std::numeric_limits<std::uint64_t>::max)();

    /// On words of 64 bits, about a nanosecond each, counted before they are made as if no
    /// coefficient were zero.
    std::uint64_t operations = none;
    /// Of rows of numbers held at a time, estimated; p and its copies beside.
    std::uint64_t bytes = none;
    /// Polled periodically; true gives up. Real roots poll it in later calls, too. Empty: never.
    std::function<bool()> stop = {};
};

}  // namespace errbound

namespace errbound::roots {

struct gave_up {};

/// Throws gave_up where something would go beyond the limits, before it is done, or if stopped.
class work_meter {
  public:
    work_meter() = default;
    explicit work_meter(root_limits limits) : left_(std::move(limits)) {}

    void poll() {
        if (left_.stop && left_.stop()) throw gave_up();
    }
    void spend(std::uint64_t operations) {
        poll();
        if (operations > left_.operations) throw gave_up();
        if (left_.operations != root_limits::none) left_.operations -= operations;
    }
    void hold(std::uint64_t bytes) const {
        if (bytes > left_.bytes) throw gave_up();
    }
    /// Removes the limits of operations and bytes.
    void lift() { left_.operations = left_.bytes = root_limits::none; }

  private:
    root_limits left_;
};

}  // namespace errbound::roots
