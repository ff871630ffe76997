// Numbers that tell sources of errors apart, for bound rules that keep terms by source.
#pragma once

#include <atomic>
#include <cstdint>
#include <type_traits>

namespace errbound::detail {

/// Stands for a source that cannot be told from others.
inline constexpr std::uint64_t no_source = 0;

#if !defined(__CUDA_ARCH__)
/// Another number at each call, on whatever thread; ascending on each. Threads draw blocks of them,
/// 2^48 of which there are. (Libraries that hide their symbols must not have a count of their own.)
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

/// A source that is no other number's; no_source where none can be had: in constant expressions and
/// in device code. To be asked for in an argument: what initialises a const integer is taken for a
/// constant expression.
constexpr std::uint64_t fresh_source() {
#if !defined(__CUDA_ARCH__)
    if (!std::is_constant_evaluated()) return next_source();
#endif
    return no_source;
}

}  // namespace errbound::detail
