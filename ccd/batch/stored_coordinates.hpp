// The first stage for stored queries: the coordinate axes, read from memory. Internal.
#pragma once

#include <ccd/kind.hpp>
#include <cstddef>
#include <cstdint>

#include "ccd/batch/query_queue.hpp"
#include "ccd/exact/coordinate_axes.hpp"
#include "ccd/exact/stage_timer.hpp"

namespace ccd::detail::ERRBOUND_INSTRUCTION_SET {
namespace {

/// The number of queries that the stage tests together: 48 KB.
constexpr std::size_t stored_block = 256;

/// Decides the queries from `first` on that an axis separates. Writes the others, if finite, to
/// `open` and returns their number.
template <kind K>
[[gnu::flatten]] std::size_t test_stored_coordinates(
    const typename kind_traits<K>::template query<double>* queries, std::size_t first,
    std::size_t count, const decisions& decided, std::uint32_t* open) {
    static_assert(sizeof(*queries) == 24 * sizeof(double));
    stage_timer timer(decided.report, stage::axes);
    const auto* numbers = reinterpret_cast<const double*>(queries + first);
    // The stage is bound by memory. Prefetching 40 queries ahead (8 KB) was fastest.
    const bool all_are_finite = are_finite<40>(numbers, 24 * count);
    std::size_t size = 0, finite = 0;
    for (std::size_t from = 0; from < count; from += 32) {
        const std::size_t some = lesser(count - from, 32);
        lanes apart = 0, usable = ~lanes(0) >> (32 - some);
        // Branch-free, because the results are unpredictable.
        for (std::size_t i = 0; i < some; ++i)
            apart |= lanes(packs_separated_by_coordinates<K>(numbers + 24 * (from + i))) << i;
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
