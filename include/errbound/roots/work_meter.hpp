// What finding roots may cost, for callers who must not wait, and its count.
#pragma once

#include <cstdint>
#include <limits>

namespace errbound {

/// What a call may spend before it gives up.
struct root_limits {
    static constexpr std::uint64_t none = (std::numeric_limits<std::uint64_t>::max)();

    /// On words of 64 bits, about a nanosecond each, counted before they are made as if no
    /// coefficient were zero.
    std::uint64_t operations = none;
    /// Of rows of numbers held at a time, estimated; p and its copies beside.
    std::uint64_t bytes = none;
};

}  // namespace errbound

namespace errbound::roots {

struct gave_up {};

/// Throws gave_up where something would go beyond the limits, before it is done.
class work_meter {
  public:
    work_meter() = default;
    explicit work_meter(const root_limits& limits) : left_(limits) {}

    void spend(std::uint64_t operations) {
        if (operations > left_.operations) throw gave_up();
        if (left_.operations != root_limits::none) left_.operations -= operations;
    }
    void hold(std::uint64_t bytes) const {
        if (bytes > left_.bytes) throw gave_up();
    }

  private:
    root_limits left_;
};

}  // namespace errbound::roots
