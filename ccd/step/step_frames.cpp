// The order of elements along a space-filling curve (Morton, "A computer oriented geodetic data
// base and a new technique in file sequencing", 1966).
#include "ccd/step/step_frames.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <cstdint>
#include <numeric>

#include "ccd/step/elements.hpp"

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
constexpr unsigned curve_bits = 30;
constexpr std::size_t leaf_size = box_pack<float>::size;

template <class Real>
double middle(const box<Real>& b, std::size_t k) {
    return 0.5 * double(b.low[k]) + 0.5 * double(b.high[k]);
}

void widen(box<double>& b, const box<double>& other) {
    for (std::size_t k = 0; k < 3; ++k) {
        b.low[k] = std::min(b.low[k], other.low[k]);
        b.high[k] = std::max(b.high[k], other.high[k]);
    }
}

template <class BoxOf>
box<double> box_of_middles(std::span<const curve_key> keys, const BoxOf& box_of) {
    const auto middle_of = [&](curve_key key) {
        const auto b = box_of(element_of(key));
        const std::array<double, 3> m{middle(b, 0), middle(b, 1), middle(b, 2)};
        return box<double>{m, m};
    };
    return tbb::parallel_deterministic_reduce(
        tbb::blocked_range<std::size_t>(0, keys.size(), 4096), middle_of(keys.front()),
        [&](const tbb::blocked_range<std::size_t>& range, box<double> all) {
            for (std::size_t i = range.begin(); i < range.end(); ++i)
                widen(all, middle_of(keys[i]));
            return all;
        },
        [](box<double> a, const box<double>& b) {
            widen(a, b);
            return a;
        });
}

/// The sampling stride of `count` to take for a sample of about a thousand.
std::size_t sample_stride(std::size_t count) {
    return 1 + count / 1024;
}

/// By radix: serial, but beside the rest of the work hardly to be seen, which no sort by
/// comparisons on a few cores was.
void sort_keys(std::span<curve_key> keys) {
    constexpr std::size_t few = 4096, digit_bits = 8;
    if (keys.size() < few) {
        std::ranges::sort(keys);
        return;
    }
    std::vector<curve_key> buffer(keys.size());
    std::span<curve_key> from = keys, to = buffer;
    for (std::size_t shift = 32; shift < 64; shift += digit_bits) {
        const auto digit = [shift](curve_key key) { return (key >> shift) % (1U << digit_bits); };
        std::array<std::size_t, (1U << digit_bits) + 1> start{};
        for (const curve_key key : from) ++start[digit(key) + 1];
        std::partial_sum(start.begin(), start.end(), start.begin());
        for (const curve_key key : from) to[start[digit(key)]++] = key;
        std::swap(from, to);
    }
}

/// Calls visit(run) for all runs of keys whose positions have the same upper bits.
template <class Visit>
void for_each_run(std::span<curve_key> keys, unsigned lower_bits, const Visit& visit) {
    const auto upper = [lower_bits](curve_key key) { return position_of(key) >> lower_bits; };
    for (std::size_t begin = 0, end = 0; begin < keys.size(); begin = end) {
        while (end < keys.size() && upper(keys[end]) == upper(keys[begin])) ++end;
        visit(keys.subspan(begin, end - begin));
    }
}

/// Sorts the keys by their elements' boxes: along a Morton curve through the middles, which gathers
/// in each leaf boxes that are near each other.
///
/// Cells of the curve are as many times longer on one axis than on another as the boxes are: an
/// axis on which boxes are long tells few of them apart. Boxes of no length get cubes. Boxes that
/// are long beside the whole (and not of `one_kind`) come after all others, by the axis on which
/// they are longest, each kind along a curve of its own: one long box, or two that cross, would
/// make a leaf of everything. What shares a cell in the end is sorted again by finer cells, so that
/// nothing remote leaves the others in disorder.
template <class BoxOf>
void sort_along_curve(std::span<curve_key> keys, const BoxOf& box_of, bool one_kind) {
    const box<double> middles = box_of_middles(std::span<const curve_key>(keys), box_of);
    if (middles.low == middles.high) return;
    std::array<unit_axis, 3> axes;
    for (std::size_t k = 0; k < 3; ++k) axes[k] = unit_axis(middles.low[k], middles.high[k]);

    // As a part of the spread of the middles; bounded, since it may be infinite.
    const auto length = [&](const auto& b, std::size_t k) {
        return std::min<double>(0.5 * (axes[k](b.high[k]) - axes[k](b.low[k])), cells);
    };
    std::array<double, 3> half_cells{};  // half the number of cells along each axis
    const std::size_t stride = sample_stride(keys.size());
    for (std::size_t i = 0; i < keys.size(); i += stride) {
        const auto b = box_of(element_of(keys[i]));
        for (std::size_t k = 0; k < 3; ++k) half_cells[k] += length(b, k);
    }
    std::array<double, 3> half_spread;  // halved, so that it does not overflow
    for (std::size_t k = 0; k < 3; ++k)
        half_spread[k] = 0.5 * middles.high[k] - 0.5 * middles.low[k];
    const double cube = *std::ranges::max_element(half_spread) / cells;
    for (std::size_t k = 0; k < 3; ++k) {
        const double mean =
            half_cells[k] * static_cast<double>(stride) / static_cast<double>(keys.size());
        half_cells[k] = half_spread[k] > 0 ? 1 / std::max(mean, cube / half_spread[k]) : 0;
    }
    const double most = *std::ranges::max_element(half_cells);
    for (double& half : half_cells) half *= 0.5 * (cells - 1) / most;

    const auto kind_of = [&](const auto& b) {
        double longest = 1.0 / 16;
        std::uint32_t kind = 0;
        for (std::uint32_t k = 0; k < 3; ++k)
            if (length(b, k) > longest) {
                longest = length(b, k);
                kind = k + 1;
            }
        return kind;
    };
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, keys.size(), 4096),
        [&](const tbb::blocked_range<std::size_t>& range) {
            for (std::size_t i = range.begin(); i < range.end(); ++i) {
                const index element = element_of(keys[i]);
                const auto b = box_of(element);
                std::uint32_t position = one_kind ? 0 : kind_of(b) << curve_bits;
                for (std::size_t k = 0; k < 3; ++k) {
                    const double cell = half_cells[k] + half_cells[k] * axes[k](middle(b, k));
                    position |=
                        spread_bits(static_cast<std::uint32_t>(std::clamp(cell, 0.0, cells - 1.0)))
                        << k;
                }
                keys[i] = curve_key(position) << 32 | element;
            }
        });
    sort_keys(keys);

    for_each_run(keys, curve_bits, [&](std::span<curve_key> kind) {
        if (position_of(kind.front()) >> curve_bits != 0) {
            sort_along_curve(kind, box_of, true);
            return;
        }
        for_each_run(kind, 0, [&](std::span<curve_key> cell) {
            if (cell.size() > leaf_size && cell.size() < keys.size())
                sort_along_curve(cell, box_of, one_kind);
        });
    });
}

}  // namespace

step_frames::step_frames(const mesh& before, const mesh& after)
    : before_(before.vertices), after_(after.vertices) {
    if (before_.empty()) return;
    box<double> all;
    all.low = all.high = coordinates(before_, 0);
    for (const std::vector<point<double>>* frame : {&before_, &after_})
        for (std::size_t v = 0; v < frame->size(); ++v)
            widen(all, coordinates(*frame, static_cast<index>(v)));
    for (std::size_t k = 0; k < 3; ++k) axes_[k] = unit_axis(all.low[k], all.high[k]);
}

template <std::size_t N>
bool step_frames::need_doubles(std::span<const std::array<index, N>> elements) const {
    std::size_t confused = 0, samples = 0;
    for (std::size_t i = 0; i < elements.size(); i += sample_stride(elements.size()), ++samples) {
        const box<double> exact = swept_box<double>(elements[i]);
        const box<float> rounded = swept_box<float>(elements[i]);
        bool merged = false;
        for (std::size_t k = 0; k < 3; ++k)
            merged |= exact.low[k] != exact.high[k] && rounded.low[k] == rounded.high[k];
        confused += merged;
    }
    return confused > samples / 16;
}

template <class Real, std::size_t N>
std::vector<std::array<index, N>> step_frames::along_curve(
    std::span<const std::array<index, N>> elements) const {
    std::vector<curve_key> keys(elements.size());
    for (std::size_t i = 0; i < keys.size(); ++i) keys[i] = i;
    if (!keys.empty())
        sort_along_curve(
            std::span(keys), [&](index i) { return swept_box<Real>(elements[i]); }, false);
    std::vector<std::array<index, N>> ordered(elements.size());
    for (std::size_t i = 0; i < keys.size(); ++i) ordered[i] = elements[element_of(keys[i])];
    return ordered;
}

template bool step_frames::need_doubles(std::span<const edge>) const;
template bool step_frames::need_doubles(std::span<const face>) const;
template std::vector<std::array<index, 1>> step_frames::along_curve<float>(
    std::span<const std::array<index, 1>>) const;
template std::vector<std::array<index, 1>> step_frames::along_curve<double>(
    std::span<const std::array<index, 1>>) const;
template std::vector<edge> step_frames::along_curve<float>(std::span<const edge>) const;
template std::vector<edge> step_frames::along_curve<double>(std::span<const edge>) const;
template std::vector<face> step_frames::along_curve<float>(std::span<const face>) const;
template std::vector<face> step_frames::along_curve<double>(std::span<const face>) const;

}  // namespace ccd
