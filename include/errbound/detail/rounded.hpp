// Rounds products separately, despite compilers' contraction defaults.
#pragma once

#include <concepts>
#include <type_traits>

namespace errbound::detail {

/// Returns x, which the compiler then cannot fuse into a sum (-ffp-contract=fast, GCC's default,
/// fuses across statements). Costs nothing if there is no fused multiply-add (x86-64 by default).
/// Elsewhere the function is an empty asm statement, which prevents vectorising; g++ 12 drops
/// __builtin_assoc_barrier. Class types are returned unchanged: build SIMD packs with
/// -ffp-contract=off.
template <class T>
constexpr T rounded(const T& x) {
    return x;
}

/// False if the target has no instruction to fuse.
#if defined(__x86_64__) && !defined(__CUDACC__) && !defined(__FMA__) && !defined(__FMA4__) && \
    !defined(__AVX512F__)
inline constexpr bool may_contract = false;
#else
inline constexpr bool may_contract = true;
#endif

#if defined(__CUDA_ARCH__)
constexpr double rounded(const double& x) {
    return std::is_constant_evaluated() ? x : __dadd_rn(x, -0.0);
}
constexpr float rounded(const float& x) {
    return std::is_constant_evaluated() ? x : __fadd_rn(x, -0.0f);
}
#elif defined(__GNUC__)
#if !defined(__x86_64__) || defined(__FMA__) || defined(__FMA4__) || defined(__AVX512F__)
template <std::floating_point T>
constexpr T rounded(const T& x) {
    if (std::is_constant_evaluated()) return x;
    T y = x;
#if defined(__x86_64__)
    // Long doubles are x87's or a library's, which do not fuse.
    if constexpr (sizeof(T) <= sizeof(double)) asm("" : "+x"(y));
#elif defined(__aarch64__)
    asm("" : "+w"(y));
#else
    asm("" : "+m"(y));
#endif
    return y;
}
#endif
#ifdef __FLOAT128_HARDWARE__  // POWER9 also fuses products of 113 bits
constexpr __float128 rounded(const __float128& x) {
    if (std::is_constant_evaluated()) return x;
    __float128 y = x;
    asm("" : "+m"(y));
    return y;
}
#endif
#endif

template <class T>
constexpr T rounded_product(const T& a, const T& b) {
#if defined(__CUDA_ARCH__)
    if (!std::is_constant_evaluated()) {
        if constexpr (std::is_same_v<T, double>)
            return __dmul_rn(a, b);
        else if constexpr (std::is_same_v<T, float>)
            return __fmul_rn(a, b);
    }
#endif
    return rounded(T(a * b));
}

}  // namespace errbound::detail
