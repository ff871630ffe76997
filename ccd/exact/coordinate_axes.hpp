// Separation of a query by the coordinate axes, with packs, read from memory. Internal.
#pragma once

#include <ccd/kind.hpp>
#include <cstddef>
#include <cstdint>

#include "ccd/exact/simd.hpp"

namespace ccd::detail::ERRBOUND_INSTRUCTION_SET {
namespace {

/// A moving point: x y z at the start, then x y z at the end of the step.
class six_numbers {
  public:
    explicit six_numbers(const double* at) {
#if defined __AVX512F__
        part_[0] = _mm512_maskz_loadu_pd(0x3f, at);
#else
        for (std::size_t i = 0; i < parts; ++i) part_[i] = pack::load_unaligned(at + first(i));
#endif
    }

    friend six_numbers min(const six_numbers& a, const six_numbers& b) {
        return of(a, b, [](const pack& x, const pack& y) { return min(x, y); });
    }
    friend six_numbers max(const six_numbers& a, const six_numbers& b) {
        return of(a, b, [](const pack& x, const pack& y) { return max(x, y); });
    }
    friend six_numbers operator-(const six_numbers& a, double b) {
        return of(a, a, [b](const pack& x, const pack&) { return x - pack(b); });
    }
    /// Bit k is set if the k-th coordinate of a exceeds that of b.
    friend lanes above(const six_numbers& a, const six_numbers& b) {
        lanes all = 0;
        for (std::size_t i = 0; i < parts; ++i) {
            const pack_mask m = a.part_[i] > b.part_[i];
            all |= lanes_of<double>(m) << first(i);
        }
        return all;
    }

  private:
    /// With packs of four lanes there are two parts, which overlap.
    static constexpr std::size_t parts = (6 + width - 1) / width;
    static constexpr std::size_t first(std::size_t part) {
        return width < 6 ? part * width < 6 - width ? part * width : 6 - width : 0;
    }
    six_numbers() = default;
    template <class Of>
    static six_numbers of(const six_numbers& a, const six_numbers& b, const Of& f) {
        six_numbers c;
        for (std::size_t i = 0; i < parts; ++i) c.part_[i] = f(a.part_[i], b.part_[i]);
        return c;
    }

    pack part_[parts];
};

template <std::size_t Count>
six_numbers least_of(const double* points) {
    if constexpr (Count == 1)
        return six_numbers(points);
    else
        return min(six_numbers(points), least_of<Count - 1>(points + 6));
}
template <std::size_t Count>
six_numbers greatest_of(const double* points) {
    if constexpr (Count == 1)
        return six_numbers(points);
    else
        return max(six_numbers(points), greatest_of<Count - 1>(points + 6));
}

/// Same as separated_by_coordinates (ccd/exact/features.hpp), for finite coordinates: true if an
/// axis separates the features by more than `gap`, up to the rounding of coordinates minus `gap`.
template <kind K>
bool packs_separated_by_coordinates(const double* p, double gap = 0) {
    constexpr std::size_t first = kind_traits<K>::first_vertices;
    constexpr std::size_t second = kind_traits<K>::second_vertices;
    const double* q = p + 6 * first;
    const lanes p_above = above(least_of<first>(p) - gap, greatest_of<second>(q));
    const lanes q_above = above(least_of<second>(q) - gap, greatest_of<first>(p));
    return (((p_above & p_above >> 3) | (q_above & q_above >> 3)) & 7) != 0;
}

/// True if all numbers are finite: x - x is 0, or NaN if x is not finite. Prefetches the numbers
/// that lie `Ahead` queries further on.
template <std::size_t Ahead = 0>
bool are_finite(const double* numbers, std::size_t count) {
    constexpr std::size_t line = 8, packs = 24 / width;
    pack zeros[packs];
    for (pack& z : zeros) z = pack(0.0);
    for (std::size_t at = 0; at < count; at += 24)
        for (std::size_t i = 0; i < packs; ++i) {
            const double* next = &numbers[at + i * width];
            if (Ahead > 0 && i * width % line == 0) {
                // An integer, because a pointer past the last query would be undefined behaviour.
                const auto address = std::uintptr_t(next) + Ahead * 24 * sizeof(double);
                __builtin_prefetch(reinterpret_cast<const void*>(address));
            }
            const pack x = pack::load_unaligned(next);
            zeros[i] += x - x;
        }
    pack sum(0.0);
    for (const pack& z : zeros) sum += z;
    const pack_mask zero = sum == pack(0.0);
    return lanes_of<double>(zero) == first_lanes(width);
}

}  // namespace
}  // namespace ccd::detail::ERRBOUND_INSTRUCTION_SET
