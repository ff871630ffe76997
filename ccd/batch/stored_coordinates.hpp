// The first stage of stored queries: the coordinate axes, on their numbers as they lie in memory.
// Internal; for kernels.
#pragma once

#include <ccd/kind.hpp>
#include <cstddef>
#include <cstdint>

#include "ccd/batch/query_queue.hpp"
#include "ccd/batch/simd.hpp"
#include "ccd/exact/stage_timer.hpp"

namespace ccd::detail::ERRBOUND_INSTRUCTION_SET {
namespace {

/// Queries that the stage looks at together: 48 KB.
constexpr std::size_t stored_block = 256;

/// The coordinates of a point in motion: x y z at the start, x y z at the end of the step.
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
        return of(a, b, [](const pack& x, const pack& y) { return xsimd::min(x, y); });
    }
    friend six_numbers max(const six_numbers& a, const six_numbers& b) {
        return of(a, b, [](const pack& x, const pack& y) { return xsimd::max(x, y); });
    }
    /// Those of a that exceed b's: bit k is the k-th.
    friend lanes above(const six_numbers& a, const six_numbers& b) {
        lanes all = 0;
        for (std::size_t i = 0; i < parts; ++i) {
            const pack_mask m = a.part_[i] > b.part_[i];
            all |= lanes_of<double>(m) << first(i);
        }
        return all;
    }

  private:
    /// Of four lanes there are two parts, which overlap.
    static constexpr std::size_t parts = (6 + width - 1) / width;
    static constexpr std::size_t first(std::size_t part) {
        return width < 6 ? lesser(part * width, 6 - width) : 0;
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

/// The least and the greatest coordinates of `Count` points.
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

/// separated_by_coordinates of ccd/exact/features.hpp.
template <kind K>
bool separated_as_stored(const double* p) {
    constexpr std::size_t first = kind_traits<K>::first_vertices;
    constexpr std::size_t second = kind_traits<K>::second_vertices;
    const double* q = p + 6 * first;
    const lanes p_above = above(least_of<first>(p), greatest_of<second>(q));
    const lanes q_above = above(least_of<second>(q), greatest_of<first>(p));
    return (((p_above & p_above >> 3) | (q_above & q_above >> 3)) & 7) != 0;
}

/// Whether all of them are finite: x - x is 0, or NaN if x is not. Reads ahead: that these numbers
/// come from memory is what the stage waits for.
inline bool are_finite(const double* numbers, std::size_t count) {
    constexpr std::size_t ahead = 40 * 24 * sizeof(double), line = 8, packs = 24 / width;
    pack zeros[packs];
    for (pack& z : zeros) z = pack(0.0);
    for (std::size_t at = 0; at < count; at += 24)
        for (std::size_t i = 0; i < packs; ++i) {
            const double* next = &numbers[at + i * width];
            if (i * width % line == 0)  // perhaps beyond the last query: no pointer may be there
                __builtin_prefetch(reinterpret_cast<const void*>(std::uintptr_t(next) + ahead));
            const pack x = pack::load_unaligned(next);
            zeros[i] += x - x;
        }
    pack sum(0.0);
    for (const pack& z : zeros) sum += z;
    const pack_mask zero = sum == pack(0.0);
    return lanes_of<double>(zero) == first_lanes(width);
}

/// Decides those of the queries first, first + 1, ... that a coordinate axis separates, and writes
/// the others, if they are finite, to `open`. Returns how many these are.
template <kind K>
[[gnu::flatten]] std::size_t test_stored_coordinates(
    const typename kind_traits<K>::template query<double>* queries, std::size_t first,
    std::size_t count, const decisions& decided, std::uint32_t* open) {
    static_assert(sizeof(*queries) == 24 * sizeof(double));
    stage_timer timer(decided.report, stage::axes);
    const auto* numbers = reinterpret_cast<const double*>(queries + first);
    const bool all_are_finite = are_finite(numbers, 24 * count);
    std::size_t size = 0, finite = 0;
    for (std::size_t from = 0; from < count; from += 32) {
        const std::size_t some = lesser(count - from, 32);
        lanes apart = 0, usable = ~lanes(0) >> (32 - some);
        // Without branches: which are apart is as good as random.
        for (std::size_t i = 0; i < some; ++i)
            apart |= lanes(separated_as_stored<K>(numbers + 24 * (from + i))) << i;
        if (!all_are_finite)
            for (std::size_t i = 0; i < some; ++i)
                if (!are_finite(numbers + 24 * (from + i), 24)) usable &= ~(lanes(1) << i);
        for (std::size_t i = 0; i < some; ++i)
            decided.answers[first + from + i] =
                (apart & usable) >> i & 1 ? outcome::separate : outcome::uncertain;
        for_each_lane(usable & ~apart, [&](std::uint32_t i) {
            open[size++] = static_cast<std::uint32_t>(first + from) + i;
        });
        finite += count_of(usable);
    }
    timer.count(finite - size, finite - size, 0);
    return size;
}

}  // namespace
}  // namespace ccd::detail::ERRBOUND_INSTRUCTION_SET
