#include "ccd/step/vertex_order.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>
#include <utility>

#include "ccd/batch/threads.hpp"
#include "ccd/step/elements.hpp"
#include "ccd/step/order/buckets.hpp"
#include "ccd/step/order/hilbert_curve.hpp"

namespace ccd::detail {
namespace {

/// A key: the class of a box in the highest bits, then its place in an order, then the item.
using order_key = std::uint64_t;

struct key_layout {
    static constexpr unsigned class_bits = 2;
    unsigned item_bits, place_bits;

    /// Precondition: items > 0. Places get fewer than `bits` bits if there is no room.
    key_layout(std::size_t items, unsigned bits)
        : item_bits(static_cast<unsigned>(std::bit_width(items - 1))),
          place_bits(std::min(bits, 64 - class_bits - item_bits)) {}

    std::size_t item_of(order_key key) const {
        return static_cast<std::size_t>(key & ((order_key(1) << item_bits) - 1));
    }
    /// The place including the class.
    std::uint64_t place_of(order_key key) const { return key >> item_bits; }
    std::uint64_t class_of(order_key key) const { return place_of(key) >> place_bits; }
    order_key key(std::uint64_t its_class, std::uint64_t place, std::size_t item) const {
        return (its_class << place_bits | place) << item_bits | item;
    }
};

struct curve_layout : key_layout {
    unsigned axis_bits;

    /// Uses four times the cells along each axis that a surface of this many items needs, at least
    /// 1,024, so that few items share a cell.
    explicit curve_layout(std::size_t items)
        : key_layout(items, 64), axis_bits(std::clamp(item_bits / 2 + 2, 10U, place_bits / 3)) {
        place_bits = 3 * axis_bits;
    }
    double cells() const { return static_cast<double>(1U << axis_bits); }
};

constexpr std::size_t leaf_size = box_pack<float>::size;

template <class Act>
void for_all(std::size_t count, const Act& act) {
    for_each_range(count, 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) act(i);
    });
}

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
box<double> box_of_middles(std::span<const order_key> keys, const key_layout& layout,
                           const BoxOf& box_of) {
    const auto middle_of = [&](order_key key) {
        const auto b = box_of(layout.item_of(key));
        const std::array<double, 3> m{middle(b, 0), middle(b, 1), middle(b, 2)};
        return box<double>{m, m};
    };
    constexpr std::size_t block = 4096;
    std::vector<box<double>> boxes((keys.size() + block - 1) / block, middle_of(keys.front()));
    for_each_task(boxes.size(), [&](std::size_t i) {
        for (std::size_t k = block * i; k < std::min(keys.size(), block * (i + 1)); ++k)
            widen(boxes[i], middle_of(keys[k]));
    });
    for (const box<double>& b : boxes) widen(boxes[0], b);
    return boxes[0];
}

std::array<unit_axis, 3> axes_of(const box<double>& b) {
    return {unit_axis(b.low[0], b.high[0]), unit_axis(b.low[1], b.high[1]),
            unit_axis(b.low[2], b.high[2])};
}

/// A box's length on axis k, relative to the axis' length. May be infinite.
template <class Box>
double length(const std::array<unit_axis, 3>& axes, const Box& b, std::size_t k) {
    return 0.5 * (axes[k](b.high[k]) - axes[k](b.low[k]));
}

/// 1 + the axis on which a box is longest, if it is long compared with the whole; else 0.
template <class Box>
std::uint64_t class_of(const std::array<unit_axis, 3>& axes, const Box& b) {
    double longest = 1.0 / 16;
    std::uint64_t found = 0;
    for (std::uint32_t k = 0; k < 3; ++k)
        if (length(axes, b, k) > longest) {
            longest = length(axes, b, k);
            found = k + 1;
        }
    return found;
}

template <class BoxAt>
std::vector<box<double>> sample_of(std::size_t count, const BoxAt& box_at) {
    std::vector<box<double>> sample;
    for (std::size_t i = 0; i < count; i += sampling_stride(count)) {
        const auto b = box_at(i);
        sample.push_back({{b.low[0], b.low[1], b.low[2]}, {b.high[0], b.high[1], b.high[2]}});
    }
    return sample;
}

/// Radix sort, faster than sorts by comparison.
void sort_keys(std::span<order_key> keys, const key_layout& layout) {
    constexpr std::size_t few = 4096;
    constexpr unsigned most_digit_bits = 11;  // counts stay in the first-level cache
    if (keys.size() < few) {
        std::ranges::sort(keys);
        return;
    }
    const unsigned bits = layout.place_bits + key_layout::class_bits;
    const unsigned passes = (bits + most_digit_bits - 1) / most_digit_bits;
    const unsigned digit_bits = (bits + passes - 1) / passes;
    const std::size_t digits = std::size_t(1) << digit_bits;
    const std::size_t shares = shares_of(keys.size());
    share_places places(shares, digits);
    first_touch_vector<order_key> buffer(keys.size());
    std::span<order_key> from = keys, to = buffer;
    for (unsigned shift = layout.item_bits, pass = 0; pass < passes; shift += digit_bits, ++pass) {
        const auto for_each_key = [&](std::size_t share, const auto& visit) {
            std::size_t* const of_share = places.of(share);
            const std::size_t end = begin_of_share(share + 1, shares, from.size());
            for (std::size_t i = begin_of_share(share, shares, from.size()); i < end; ++i)
                visit(from[i], of_share[(from[i] >> shift) & (digits - 1)]);
        };
        places.clear();
        for_each_task(shares, [&](std::size_t share) {
            for_each_key(share, [](order_key, std::size_t& place) { ++place; });
        });
        places.from_counts();
        for_each_task(shares, [&](std::size_t share) {
            for_each_key(share, [&](order_key key, std::size_t& place) { to[place++] = key; });
        });
        std::swap(from, to);
    }
    if (passes % 2 == 1) std::ranges::copy(from, keys.begin());
}

/// Sorted keys by class: boxes that are long on no axis, and those long on each axis.
struct key_classes {
    std::span<order_key> short_ones;
    std::array<std::span<order_key>, 3> long_ones;

    key_classes(std::span<order_key> keys, const key_layout& layout) {
        short_ones = taken(keys, layout, 0);
        for (std::size_t k = 0; k < 3; ++k) long_ones[k] = taken(keys, layout, k + 1);
    }

  private:
    static std::span<order_key> taken(std::span<order_key>& keys, const key_layout& layout,
                                      std::uint64_t its_class) {
        const auto end = std::ranges::partition_point(
            keys, [&](order_key key) { return layout.class_of(key) == its_class; });
        const auto count = static_cast<std::size_t>(end - keys.begin());
        const std::span<order_key> members = keys.first(count);
        keys = keys.subspan(count);
        return members;
    }
};

/// Visits all runs of keys in the same place.
template <class Visit>
void for_each_run(std::span<order_key> keys, const key_layout& layout, const Visit& visit) {
    for (std::size_t begin = 0, end = 0; begin < keys.size(); begin = end) {
        const std::uint64_t place = layout.place_of(keys[begin]);
        while (end < keys.size() && layout.place_of(keys[end]) == place) ++end;
        visit(keys.subspan(begin, end - begin));
    }
}

/// The cells of a curve through the middles of boxes. They have the proportions of the sample's
/// boxes with middles in this range, because an axis on which boxes are long distinguishes few of
/// them. Boxes without length get cubes.
template <class BoxOf>
class curve_grid {
  public:
    curve_grid(std::span<const order_key> keys, const curve_layout& layout, const BoxOf& box_of,
               std::span<const box<double>> sample)
        : box_of_(box_of),
          layout_(layout),
          middles_(box_of_middles(keys, layout, box_of)),
          axes_(axes_of(middles_)) {
        const std::array<double, 3> mean = mean_lengths(sample);
        std::array<double, 3> half_spread;  // halved, so that it does not overflow
        for (std::size_t k = 0; k < 3; ++k)
            half_spread[k] = 0.5 * middles_.high[k] - 0.5 * middles_.low[k];
        const double widest = *std::ranges::max_element(half_spread);
        if (widest == 0)
            return;  // all middles are in one cell: they differ by at most an underflow unit
        // Ratios of spreads first: a cube's length may underflow.
        for (std::size_t k = 0; k < 3; ++k)
            if (half_spread[k] > 0)
                half_cells_[k] = 1 / std::max(mean[k], widest / half_spread[k] / layout.cells());
        const double largest = *std::ranges::max_element(half_cells_);
        for (double& half : half_cells_) half *= 0.5 * (layout.cells() - 1) / largest;
    }

    /// True if all middles are one point, which has no cells.
    bool is_one_point() const { return middles_.low == middles_.high; }
    const std::array<unit_axis, 3>& axes() const { return axes_; }

    /// Returns the key with its item's cell as place, below its class unless `one_class`.
    order_key place(order_key key, bool one_class) const {
        const std::size_t item = layout_.item_of(key);
        const auto b = box_of_(item);
        std::uint64_t cell = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const double at = half_cells_[k] + half_cells_[k] * axes_[k](middle(b, k));
            cell |=
                spread_bits(static_cast<std::uint64_t>(std::clamp(at, 0.0, layout_.cells() - 1)))
                << k;
        }
        return layout_.key(one_class ? 0 : class_of(axes_, b),
                           hilbert_position(cell, layout_.axis_bits), item);
    }

  private:
    std::array<double, 3> mean_lengths(std::span<const box<double>> sample) const {
        std::array<double, 3> sum{};
        std::size_t count = 0;
        for (const box<double>& b : sample) {
            bool is_among = true;
            for (std::size_t k = 0; k < 3; ++k)
                is_among &= middles_.low[k] <= middle(b, k) && middle(b, k) <= middles_.high[k];
            if (!is_among) continue;
            ++count;
            for (std::size_t k = 0; k < 3; ++k)  // bounded, since lengths may be infinite
                sum[k] += std::min(length(axes_, b, k), layout_.cells());
        }
        for (double& s : sum) s /= static_cast<double>(std::max<std::size_t>(count, 1));
        return sum;
    }

    const BoxOf& box_of_;
    const curve_layout& layout_;
    box<double> middles_;
    std::array<unit_axis, 3> axes_;
    std::array<double, 3> half_cells_{};  // half the number of cells along each axis
};

/// Sorts the keys along a Hilbert curve through the middles of their items' boxes, so that each
/// leaf gathers neighbours. Returns the axes of the middles. Unless `one_class`, boxes that are
/// long compared with the whole come last: one class for each axis on which they are longest, each
/// along a separate curve. Otherwise one long box would make a leaf of everything. Items that share
/// a cell are sorted again by finer cells.
template <class BoxOf>
std::array<unit_axis, 3> sort_along_curve(std::span<order_key> keys, const curve_layout& layout,
                                          const BoxOf& box_of, std::span<const box<double>> sample,
                                          bool one_class) {
    const curve_grid<BoxOf> grid(keys, layout, box_of, sample);
    if (grid.is_one_point()) return grid.axes();
    for_all(keys.size(), [&](std::size_t i) { keys[i] = grid.place(keys[i], one_class); });
    sort_keys(keys, layout);
    const key_classes classes(keys, layout);
    for_each_run(classes.short_ones, layout, [&](std::span<order_key> cell) {
        if (cell.size() > leaf_size && cell.size() < keys.size())
            sort_along_curve(cell, layout, box_of, sample, one_class);
    });
    for (const std::span<order_key> members : classes.long_ones)
        if (!members.empty()) sort_along_curve(members, layout, box_of, sample, true);
    return grid.axes();
}

}  // namespace

unit_axis::unit_axis(double low, double high) {
    // Halved before the addition, and with a bounded inverse, so that neither overflows. A flat
    // axis keeps its unit (its radius is −0 if rounding is downward).
    middle_ = low / 2 + high / 2;
    const double radius = std::max(high - middle_, middle_ - low);
    if (radius > 0) scale_ = std::min(1 / radius, std::numeric_limits<double>::max());
}

template <class Real, std::size_t N>
void vertex_order::find(const swept_boxes& boxes, std::size_t vertices,
                        std::span<const std::array<vertex_index, N>> elements) {
    constexpr known wanted = std::is_same_v<Real, float> ? known::by_floats : known::by_doubles;
    if (known_ == wanted) return;
    const auto box_of = [&](std::size_t v) {
        return boxes.swept_box<Real>(std::array{static_cast<vertex_index>(v)});
    };
    const std::vector<box<double>> sample = sample_of(
        elements.size(), [&](std::size_t i) { return boxes.swept_box<Real>(elements[i]); });
    first_touch_vector<order_key> keys(vertices);
    for_all(vertices, [&](std::size_t v) { keys[v] = v; });
    const curve_layout layout(vertices);
    axes_ = sort_along_curve(std::span(keys), layout, box_of, sample, false);
    place_.resize(vertices);
    for_all(vertices,
            [&](std::size_t i) { place_[layout.item_of(keys[i])] = static_cast<vertex_index>(i); });
    known_ = wanted;
}

template <class Real, std::size_t N>
void vertex_order::sort(std::vector<std::array<vertex_index, N>>& elements,
                        const swept_boxes& boxes) const {
    if (elements.empty()) return;
    const auto box_of = [&](std::size_t i) { return boxes.swept_box<Real>(elements[i]); };
    const auto bits = static_cast<unsigned>(std::bit_width(place_.size() - 1));
    const key_layout layout(elements.size(), bits);
    first_touch_vector<order_key> keys(elements.size());
    for_all(keys.size(), [&](std::size_t i) {
        vertex_index first = place_[elements[i][0]];
        for (const vertex_index v : elements[i]) first = std::min(first, place_[v]);
        keys[i] = layout.key(class_of(axes_, box_of(i)), first >> (bits - layout.place_bits), i);
    });
    sort_keys(keys, layout);
    for (const std::span<order_key> members : key_classes(keys, layout).long_ones) {
        if (members.empty()) continue;
        const std::vector<box<double>> sample = sample_of(
            members.size(), [&](std::size_t i) { return box_of(layout.item_of(members[i])); });
        sort_along_curve(members, curve_layout(elements.size()), box_of, sample, true);
    }
    first_touch_vector<std::array<vertex_index, N>> ordered(elements.size());
    for_all(keys.size(), [&](std::size_t i) { ordered[i] = elements[layout.item_of(keys[i])]; });
    for_all(keys.size(), [&](std::size_t i) { elements[i] = ordered[i]; });
}

template void vertex_order::find<float>(const swept_boxes&, std::size_t,
                                        std::span<const std::array<vertex_index, 1>>);
template void vertex_order::sort<float>(std::vector<std::array<vertex_index, 1>>&,
                                        const swept_boxes&) const;
template void vertex_order::find<float>(const swept_boxes&, std::size_t,
                                        std::span<const std::array<vertex_index, 2>>);
template void vertex_order::sort<float>(std::vector<std::array<vertex_index, 2>>&,
                                        const swept_boxes&) const;
template void vertex_order::find<float>(const swept_boxes&, std::size_t,
                                        std::span<const std::array<vertex_index, 3>>);
template void vertex_order::sort<float>(std::vector<std::array<vertex_index, 3>>&,
                                        const swept_boxes&) const;
template void vertex_order::find<double>(const swept_boxes&, std::size_t,
                                         std::span<const std::array<vertex_index, 1>>);
template void vertex_order::sort<double>(std::vector<std::array<vertex_index, 1>>&,
                                         const swept_boxes&) const;
template void vertex_order::find<double>(const swept_boxes&, std::size_t,
                                         std::span<const std::array<vertex_index, 2>>);
template void vertex_order::sort<double>(std::vector<std::array<vertex_index, 2>>&,
                                         const swept_boxes&) const;
template void vertex_order::find<double>(const swept_boxes&, std::size_t,
                                         std::span<const std::array<vertex_index, 3>>);
template void vertex_order::sort<double>(std::vector<std::array<vertex_index, 3>>&,
                                         const swept_boxes&) const;

}  // namespace ccd::detail
