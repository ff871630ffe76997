// Bit counts for the host and CUDA devices. In constexpr functions, nvcc silently calls address 0
// for those of <bit>; tests/ccd/cuda/null_calls.py searches for such calls.
#pragma once

#include <bit>
#include <limits>
#include <type_traits>

namespace errbound::detail {

/// All of T's bits for x == 0, as in <bit>.
template <class T>
constexpr int countl_zero(T x) {
#ifdef __CUDA_ARCH__
    constexpr int digits = std::numeric_limits<T>::digits;
    static_assert(std::is_unsigned_v<T> && digits <= 64);
    if (!std::is_constant_evaluated()) return __clzll(static_cast<long long>(x)) - (64 - digits);
    int zeros = digits;
    for (; x != 0; x = static_cast<T>(x >> 1)) --zeros;
    return zeros;
#else
    return std::countl_zero(x);
#endif
}

template <class T>
constexpr int countr_zero(T x) {
#ifdef __CUDA_ARCH__
    if (x == 0) return std::numeric_limits<T>::digits;
    return std::numeric_limits<T>::digits - 1 -
           countl_zero(static_cast<T>(x & static_cast<T>(~x + 1)));
#else
    return std::countr_zero(x);
#endif
}

template <class T>
constexpr int bit_width(T x) {
    return std::numeric_limits<T>::digits - countl_zero(x);
}

}  // namespace errbound::detail
