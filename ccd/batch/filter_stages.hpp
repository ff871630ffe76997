// The stages of `exact` over the whole step, for packs of doubles. Internal.
#pragma once

#include <ccd/explain.hpp>
#include <ccd/kind.hpp>
#include <ccd/methods/forms.hpp>
#include <cstddef>
#include <cstdint>

#include "ccd/batch/batch_kernels.hpp"
#include "ccd/batch/pack_subdivision.hpp"
#include "ccd/batch/query_queue.hpp"
#include "ccd/exact/stage_timer.hpp"
#include "ccd/exact/static_filter/distance_margins.hpp"
#include "ccd/exact/static_filter/separating_axes.hpp"
#include "ccd/exact/static_filter/whole_step.hpp"

namespace ccd::detail::ERRBOUND_INSTRUCTION_SET {
namespace {

inline bool is_due(stage_pause& pause) {
    if (pause.blocks_to_pass == 0) return true;
    --pause.blocks_to_pass;
    return false;
}

/// Axes cost about as much as the next stage. If they decide fewer than a quarter of the queries in
/// each of several successive blocks, the next blocks skip them.
inline void update_pause(stage_pause& pause, std::size_t decided, std::size_t of) {
    constexpr std::size_t patience = 4, length = 124;
    pause.poor_blocks = 4 * decided < of ? pause.poor_blocks + 1 : 0;
    if (pause.poor_blocks >= patience) pause = {0, length};
}

/// A block of queries, in columns ordered by point, start or end of the step, axis.
struct coordinate_columns {
    static constexpr std::size_t stride = block + 8;
    alignas(64) double at[24][stride];

    void pad(std::size_t size) {
        for (std::size_t i = size; i % width != 0; ++i)
            for (auto& column : at) column[i] = 0;
    }
    template <kind K>
    linear_forms<K, pack> forms_at(std::size_t first) const {
        const auto point_at = [&](std::size_t c) {
            return point<pack>{pack::load_aligned(&at[c][first]),
                               pack::load_aligned(&at[c + 1][first]),
                               pack::load_aligned(&at[c + 2][first])};
        };
        const auto moving = [&](std::size_t c) {
            return moving_point<pack>{point_at(c), point_at(c + 3)};
        };
        using query = typename kind_traits<K>::template query<pack>;
        return linear_forms<K, pack>(query{moving(0), moving(6), moving(12), moving(18)});
    }
};

enum class axes_left { all, diagonals };

/// Decides nothing if `pause` is null or the stage pauses.
template <kind K>
[[gnu::flatten]] void test_axes(axes_left axes, const coordinate_columns& coordinates,
                                const std::uint32_t* ids, std::size_t size, stage_pause* pause,
                                const decisions& decided, difference_queue<K>& open) {
    stage_timer timer(pause != nullptr ? decided.report : nullptr, stage::axes);
    const bool due = pause != nullptr && is_due(*pause);
    std::size_t separate = 0;
    for (std::size_t at = 0; at < size; at += width) {
        const auto forms = coordinates.forms_at<K>(at);
        lanes left = first_lanes(lesser(size - at, width));
        if (due) {
            const static_filter::difference_extents<pack> extents(forms);
            pack_mask apart = static_filter::separated_by_diagonals<pack>(forms, extents);
            if (axes == axes_left::all)
                apart =
                    apart | static_filter::certainly_separated_by_coordinates<pack>(forms, extents);
            const lanes separated = left & lanes_of<double>(apart & extents.usable);
            decided.write(ids + at, separated, outcome::separate);
            separate += count_of(separated);
            left &= ~separated;
        }
        if (left != 0) open.push(forms, ids + at, left);
    }
    if (due) {
        timer.count(size, separate, 0);
        update_pause(*pause, separate, size);
    } else {
        timer.skip(size);
    }
}

template <kind K>
[[gnu::flatten]] void test_coplanarity(difference_queue<K>& waiting, double distance,
                                       const decisions& decided, difference_queue<K>& open) {
    stage_timer timer(decided.report, stage::coplanarity);
    waiting.pop_packs(block, [&](std::size_t at, std::size_t count) {
        const auto forms = waiting.forms_at(at);
        const static_filter::difference_extents<pack> extents(forms);
        const auto y = errbound::roots::control_values_of(forms.y());
        pack error = extents.template error_of_y<forms_of_kind<K>::template type>();
        if (distance > 0)
            error += static_filter::distance_margins<pack>(forms, extents, distance).y;
        const pack_mask rootless = static_filter::above(y, error) | static_filter::below(y, error);
        const lanes separate = first_lanes(count) & lanes_of<double>(extents.usable & rootless);
        const lanes left = first_lanes(count) & ~separate;
        decided.write(&waiting.ids[at], separate, outcome::separate);
        timer.count(count, count_of(separate), 0);
        if (left != 0) open.push(forms, &waiting.ids[at], left);
    });
}

/// Queries whose differences are too large for the error bounds stay uncertain.
template <kind K>
[[gnu::flatten]] void test_inside(difference_queue<K>& waiting, double distance,
                                  const decisions& decided, pack_subdivision<K>& open) {
    stage_timer timer(decided.report, stage::inside);
    waiting.pop_packs(block, [&](std::size_t at, std::size_t count) {
        const auto forms = waiting.forms_at(at);
        const static_filter::difference_extents<pack> extents(forms);
        const lanes usable = first_lanes(count) & lanes_of<double>(extents.usable);
        static_filter::whole_step<pack, forms_of_kind<K>::template type> whole(forms, extents);
        if (distance > 0) {
            const auto margins = static_filter::distance_margins<pack>(forms, extents, distance);
            whole.errors = {whole.errors.y + margins.y, whole.errors.g + margins.g};
        }
        const lanes separate = usable & lanes_of<double>(whole.outside());
        const lanes left = usable & ~separate;
        decided.write(&waiting.ids[at], separate, outcome::separate);
        timer.count(count, count_of(separate), 0);
        if (left != 0) open.push(whole, &waiting.ids[at], left);
    });
}

}  // namespace
}  // namespace ccd::detail::ERRBOUND_INSTRUCTION_SET
