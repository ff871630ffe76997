#include "ccd/step_frames.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>
#include <tbb/parallel_sort.h>

#include <cstdint>
#include <limits>

namespace ccd {
namespace {

/// Position on the curve in the upper half, element in the lower.
using curve_key = std::uint64_t;

index element_of(curve_key key) {
    return static_cast<index>(key);
}
std::uint32_t position_of(curve_key key) {
    return static_cast<std::uint32_t>(key >> 32);
}

/// Cells of the curve along an axis.
constexpr std::uint32_t cells = 1024;

/// The ten bits of x with two zeros before each.
std::uint32_t spread_bits(std::uint32_t x) {
    x = (x | (x << 16)) & 0x030000FF;
    x = (x | (x << 8)) & 0x0300F00F;
    x = (x | (x << 4)) & 0x030C30C3;
    return (x | (x << 2)) & 0x09249249;
}

struct extent {
    std::array<float, 3> low, high;      ///< of the boxes' middles
    std::array<double, 3> length_sum{};  ///< of the boxes
};

float middle(const float_box& b, std::size_t k) {
    return 0.5F * (b.low[k] + b.high[k]);
}

template <class BoxOf>
extent extent_of(std::span<const curve_key> keys, const BoxOf& box_of) {
    const float_box first = box_of(element_of(keys.front()));
    extent none;
    for (std::size_t k = 0; k < 3; ++k) none.low[k] = none.high[k] = middle(first, k);
    return tbb::parallel_deterministic_reduce(
        tbb::blocked_range<std::size_t>(0, keys.size(), 4096), none,
        [&](const tbb::blocked_range<std::size_t>& range, extent e) {
            for (std::size_t i = range.begin(); i < range.end(); ++i) {
                const float_box b = box_of(element_of(keys[i]));
                for (std::size_t k = 0; k < 3; ++k) {
                    e.low[k] = std::min(e.low[k], middle(b, k));
                    e.high[k] = std::max(e.high[k], middle(b, k));
                    e.length_sum[k] += b.high[k] - b.low[k];
                }
            }
            return e;
        },
        [](extent a, const extent& b) {
            for (std::size_t k = 0; k < 3; ++k) {
                a.low[k] = std::min(a.low[k], b.low[k]);
                a.high[k] = std::max(a.high[k], b.high[k]);
                a.length_sum[k] += b.length_sum[k];
            }
            return a;
        });
}

/// Sorts the keys by the middles of their elements' boxes. Cells are as many times longer on one
/// axis than on another as the boxes are: an axis on which boxes are long tells few of them apart.
/// What then shares a cell is sorted again by finer cells, so that neither a remote element nor a
/// huge one leaves the others in disorder.
template <class BoxOf>
void sort_along_curve(std::span<curve_key> keys, const BoxOf& box_of) {
    const extent e = extent_of(keys, box_of);
    std::array<double, 3> length{};  // of the boxes on the average, but at least that of a cell
    double most_lengths = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const double spread = double(e.high[k]) - e.low[k];
        length[k] = std::max(e.length_sum[k] / static_cast<double>(keys.size()), spread / cells);
        if (spread > 0) most_lengths = std::max(most_lengths, spread / length[k]);
    }
    if (most_lengths == 0) return;  // one middle for all

    const double cells_a_length = (cells - 1) / most_lengths;
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, keys.size(), 4096),
        [&](const tbb::blocked_range<std::size_t>& range) {
            for (std::size_t i = range.begin(); i < range.end(); ++i) {
                const index element = element_of(keys[i]);
                const float_box b = box_of(element);
                std::uint32_t position = 0;
                for (std::size_t k = 0; k < 3; ++k) {
                    if (length[k] == 0) continue;
                    const double cell =
                        (double(middle(b, k)) - e.low[k]) / length[k] * cells_a_length;
                    position |= spread_bits(std::min(static_cast<std::uint32_t>(cell), cells - 1))
                                << k;
                }
                keys[i] = curve_key(position) << 32 | element;
            }
        });
    tbb::parallel_sort(keys.begin(), keys.end());

    for (std::size_t begin = 0, end = 0; begin < keys.size(); begin = end) {
        while (end < keys.size() && position_of(keys[end]) == position_of(keys[begin])) ++end;
        if (end - begin > box_pack::size && end - begin < keys.size())
            sort_along_curve(keys.subspan(begin, end - begin), box_of);
    }
}

}  // namespace

step_frames::step_frames(const mesh& before, const mesh& after)
    : before_(before.vertices), after_(after.vertices) {
    if (before_.empty()) return;
    exact_box all;
    all.low = all.high = coordinates(before_, 0);
    for (const std::vector<point<double>>* frame : {&before_, &after_})
        for (std::size_t v = 0; v < frame->size(); ++v)
            widen(all, coordinates(*frame, static_cast<index>(v)));
    for (std::size_t k = 0; k < 3; ++k) {
        // Halved before adding, and the inverse bounded: neither may overflow.
        middle_[k] = all.low[k] / 2 + all.high[k] / 2;
        const double radius = std::max(all.high[k] - middle_[k], middle_[k] - all.low[k]);
        scale_[k] = std::min(1 / radius, std::numeric_limits<double>::max());
    }
}

template <std::size_t N>
std::vector<std::array<index, N>> step_frames::along_curve(
    std::span<const std::array<index, N>> elements) const {
    std::vector<curve_key> keys(elements.size());
    for (std::size_t i = 0; i < keys.size(); ++i) keys[i] = i;
    if (!keys.empty())
        sort_along_curve(std::span(keys), [&](index i) { return rounded_box(elements[i]); });
    std::vector<std::array<index, N>> ordered(elements.size());
    for (std::size_t i = 0; i < keys.size(); ++i) ordered[i] = elements[element_of(keys[i])];
    return ordered;
}

template std::vector<std::array<index, 1>> step_frames::along_curve(
    std::span<const std::array<index, 1>>) const;
template std::vector<edge> step_frames::along_curve(std::span<const edge>) const;
template std::vector<face> step_frames::along_curve(std::span<const face>) const;

}  // namespace ccd
