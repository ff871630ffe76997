// The stage `axes` over packs of floats. Internal.
#pragma once

#include <ccd/kind.hpp>
#include <cstddef>
#include <cstdint>

#include "ccd/batch/query_queue.hpp"
#include "ccd/batch/rounded_positions.hpp"
#include "ccd/batch/row_quads.hpp"
#include "ccd/exact/stage_timer.hpp"

namespace ccd::detail::ERRBOUND_INSTRUCTION_SET {
namespace {

constexpr std::size_t rounded_block = 256;

using float_pack = pack_of<float>;
constexpr std::size_t float_width = float_pack::size;
static_assert(rounded_block % float_width == 0 && float_width % 4 == 0);

/// Columns of rounded coordinates, ordered by point, start or end of the step, axis.
struct rounded_columns {
    alignas(64) float at[24][rounded_block + 16];

    /// Fills four lanes of point p from the rows of four vertices.
    void fill(std::size_t p, std::size_t lane, const float* const (&rows)[4]) {
        for (std::size_t end = 0; end < 2; ++end) {
            const row_quads quads(rows, end);
            for (std::size_t k = 0; k < 3; ++k)
                __builtin_memcpy(&at[6 * p + 3 * end + k][lane], &quads.axis[k],
                                 sizeof(quads.axis[k]));
        }
    }

    /// Lanes beyond the last query repeat it. Rows are prefetched, since pairs in no order of space
    /// have them far apart.
    template <class Pair>
    void fill(const float* rounded, const Pair* queries, std::size_t count) {
        for (std::size_t lane = 0; lane < count; lane += 4) {
            constexpr std::size_t ahead = 24;
            for (std::size_t i = lane + ahead; i < lane + ahead + 4 && i < count; ++i)
                for (const auto v : vertices_of(queries[i]))
                    __builtin_prefetch(rounded + rounded_positions::row * std::size_t(v));
            for (std::size_t p = 0; p < 4; ++p) {
                const float* rows[4];
                for (std::size_t i = 0; i < 4; ++i) {
                    const auto vertices = vertices_of(queries[lesser(lane + i, count - 1)]);
                    rows[i] = rounded + rounded_positions::row * std::size_t(vertices[p]);
                }
                fill(p, lane, rows);
            }
        }
    }

    template <class Pair>
    lanes separated(std::size_t lane, const rounded_axes::least_gaps& least) const {
        float_pack coordinates[3][2][4];
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t end = 0; end < 2; ++end)
                for (std::size_t p = 0; p < 4; ++p)
                    coordinates[k][end][p] =
                        float_pack::load_aligned(&at[6 * p + 3 * end + k][lane]);
        return lanes_of<float>(rounded_axes::separated<Pair>(coordinates, least));
    }
};

/// Decides the queries from `first` on that an axis separates. Writes the others to `open` and
/// returns their number.
template <class Pair>
[[gnu::flatten]] std::size_t test_rounded_axes(const float* rounded, const Pair* queries,
                                               std::size_t first, std::size_t count,
                                               const rounded_axes::least_gaps& least,
                                               const decisions& decided, std::uint32_t* open) {
    stage_timer timer(decided.report, stage::axes);
    rounded_columns columns;
    columns.fill(rounded, queries + first, count);
    std::size_t size = 0;
    for (std::size_t at = 0; at < count; at += float_width)
        for_each_lane(
            first_lanes(lesser(count - at, float_width)) & ~columns.separated<Pair>(at, least),
            [&](std::uint32_t lane) {
                open[size++] = static_cast<std::uint32_t>(first + at) + lane;
            });
    // Most are separate: it is cheaper to write all, then the undecided ones again.
    for (std::size_t i = 0; i < count; ++i) decided.answers[first + i] = outcome::separate;
    for (std::size_t i = 0; i < size; ++i) decided.answers[open[i]] = outcome::uncertain;
    timer.count(count, count - size, 0);
    return size;
}

}  // namespace
}  // namespace ccd::detail::ERRBOUND_INSTRUCTION_SET
