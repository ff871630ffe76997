// The order of elements along a space-filling curve (Morton, "A computer oriented geodetic data
// base and a new technique in file sequencing", 1966).
#include "ccd/step/curve_order.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>

#include "ccd/batch/first_touch.hpp"
#include "ccd/step/buckets.hpp"
#include "ccd/step/elements.hpp"

namespace ccd::detail {
namespace {

/// Maps an interval of finite numbers to about [-1, 1], preserving order though not strictly.
class unit_axis {
  public:
    unit_axis() = default;
    unit_axis(double low, double high) {
        // Halved before adding, and the inverse bounded: neither may overflow. A flat axis keeps
        // its unit (its radius is −0 where rounding is downward).
        middle_ = low / 2 + high / 2;
        const double radius = std::max(high - middle_, middle_ - low);
        if (radius > 0) scale_ = std::min(1 / radius, std::numeric_limits<double>::max());
    }
    double operator()(double x) const { return (x - middle_) * scale_; }

  private:
    double middle_ = 0, scale_ = 1;
};

/// A position on the curve, above it the class of a box, below it the element.
using curve_key = std::uint64_t;

/// Which bits of a key are what.
struct key_layout {
    unsigned element_bits, axis_bits;

    /// Along each axis four cells for every one that a surface of so many elements needs, so that
    /// cells are seldom shared; 1,024 at least.
    explicit key_layout(std::size_t elements)
        : element_bits(static_cast<unsigned>(std::bit_width(elements - 1))),
          axis_bits(std::clamp(element_bits / 2 + 2, 10U, (62 - element_bits) / 3)) {}

    vertex_index element_of(curve_key key) const {
        return static_cast<vertex_index>(key & ((curve_key(1) << element_bits) - 1));
    }
    /// With the class, which has two bits.
    std::uint64_t position_of(curve_key key) const { return key >> element_bits; }
    unsigned curve_bits() const { return 3 * axis_bits; }
    /// Cells of the curve along an axis.
    double cells() const { return static_cast<double>(1U << axis_bits); }
};

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
box<double> box_of_middles(std::span<const curve_key> keys, const key_layout& layout,
                           const BoxOf& box_of) {
    const auto middle_of = [&](curve_key key) {
        const auto b = box_of(layout.element_of(key));
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

/// By radix, each share of the keys by one thread: no sort by comparisons was as fast.
void sort_keys(std::span<curve_key> keys, const key_layout& layout) {
    constexpr std::size_t few = 4096;
    constexpr unsigned most_digit_bits = 11;  // whose counts stay in the first cache
    if (keys.size() < few) {
        std::ranges::sort(keys);
        return;
    }
    const unsigned bits = layout.curve_bits() + 2;
    const unsigned passes = (bits + most_digit_bits - 1) / most_digit_bits;
    const unsigned digit_bits = (bits + passes - 1) / passes;
    const std::size_t digits = std::size_t(1) << digit_bits;
    const std::size_t shares = shares_of(keys.size());
    share_places places(shares, digits);
    first_touch_vector<curve_key> buffer(keys.size());
    std::span<curve_key> from = keys, to = buffer;
    for (unsigned shift = layout.element_bits, pass = 0; pass < passes;
         shift += digit_bits, ++pass) {
        const auto for_each_key = [&](std::size_t share, const auto& visit) {
            std::size_t* const of_share = places.of(share);
            const std::size_t end = begin_of_share(share + 1, shares, from.size());
            for (std::size_t i = begin_of_share(share, shares, from.size()); i < end; ++i)
                visit(from[i], of_share[(from[i] >> shift) & (digits - 1)]);
        };
        places.clear();
        for_each_task(shares, [&](std::size_t share) {
            for_each_key(share, [](curve_key, std::size_t& place) { ++place; });
        });
        places.from_counts();
        for_each_task(shares, [&](std::size_t share) {
            for_each_key(share, [&](curve_key key, std::size_t& place) { to[place++] = key; });
        });
        std::swap(from, to);
    }
    if (passes % 2 == 1) std::ranges::copy(from, keys.begin());
}

/// Calls visit(run) for all runs of keys whose positions have the same upper bits.
template <class Visit>
void for_each_run(std::span<curve_key> keys, const key_layout& layout, unsigned lower_bits,
                  const Visit& visit) {
    const auto upper = [&](curve_key key) { return layout.position_of(key) >> lower_bits; };
    for (std::size_t begin = 0, end = 0; begin < keys.size(); begin = end) {
        while (end < keys.size() && upper(keys[end]) == upper(keys[begin])) ++end;
        visit(keys.subspan(begin, end - begin));
    }
}

/// The cells of a Morton curve through the middles of boxes.
///
/// They are as many times longer on one axis than on another as the boxes are: an axis on which
/// boxes are long tells few of them apart. Boxes of no length get cubes.
template <class BoxOf>
class curve_grid {
  public:
    /// `keys` must not be empty.
    curve_grid(std::span<const curve_key> keys, const key_layout& layout, const BoxOf& box_of)
        : box_of_(box_of), layout_(layout), middles_(box_of_middles(keys, layout, box_of)) {
        for (std::size_t k = 0; k < 3; ++k) axes_[k] = unit_axis(middles_.low[k], middles_.high[k]);
        const std::array<double, 3> mean = mean_lengths(keys);
        std::array<double, 3> half_spread;  // halved, so that it does not overflow
        for (std::size_t k = 0; k < 3; ++k)
            half_spread[k] = 0.5 * middles_.high[k] - 0.5 * middles_.low[k];
        const double widest = *std::ranges::max_element(half_spread);
        if (widest == 0)
            return;  // all middles in one cell: they differ by an underflow unit at most
        // Ratios of spreads first: a cube's length may underflow.
        for (std::size_t k = 0; k < 3; ++k)
            if (half_spread[k] > 0)
                half_cells_[k] = 1 / std::max(mean[k], widest / half_spread[k] / layout.cells());
        const double largest = *std::ranges::max_element(half_cells_);
        for (double& half : half_cells_) half *= 0.5 * (layout.cells() - 1) / largest;
    }

    /// Whether all middles are one point, which has no cells.
    bool is_one_point() const { return middles_.low == middles_.high; }

    /// The key with its element's position: the cell's, after its class's if they are told apart.
    curve_key place(curve_key key, bool one_class) const {
        const vertex_index element = layout_.element_of(key);
        const auto b = box_of_(element);
        std::uint64_t position = one_class ? 0 : class_of(b) << layout_.curve_bits();
        for (std::size_t k = 0; k < 3; ++k) {
            const double cell = half_cells_[k] + half_cells_[k] * axes_[k](middle(b, k));
            position |=
                spread_bits(static_cast<std::uint64_t>(std::clamp(cell, 0.0, layout_.cells() - 1)))
                << k;
        }
        return position << layout_.element_bits | element;
    }

  private:
    /// As a part of the spread of the middles; bounded, since it may be infinite.
    template <class Box>
    double length(const Box& b, std::size_t k) const {
        return std::min<double>(0.5 * (axes_[k](b.high[k]) - axes_[k](b.low[k])), layout_.cells());
    }

    std::array<double, 3> mean_lengths(std::span<const curve_key> keys) const {
        std::array<double, 3> mean{};
        const std::size_t stride = sampling_stride(keys.size());
        for (std::size_t i = 0; i < keys.size(); i += stride) {
            const auto b = box_of_(layout_.element_of(keys[i]));
            for (std::size_t k = 0; k < 3; ++k) mean[k] += length(b, k);
        }
        for (double& m : mean)
            m = m * static_cast<double>(stride) / static_cast<double>(keys.size());
        return mean;
    }

    /// 0, or 1 + the axis on which a box is long beside the whole, and longest.
    template <class Box>
    std::uint64_t class_of(const Box& b) const {
        double longest = 1.0 / 16;
        std::uint64_t found = 0;
        for (std::uint32_t k = 0; k < 3; ++k)
            if (length(b, k) > longest) {
                longest = length(b, k);
                found = k + 1;
            }
        return found;
    }

    const BoxOf& box_of_;
    const key_layout& layout_;
    box<double> middles_;
    std::array<unit_axis, 3> axes_;
    std::array<double, 3> half_cells_{};  // half the number of cells along each axis
};

/// Sorts the keys by their elements' boxes: along a Morton curve through the middles, which gathers
/// in each leaf boxes that are near each other.
///
/// Boxes that are long beside the whole (unless all are of `one_class`) come after all others, by
/// the axis on which they are longest, each class along a curve of its own: one long box, or two
/// that cross, would make a leaf of everything. What shares a cell in the end is sorted again by
/// finer cells, so that nothing remote leaves the others in disorder.
template <class BoxOf>
void sort_along_curve(std::span<curve_key> keys, const key_layout& layout, const BoxOf& box_of,
                      bool one_class) {
    const curve_grid<BoxOf> grid(keys, layout, box_of);
    if (grid.is_one_point()) return;
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, keys.size(), 4096),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                          for (std::size_t i = range.begin(); i < range.end(); ++i)
                              keys[i] = grid.place(keys[i], one_class);
                      });
    sort_keys(keys, layout);

    for_each_run(keys, layout, layout.curve_bits(), [&](std::span<curve_key> members) {
        if (layout.position_of(members.front()) >> layout.curve_bits() != 0) {
            sort_along_curve(members, layout, box_of, true);
            return;
        }
        for_each_run(members, layout, 0, [&](std::span<curve_key> cell) {
            if (cell.size() > leaf_size && cell.size() < keys.size())
                sort_along_curve(cell, layout, box_of, one_class);
        });
    });
}

}  // namespace

template <class Real, std::size_t N>
void order_along_curve(std::vector<std::array<vertex_index, N>>& elements,
                       const swept_boxes& boxes) {
    if (elements.empty()) return;
    first_touch_vector<curve_key> keys(elements.size());
    const auto for_all = [&](const auto& act) {
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, keys.size(), 4096),
                          [&](const tbb::blocked_range<std::size_t>& range) {
                              for (std::size_t i = range.begin(); i < range.end(); ++i) act(i);
                          });
    };
    for_all([&](std::size_t i) { keys[i] = i; });
    const key_layout layout(elements.size());
    sort_along_curve(
        std::span(keys), layout, [&](vertex_index i) { return boxes.swept_box<Real>(elements[i]); },
        false);
    first_touch_vector<std::array<vertex_index, N>> ordered(elements.size());
    for_all([&](std::size_t i) { ordered[i] = elements[layout.element_of(keys[i])]; });
    for_all([&](std::size_t i) { elements[i] = ordered[i]; });
}

template void order_along_curve<float>(std::vector<std::array<vertex_index, 1>>&,
                                       const swept_boxes&);
template void order_along_curve<double>(std::vector<std::array<vertex_index, 1>>&,
                                        const swept_boxes&);
template void order_along_curve<float>(std::vector<edge>&, const swept_boxes&);
template void order_along_curve<double>(std::vector<edge>&, const swept_boxes&);
template void order_along_curve<float>(std::vector<face>&, const swept_boxes&);
template void order_along_curve<double>(std::vector<face>&, const swept_boxes&);

}  // namespace ccd::detail
