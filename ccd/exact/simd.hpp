// Packs of doubles and of floats, and functions that xsimd 8 lacks. Internal; see
// ccd/batch/batch_kernels.hpp for the rules of headers that kernels include.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <xsimd/xsimd.hpp>

#ifndef ERRBOUND_INSTRUCTION_SET  // for files that are compiled only once
#define ERRBOUND_INSTRUCTION_SET baseline
#endif

// xsimd has packs of doubles on x86 and 64-bit ARM only.
#if !XSIMD_WITH_SSE2 && !XSIMD_WITH_NEON64
#define ERRBOUND_VECTOR_PACKS
#include "ccd/exact/vector_pack.hpp"
#endif

namespace ccd::detail::ERRBOUND_INSTRUCTION_SET {
namespace {

#ifdef ERRBOUND_VECTOR_PACKS
template <class T>
using pack_of = vector_pack<T>;
template <class T>
using mask_of = vector_mask<T>;
#else
template <class T>
using pack_of = xsimd::batch<T, xsimd::default_arch>;
template <class T>
using mask_of = xsimd::batch_bool<T, xsimd::default_arch>;
#endif

using pack = pack_of<double>;
using pack_mask = mask_of<double>;
constexpr std::size_t width = pack::size;

/// A set of lanes: bit i is lane i.
using lanes = std::uint32_t;

inline std::size_t count_of(lanes some) {
    return static_cast<std::size_t>(__builtin_popcount(some));
}
inline lanes first_lanes(std::size_t count) {
    return (lanes(1) << count) - 1;
}

template <class Visit>
inline void for_each_lane(lanes some, const Visit& visit) {
    for (; some != 0; some &= some - 1) visit(static_cast<std::uint32_t>(__builtin_ctz(some)));
}

template <class T>
lanes lanes_of(const mask_of<T>& m) {
#if defined __AVX512F__
    return m.data;
#elif defined __AVX__
    if constexpr (sizeof(T) == sizeof(double))
        return static_cast<lanes>(_mm256_movemask_pd(m));
    else
        return static_cast<lanes>(_mm256_movemask_ps(m));
#elif defined __SSE2__
    if constexpr (sizeof(T) == sizeof(double))
        return static_cast<lanes>(_mm_movemask_pd(m));
    else
        return static_cast<lanes>(_mm_movemask_ps(m));
#elif defined ERRBOUND_VECTOR_PACKS
    return m.bits();
#else
    if constexpr (sizeof(T) == sizeof(double))
        return static_cast<lanes>(vaddvq_u64(vandq_u64(m, uint64x2_t{1, 2})));
    else
        return vaddvq_u32(vandq_u32(m, uint32x4_t{1, 2, 4, 8}));
#endif
}

#ifndef ERRBOUND_VECTOR_PACKS
/// xsimd 8 takes the pack's type as argument, later versions the numbers'.
template <class To, class From>
To with_bits_of(const From& x) {
    if constexpr (requires {
                      { xsimd::bitwise_cast<To>(x) } -> std::same_as<To>;
                  })
        return xsimd::bitwise_cast<To>(x);
    else
        return xsimd::bitwise_cast<typename To::value_type>(x);
}
#endif

/// The double after t > 0 where `after` is set, else the one before it.
inline pack neighbour(const pack& t, const pack_mask& after) {
#ifdef ERRBOUND_VECTOR_PACKS
    return select(after, pack::of_bits(bits_of(t) + 1), pack::of_bits(bits_of(t) - 1));
#else
    using integers = pack_of<std::int64_t>;
    const auto bits = with_bits_of<integers>(t);
    return select(after, with_bits_of<pack>(bits + integers(1)),
                  with_bits_of<pack>(bits - integers(1)));
#endif
}

#if defined __AVX2__ && !defined __AVX512F__
/// For each subset of four lanes, the order that moves its lanes to the front (as halves of
/// doubles).
struct lane_orders {
    alignas(32) std::int32_t halves[16][8];

    constexpr lane_orders() : halves() {
        for (int some = 0; some < 16; ++some) {
            int k = 0;
            for (int lane = 0; lane < 4; ++lane) {
                if ((some >> lane & 1) == 0) continue;
                halves[some][k++] = 2 * lane;
                halves[some][k++] = 2 * lane + 1;
            }
        }
    }
};
constexpr lane_orders orders;
#endif

/// Writes the lanes of the set one after the other. May write up to a pack's width.
inline void compress(const pack& values, lanes some, double* to) {
#if defined __AVX512F__
    _mm512_storeu_pd(to, _mm512_maskz_compress_pd(static_cast<__mmask8>(some), values));
#elif defined __AVX2__
    const __m256i order = _mm256_load_si256(reinterpret_cast<const __m256i*>(orders.halves[some]));
    const __m256 packed = _mm256_permutevar8x32_ps(_mm256_castpd_ps(values), order);
    _mm256_storeu_pd(to, _mm256_castps_pd(packed));
#else
    double all[width];
    values.store_unaligned(all);
    std::size_t k = 0;
    for (std::size_t i = 0; i < width; ++i) {
        to[k] = all[i];
        k += some >> i & 1;
    }
#endif
}

}  // namespace
}  // namespace ccd::detail::ERRBOUND_INSTRUCTION_SET
