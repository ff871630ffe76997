// Numbers for sources of errors, for bound rules that keep terms by source.
#pragma once

#include <atomic>
#include <cstdint>
#include <type_traits>

namespace errbound::detail {

inline constexpr std::uint64_t no_source = 0;

#if !defined(__CUDA_ARCH__)
/// Returns a new number at each call, on any thread. Numbers ascend on each thread, which draws
/// them in blocks. (Libraries with hidden symbols must share this counter.)
#if defined(__GNUC__) && !defined(_WIN32)
[[gnu::visibility("default")]]
#endif
inline std::uint64_t
next_source() {
    constexpr std::uint64_t block = 1 << 16;
    static std::atomic<std::uint64_t> drawn = block;
    thread_local std::uint64_t next = 0, end = 0;
    if (next == end) {
        next = drawn.fetch_add(block, std::memory_order_relaxed);
        end = next + block;
    }
    return next++;
}
#endif

/// Returns a new source, or no_source in constant expressions and device code. Pass the call as an
/// argument: `const std::uint64_t s = fresh_source();` is evaluated as a constant expression, so s
/// would be no_source.
constexpr std::uint64_t fresh_source() {
#if !defined(__CUDA_ARCH__)
    if (!std::is_constant_evaluated()) return next_source();
#endif
    return no_source;
}

}  // namespace errbound::detail
