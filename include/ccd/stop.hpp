// How a host ends a call that takes too long for it.
#pragma once

#include <functional>
#include <stdexcept>

namespace ccd {

/// Thrown by a call that was asked to stop. What it was to write is not to be used; objects are as
/// before the call, and can be called again.
struct stopped : std::runtime_error {
    stopped() : std::runtime_error("ccd: stopped, as the caller asked") {}
};

/// Asked now and then, from several threads at once, among them the one that calls (so a host can
/// look there for signals of its own): true ends the call by `stopped`. Empty: goes to the end.
/// What it throws ends the call, too. Batches ask every few thousand queries, or for each time of a
/// contact; steps for each block of candidates and part of a search, but not while elements and
/// pairs are sorted.
using stop_query = std::function<bool()>;

namespace detail {

inline void stop_if_asked(const stop_query& stop) {
    if (stop && stop()) throw stopped();
}

}  // namespace detail

}  // namespace ccd
