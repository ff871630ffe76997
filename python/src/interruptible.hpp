// Long calls without the interpreter's lock. Signals whose handlers raise end them.
#pragma once

#include <nanobind/nanobind.h>

#include <algorithm>
#include <ccd/execution.hpp>
#include <chrono>
#include <cstddef>
#include <thread>

namespace errbound::python {

namespace nb = nanobind;

/// A ccd::stop_query that periodically runs handlers of pending signals on the calling thread
/// (Python runs them only on its main thread). True if one raised, for example for Ctrl-C.
class pending_signals {
  public:
    bool operator()() {
        if (std::this_thread::get_id() != caller_) return false;
        const auto now = clock::now();
        if (now < next_) return false;
        next_ = now + pause;
        nb::gil_scoped_acquire held;
        return PyErr_CheckSignals() != 0;
    }

  private:
    using clock = std::chrono::steady_clock;
    static constexpr std::chrono::milliseconds pause{50};
    std::thread::id caller_ = std::this_thread::get_id();
    clock::time_point next_ = clock::now() + pause;
};

/// Returns call(stop). If a signal stopped it, throws the exception of the signal's handler, or
/// KeyboardInterrupt if the handler ran in another process.
template <class Call>
auto without_gil(const Call& call) {
    try {
        nb::gil_scoped_release released;
        return call(ccd::stop_query(pending_signals()));
    } catch (const ccd::stopped&) {
        if (!PyErr_Occurred()) PyErr_SetString(PyExc_KeyboardInterrupt, "stopped on another rank");
        throw nb::python_error();
    }
}

/// Calls visit(first, count) for chunks of `size` items, and tests for signals before each.
template <class Visit>
void in_parts(std::size_t count, std::size_t size, const Visit& visit) {
    without_gil([&](const ccd::stop_query& stop) {
        for (std::size_t first = 0; first < count; first += size) {
            if (stop()) throw ccd::stopped();
            visit(first, std::min(size, count - first));
        }
    });
}

}  // namespace errbound::python
