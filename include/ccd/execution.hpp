// How calls for many queries run: the instruction set, and how the host ends a call early.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <stdexcept>
#include <string_view>

namespace ccd {

/// The instruction sets for which the kernels are compiled.
enum class instruction_set : std::uint8_t {
    baseline,  ///< every machine of the architecture (SSE2 on x86-64)
    avx2,      ///< with FMA
    avx512,
};
/// Returns the sets that this build contains and this machine runs, weakest first.
std::span<const instruction_set> instruction_sets();
std::string_view name(instruction_set set);
std::optional<instruction_set> find_instruction_set(std::string_view name);

/// Thrown by a call that its stop_query ended. The call's output is unspecified; objects are as
/// before the call and can be used again.
struct stopped : std::runtime_error {
    stopped() : std::runtime_error("ccd: stopped by the caller") {}
};

/// A callback that is polled periodically, by several threads at once, among them the calling
/// thread, where a host can check for signals. Return true to end the call by the exception
/// `stopped`; an exception from the callback ends it, too. Empty: never polled.
///
/// Batches poll every few thousand queries; with distances, for each first time. Steps poll for
/// each block of candidates and during the search, but not while they sort elements and pairs.
/// Steps of bodies also poll during the exact computations of each pair.
using stop_query = std::function<bool()>;

namespace detail {

inline void stop_if_requested(const stop_query& stop) {
    if (stop && stop()) throw stopped();
}

}  // namespace detail

}  // namespace ccd
