// A product that is rounded by itself, whatever the compiler's contraction default.
#pragma once

#include <concepts>
#include <type_traits>

namespace errbound::detail {

/// x as a number of its own: a product in it is not fused into the sum that uses it
/// (-ffp-contract=fast, GCC's default, does so across statements and inlined calls, and
/// fma(a, b, c) is not the sum of the rounded product). Identity in value; no instruction is made
/// for it.
///
/// Where the target has no fused multiply-add (x86-64 by default), it is nothing at all. Elsewhere
/// it is an empty asm statement through a register, which also keeps the product out of the
/// compiler's vectorised loops. (__builtin_assoc_barrier is no substitute: g++ 12 forgets it when
/// it vectorises, and fuses.) Types of one's own are left alone: what they are made of (SIMD packs)
/// must be built with -ffp-contract=off; library types (Boost.Multiprecision) never fuse. In CUDA
/// device code it is an addition of −0 by an intrinsic that is never fused.
template <class T>
constexpr T rounded(const T& x) {
    return x;
}

/// False where no compiler can fuse, for want of an instruction.
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
#ifdef __FLOAT128_HARDWARE__  // POWER9 fuses products of 113 bits, too
constexpr __float128 rounded(const __float128& x) {
    if (std::is_constant_evaluated()) return x;
    __float128 y = x;
    asm("" : "+m"(y));
    return y;
}
#endif
#endif

/// a·b, rounded by itself.
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
