// Pairs of elements of a mesh whose boxes touch, and the candidates among them. Internal.
//
// Boxes are sorted along a Morton curve, with 32 per node, so that nodes have no pointers. A warp
// searches a tree with a packet, the 32 elements of one node: each lane tests one child, and a
// ballot selects the children to visit. It queues the pairs whose rounded boxes touch; full warps
// then test which of these are candidates. A search that fills the queue is repeated in smaller
// parts.
#pragma once

#include <algorithm>
#include <array>
#include <ccd/cuda.hpp>
#include <ccd/mesh.hpp>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

#include "ccd/cuda/launch.hpp"
#include "ccd/cuda/queries.hpp"
#include "ccd/cuda/rounding.hpp"
#include "ccd/step/elements.hpp"

namespace ccd::cuda::detail {

/// A corner of a box, and the element in it.
struct alignas(16) box_corner {
    float at[3];
    std::uint32_t element;
};

/// A closed box of rounded coordinates (ccd/batch/rounded_axes.hpp).
/// Proof: proofs/filters/RoundedAxes.v, swept_rounded_first, swept_face_separate,
/// swept_edges_separate, swept_boxes_touch.
struct rounded_box {
    box_corner low, high;

    static constexpr rounded_box nowhere() {
        constexpr float infinity = std::numeric_limits<float>::infinity();
        return {{{infinity, infinity, infinity}, 0}, {{-infinity, -infinity, -infinity}, 0}};
    }
    constexpr void widen(const rounded_box& b) {
        for (std::size_t k = 0; k < 3; ++k) {
            low.at[k] = std::min(low.at[k], b.low.at[k]);
            high.at[k] = std::max(high.at[k], b.high.at[k]);
        }
    }
    /// Boxes that touch in exact arithmetic touch when rounded.
    constexpr bool touches(const rounded_box& b) const {
        bool touching = true;
        for (std::size_t k = 0; k < 3; ++k)
            touching &= (low.at[k] <= b.high.at[k]) & (high.at[k] >= b.low.at[k]);
        return touching;
    }
    /// If true, the boxes touch in exact arithmetic.
    constexpr bool overlaps(const rounded_box& b) const {
        bool overlapping = true;
        for (std::size_t k = 0; k < 3; ++k)
            overlapping &= (low.at[k] < b.high.at[k]) & (high.at[k] > b.low.at[k]);
        return overlapping;
    }
};

constexpr rounded_box load_box(const rounded_box* b) {
    return {load_aligned(&b->low), load_aligned(&b->high)};
}

/// Vertices, edges or faces: element i has N vertices. Without a list, element i is vertex i.
template <std::size_t N>
struct elements {
    const std::array<vertex_index, N>* list;
    std::size_t count;

    constexpr std::array<vertex_index, N> operator[](std::uint32_t i) const {
        if constexpr (N == 1)
            return {i};
        else
            return list[i];
    }
};

template <std::size_t N>
constexpr rounded_box swept_box(const rounded_position* rows, const elements<N>& all,
                                std::uint32_t element) {
    rounded_box b = rounded_box::nowhere();
    for (const vertex_index v : all[element])
        for (std::size_t end = 0; end < 2; ++end) {
            const rounded_position r = load_aligned(rows + 2 * std::size_t(v) + end);
            b.widen({{{r.x, r.y, r.z}, 0}, {{r.x, r.y, r.z}, 0}});
        }
    b.low.element = element;
    return b;
}

/// True if the exact, closed swept boxes of two elements touch.
template <std::size_t A, std::size_t B>
constexpr bool exactly_touch(const positions& at, const std::array<vertex_index, A>& a,
                             const std::array<vertex_index, B>& b) {
    for (std::size_t k = 0; k < 3; ++k) {
        const auto range = [&](const auto& vertices) {
            double low = coordinate_at(at, at.before, k, vertices[0]), high = low;
            for (const auto* frame : {&at.before, &at.after})
                for (const vertex_index v : vertices) {
                    const double x = coordinate_at(at, *frame, k, v);
                    low = std::min(low, x);
                    high = std::max(high, x);
                }
            return std::pair(low, high);
        };
        const auto x = range(a), y = range(b);
        if (x.first > y.second || y.first > x.second) return false;
    }
    return true;
}

/// Boxes of sorted elements, level by level: box i of a level is around boxes 32i to 32i + 31
/// below it. Without elements there is no level; otherwise there are at least two, since a packet
/// of the search is a box of level 1.
struct box_levels {
    static constexpr std::uint32_t children = warp::lanes, child_bits = 5, max_levels = 8;

    const rounded_box* boxes = nullptr;
    std::uint32_t levels = 0;
    std::size_t start[max_levels] = {}, count[max_levels] = {};
    std::size_t size = 0;  ///< boxes of all levels, each level in whole nodes

    constexpr box_levels() = default;
    explicit constexpr box_levels(std::size_t leaves) {
        for (std::size_t n = leaves; n > 0; n = levels == 1 || n > 1 ? nodes(n) : 0) {
            start[levels] = size;
            count[levels++] = n;
            size += children * nodes(n);
        }
    }
    static constexpr std::size_t nodes(std::size_t n) { return (n + children - 1) / children; }
    constexpr std::size_t leaves() const { return count[0]; }
    constexpr std::size_t packets() const { return count[1]; }

    constexpr rounded_box box(std::uint32_t level, std::size_t i) const {
        return load_box(boxes + start[level] + i);
    }
};

template <std::size_t N>
struct curve_key {
    elements<N> all;
    const rounded_position* rows;
    std::uint32_t *keys, *order;

    constexpr void operator()(std::uint32_t i) const {
        const rounded_box b = swept_box(rows, all, i);
        std::uint32_t key = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            // Coordinates are within about [−1, 1]; NaN counts as 0.
            const float place = (0.5f * b.low.at[k] + 0.5f * b.high.at[k] + 1.0f) * 512.0f;
            const auto cell = place >= 1023.0f ? 1023U
                              : place > 0.0f   ? static_cast<std::uint32_t>(place)
                                               : 0U;
            key |= ccd::detail::spread_bits(cell) << k;
        }
        keys[i] = key;
        order[i] = i;
    }
};

template <std::size_t N>
struct make_leaf {
    elements<N> all;
    const rounded_position* rows;
    const std::uint32_t* order;
    rounded_box* boxes;

    constexpr void operator()(std::uint32_t i) const {
        boxes[i] = i < all.count ? swept_box(rows, all, order[i]) : rounded_box::nowhere();
    }
};
struct make_node {
    const rounded_box* below;
    std::size_t count;
    rounded_box* level;

    constexpr void operator()(std::uint32_t i) const {
        const std::size_t first = box_levels::children * std::size_t(i);
        rounded_box b = rounded_box::nowhere();
        for (std::size_t k = 0; k < box_levels::children && first + k < count; ++k)
            b.widen(below[first + k]);
        level[i] = b;
    }
};

struct alignas(8) leaf_pair {
    std::uint32_t first, second;
};
struct search_counters {
    std::uint64_t touching;  ///< pairs of leaves, also those beyond the queue's capacity
    std::uint32_t candidates;
};

/// The packets of one tree, and the leaves of the same or another tree, that a launch compares.
struct search_part {
    std::size_t packet, packets, leaf, leaves;

    constexpr void halve() {
        std::size_t& n = packets > 1 ? packets : leaves;
        n = (n + 1) / 2;
    }
    /// Continues after this part. If `may_grow`, the next one may have twice as many packets.
    constexpr void advance(std::size_t all_leaves, bool may_grow) {
        leaf += leaves;
        if (leaf < all_leaves) return;
        packet += packets;
        leaf = 0;
        leaves = all_leaves;
        if (may_grow) packets *= 2;
    }
};

/// Queues the pairs of a packet's leaf and a leaf of `tree` whose boxes touch. If the trees are the
/// same, the second leaf is later than the first. If the queue overflows, pairs are missing.
struct packet_search {
    box_levels searching, tree;
    bool one_tree;
    leaf_pair* touching = nullptr;
    std::size_t capacity = 0;
    search_counters* counters = nullptr;
    search_part part{};

    constexpr void operator()(std::uint32_t i) const {
        const auto packet = static_cast<std::uint32_t>(part.packet + i);
        const std::uint32_t first_own = packet * warp::lanes;
        const std::size_t begin = std::max<std::size_t>(part.leaf, one_tree ? first_own : 0),
                          end = std::min(part.leaf + part.leaves, tree.leaves());
        if (begin >= end) return;
        const rounded_box around = searching.box(1, packet);

        std::uint32_t waiting[box_levels::max_levels] = {};  // children to visit
        const std::uint32_t top = tree.levels - 2;
        std::uint32_t level = top, node = 0;
        for (;;) {
            const std::uint32_t shift = box_levels::child_bits * level,
                                first = static_cast<std::uint32_t>(begin >> shift),
                                last = static_cast<std::uint32_t>((end - 1) >> shift);
            std::uint32_t mask = warp::ballot([&](std::uint32_t lane) -> bool {
                const std::uint32_t child = node * box_levels::children + lane;
                return (child - first <= last - first) & tree.box(level, child).touches(around);
            });
            if (level == 0) {
                if (mask != 0 && !queue_pairs(packet, node, mask)) return;
                mask = 0;
            }
            while (mask == 0) {
                if (++level > top) return;
                node /= box_levels::children;
                mask = waiting[level];
            }
            waiting[level] = mask & (mask - 1);
            node = node * box_levels::children + warp::lowest(mask);
            --level;
        }
    }

  private:
    /// Queues the pairs of own leaves and a node's leaves in `mask`. False if the queue is full.
    constexpr bool queue_pairs(std::uint32_t packet, std::uint32_t node, std::uint32_t mask) const {
        const std::uint32_t first_own = packet * warp::lanes, first_leaf = node * warp::lanes;
        const rounded_box *const own = searching.boxes + first_own, *const leaves =
                                                                        tree.boxes + first_leaf;
        const rounded_box around = tree.box(1, node);
        const std::uint32_t own_mask =
            warp::ballot([&](std::uint32_t lane) { return load_box(own + lane).touches(around); });
        // Each lane has a leaf of the side with more leaves, and compares it with all leaves of the
        // other side.
        const bool swapped = warp::count(own_mask) < warp::count(mask);
        const std::uint32_t lanes_mask = swapped ? mask : own_mask;
        warp::per_lane<rounded_box> box;
        warp::per_lane<std::uint32_t> found;  // bits of the other side's leaves
        warp::each(
            [&](std::uint32_t lane) { box[lane] = load_box((swapped ? leaves : own) + lane); });
        for (std::uint32_t rest = swapped ? own_mask : mask; rest != 0; rest &= rest - 1) {
            const rounded_box b = load_box((swapped ? own : leaves) + warp::lowest(rest));
            const std::uint32_t bit = rest & (~rest + 1);
            warp::each([&](std::uint32_t lane) { found[lane] |= box[lane].touches(b) ? bit : 0; });
        }
        const bool only_later = one_tree && node == packet;  // then not swapped
        warp::each([&](std::uint32_t lane) {
            if ((lanes_mask >> lane & 1) == 0) found[lane] = 0;
            if (only_later) found[lane] &= ~std::uint32_t(1) << lane;
        });
        if (warp::ballot([&](std::uint32_t lane) { return found[lane] != 0; }) == 0) return true;
        warp::per_lane<std::uint64_t> places;
        if (warp::append(&counters->touching, found, places) > capacity) return false;
        warp::each([&](std::uint32_t lane) {
            leaf_pair* to = touching + places[lane];
            for (std::uint32_t rest = found[lane]; rest != 0; rest &= rest - 1) {
                const std::uint32_t other = warp::lowest(rest);
                *to++ = {first_own + (swapped ? other : lane),
                         first_leaf + (swapped ? lane : other)};
            }
        });
        return true;
    }
};

/// Turns a pair into a candidate if it shares no vertex and its exact swept boxes touch.
template <std::size_t A, std::size_t B, class Pair>
struct candidate_filter {
    positions at;
    packet_search search;
    elements<A> searching;
    elements<B> others;
    queue_of<Pair> candidates{};

    constexpr void operator()(std::uint32_t i) const {
        const leaf_pair pair = search.touching[i];
        const rounded_box box = search.searching.box(0, pair.first),
                          other_box = search.tree.box(0, pair.second);
        const auto a = searching[box.low.element];
        const auto b = others[other_box.low.element];
        if (!ccd::detail::share_vertex(b, a) &&
            (box.overlaps(other_box) || exactly_touch(at, b, a)))
            candidates.push(ccd::detail::candidate_of(b, a));
    }
};

}  // namespace ccd::cuda::detail
