// Limits on the cost of finding roots, for callers that must not wait.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <utility>

namespace errbound {

/// The limits of a call before it gives up.
struct root_limits {
    static constexpr std::uint64_t none = (std::numeric_limits<std::uint64_t>::max)();

    /// Operations on 64-bit words, about a nanosecond each; zero coefficients count like all
    /// others.
    std::uint64_t operations = none;
    /// Estimated bytes of the rows held at a time, without p and its copies.
    std::uint64_t bytes = none;
    /// Polled periodically; return true to cancel. The returned real_roots keep it and poll it too.
    std::function<bool()> stop = {};
};

}  // namespace errbound

namespace errbound::roots {

struct gave_up {};

/// Throws gave_up before work beyond the limits, or if stopped.
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
    void lift() { left_.operations = left_.bytes = root_limits::none; }

  private:
    root_limits left_;
};

}  // namespace errbound::roots
