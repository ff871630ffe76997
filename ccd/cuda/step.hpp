// A step of a mesh on the device: candidates by trees of boxes, decided in blocks. Internal.
//
// Boxes are sorted along a Morton curve, with 32 per node, so that nodes have no pointers. A warp
// searches a tree with the packet of 32 elements of one node, and queues the pairs of elements
// whose rounded boxes touch. A second stage makes candidates of these pairs. A search that fills
// the queue is repeated in smaller parts. Pairs that collide are sorted, so results do not depend
// on the order of threads.
#pragma once

#include <algorithm>
#include <array>
#include <ccd/cuda.hpp>
#include <ccd/mesh.hpp>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>

#include "ccd/cuda/exact_stages.hpp"
#include "ccd/cuda/launch.hpp"
#include "ccd/cuda/pairs.hpp"
#include "ccd/cuda/queries.hpp"
#include "ccd/step/elements.hpp"

namespace ccd::cuda::detail {

/// Sixteen bytes: a corner of a box, and the element in it.
struct alignas(16) box_corner {
    float at[3];
    std::uint32_t element;
};

/// A closed box of rounded coordinates (ccd/batch/rounded_axes.hpp).
/// Proof: proofs/RoundedAxes.v, swept_rounded_first, swept_face_separate, swept_edges_separate,
/// swept_boxes_touch.
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

/// True if the closed exact swept boxes of two elements touch.
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

/// Boxes of sorted elements, level by level: box i of a level is around boxes 32i to 32i + 31 of
/// the level below it. There are at least two levels, unless there is no element.
struct box_levels {
    static constexpr std::uint32_t children = warp::lanes, child_bits = 5, max_levels = 8;

    const rounded_box* boxes = nullptr;
    std::uint32_t levels = 0;
    std::size_t start[max_levels] = {}, count[max_levels] = {};
    std::size_t size = 0;  ///< of all levels, each in whole nodes

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
        const rounded_box* const b = boxes + start[level] + i;
        return {load_aligned(&b->low), load_aligned(&b->high)};
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

struct leaf_pair {
    std::uint32_t first, second;
};
struct search_counters {
    std::uint64_t touching;  ///< pairs of leaves, also those beyond the queue's capacity
    std::uint32_t candidates;
};

/// The packets of a tree and the leaves of another one that a launch compares.
struct search_part {
    std::size_t packet, packets, leaf, leaves;

    constexpr void halve() {
        std::size_t& n = packets > 1 ? packets : leaves;
        n = (n + 1) / 2;
    }
    /// Continues after this part. If `may_grow`, the next part may have twice as many packets.
    constexpr void advance(std::size_t all_leaves, bool may_grow) {
        leaf += leaves;
        if (leaf < all_leaves) return;
        packet += packets;
        leaf = 0;
        leaves = all_leaves;
        if (may_grow) packets *= 2;
    }
};

/// Queues the pairs of a leaf of a packet and a leaf of `tree` whose boxes touch. If the trees are
/// one, the second leaf is later than the first. Once the queue is full, it is incomplete.
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
        warp::per_lane<rounded_box> own;
        warp::each([&](std::uint32_t lane) { own[lane] = searching.box(0, first_own + lane); });
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
                if (mask != 0 && !queue_pairs(packet, node, mask, own)) return;
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
    /// Compares the leaves of a node that are in `mask` with the own ones. False if the queue is
    /// full.
    constexpr bool queue_pairs(std::uint32_t packet, std::uint32_t node, std::uint32_t mask,
                               warp::per_lane<rounded_box>& own) const {
        const std::uint32_t first_leaf = node * box_levels::children;
        warp::per_lane<std::uint32_t> found;  // leaves of the node
        for (; mask != 0; mask &= mask - 1) {
            const rounded_box b = tree.box(0, first_leaf + warp::lowest(mask));
            const std::uint32_t bit = mask & (~mask + 1);
            warp::each([&](std::uint32_t lane) { found[lane] |= own[lane].touches(b) ? bit : 0; });
        }
        if (one_tree && node == packet)
            warp::each([&](std::uint32_t lane) { found[lane] &= ~std::uint32_t(1) << lane; });
        if (warp::ballot([&](std::uint32_t lane) { return found[lane] != 0; }) == 0) return true;
        warp::per_lane<std::uint64_t> places;
        if (warp::append(&counters->touching, found, places) > capacity) return false;
        warp::each([&](std::uint32_t lane) {
            leaf_pair* to = touching + places[lane];
            for (std::uint32_t rest = found[lane]; rest != 0; rest &= rest - 1)
                *to++ = {packet * warp::lanes + lane, first_leaf + warp::lowest(rest)};
        });
        return true;
    }
};

/// Makes candidates of pairs that share no vertex and whose exact swept boxes touch.
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

/// Sorting by the vertices of rows, from the last column to the first, orders the rows.
struct column_key {
    const std::array<vertex_index, 4>* rows;
    std::size_t column;
    std::uint32_t *keys, *order;

    constexpr void operator()(std::uint32_t i) const {
        if (column == 3) order[i] = i;
        keys[i] = rows[order[i]][column];
    }
};

struct found_pairs {
    std::size_t vertex_face_candidates = 0, edge_edge_candidates = 0;
    std::size_t vertex_face = 0, edge_edge = 0, finished_on_host = 0;
    bool finite = true;  ///< false: the step was not tested
};

template <class Launcher>
class step_memory {
  public:
    template <class T>
    using buffer = typename Launcher::template buffer<T>;

    /// The maximum number of pairs that are searched and decided at once. At least 32, those of a
    /// packet and a leaf.
    static constexpr std::size_t default_block = std::size_t(1) << 22;
    explicit step_memory(std::size_t block = default_block)
        : block_(std::max<std::size_t>(block, warp::lanes)) {}

    /// Precondition: faces and edges are in host memory, with indices in range.
    void set_mesh(Launcher& launcher, std::size_t vertices, std::span<const face> faces,
                  std::span<const edge> edges) {
        vertices_ = vertices;
        faces_.resize(launcher, faces.size());
        launcher.write(faces_.data(), faces.size(), faces.data());
        edges_.resize(launcher, edges.size());
        launcher.write(edges_.data(), edges.size(), edges.data());
    }

    /// Finds the pairs, in vertex_face() and edge_edge(), and sorts them by their vertices.
    /// `decide(candidates, answers, scene, rows)` queues the decision of a block, with positions
    /// rounded to `rows`, and returns the number of candidates decided on the host.
    template <class Decide>
    found_pairs run(Launcher& launcher, const positions& at, const Decide& decide) {
        found_pairs found;
        rows_.resize(launcher, 2 * vertices_);
        scene_.resize(launcher, 1);
        run_rounding(launcher, at, scene_.data(), rows_.data());
        auto scene = scene_extent::nothing();
        launcher.read(scene_.data(), 1, &scene);
        found.finite = scene.finite;
        if (!found.finite) return found;

        const elements<1> vertices{nullptr, vertices_};
        const elements<3> faces{faces_.data(), faces_.size()};
        const elements<2> edges{edges_.data(), edges_.size()};
        const box_levels of_vertices = make_tree(launcher, vertices, tree_);
        run_search(
            launcher,
            candidate_filter<3, 1, vertex_face_pair>{
                at, {make_tree(launcher, faces, other_tree_), of_vertices, false}, faces, vertices},
            decide, vertex_face_, found.vertex_face, found.vertex_face_candidates, found);
        const box_levels of_edges = make_tree(launcher, edges, tree_);
        run_search(
            launcher,
            candidate_filter<2, 2, edge_edge_pair>{at, {of_edges, of_edges, true}, edges, edges},
            decide, edge_edge_, found.edge_edge, found.edge_edge_candidates, found);
        launcher.wait();
        return found;
    }

    buffer<vertex_face_pair>& vertex_face() { return vertex_face_; }
    buffer<edge_edge_pair>& edge_edge() { return edge_edge_; }

  private:
    template <std::size_t N>
    box_levels make_tree(Launcher& launcher, const elements<N>& all, buffer<rounded_box>& boxes) {
        keys_.resize(launcher, all.count);
        order_.resize(launcher, all.count);
        launcher.for_each(all.count, curve_key<N>{all, rows_.data(), keys_.data(), order_.data()});
        launcher.sort(keys_.data(), order_.data(), all.count);
        box_levels tree(all.count);
        boxes.resize(launcher, tree.size);
        tree.boxes = boxes.data();
        launcher.for_each(box_levels::children * tree.packets(),
                          make_leaf<N>{all, rows_.data(), order_.data(), boxes.data()});
        for (std::size_t level = 1; level < tree.levels; ++level)
            launcher.for_each(tree.count[level],
                              make_node{boxes.data() + tree.start[level - 1], tree.count[level - 1],
                                        boxes.data() + tree.start[level]});
        return tree;
    }

    /// Counts candidates and collects pairs, part after part. No part has more than block_ pairs.
    template <std::size_t A, std::size_t B, class Pair, class Decide>
    void run_search(Launcher& launcher, candidate_filter<A, B, Pair> filter, const Decide& decide,
                    buffer<Pair>& pairs, std::size_t& pair_count, std::size_t& candidates,
                    found_pairs& found) {
        packet_search& search = filter.search;
        const std::size_t packets = search.searching.packets(), leaves = search.tree.leaves();
        search.capacity = std::min(block_, warp::lanes * packets * leaves);
        touching_.resize(launcher, search.capacity);
        search.touching = touching_.data();
        counters_.resize(launcher, 1);
        search.counters = counters_.data();
        colliding_.resize(launcher, 0);
        search_part& part = search.part = {0, packets, 0, leaves};
        while (leaves > 0 && part.packet < packets && launcher.ok()) {
            launcher.set(search.counters, search_counters{});
            launcher.for_each_packet(std::min(part.packets, packets - part.packet), search);
            search_counters counted{};
            launcher.read(search.counters, 1, &counted);
            if (counted.touching > search.capacity) {
                part.halve();
                continue;
            }
            const auto touching = static_cast<std::size_t>(counted.touching);
            block_rows_.resize(launcher, touching);
            auto* const rows = reinterpret_cast<Pair*>(block_rows_.data());
            filter.candidates = {rows, &search.counters->candidates};
            launcher.for_each(touching, filter);
            launcher.read(search.counters, 1, &counted);
            const std::size_t count = counted.candidates;
            answers_.resize(launcher, count);
            if (count > 0)
                found.finished_on_host += decide(cuda::candidates<Pair>::rows(rows, count),
                                                 answers_.data(), scene_.data(), rows_.data());
            selection_.select(launcher, may_collide_at{answers_.data()}, count);
            selection_.copy(launcher, block_rows_.data(), colliding_, pair_count);
            pair_count += selection_.size();
            candidates += count;
            part.advance(leaves, touching <= search.capacity / 2);
        }
        sort_pairs(launcher, pairs, pair_count);
    }

    /// Sorts the rows of colliding_ into `pairs`.
    template <class Pair>
    void sort_pairs(Launcher& launcher, buffer<Pair>& pairs, std::size_t count) {
        keys_.resize(launcher, count);
        order_.resize(launcher, count);
        pairs.resize(launcher, count);
        for (const std::size_t column : {3, 2, 1, 0}) {
            launcher.for_each(count,
                              column_key{colliding_.data(), column, keys_.data(), order_.data()});
            launcher.sort(keys_.data(), order_.data(), count);
        }
        launcher.for_each(count, copy_rows<Pair>{reinterpret_cast<const Pair*>(colliding_.data()),
                                                 order_.data(), pairs.data()});
    }

    std::size_t block_;
    std::size_t vertices_ = 0;
    buffer<face> faces_;
    buffer<edge> edges_;
    buffer<scene_extent> scene_;
    buffer<rounded_position> rows_;
    buffer<rounded_box> tree_, other_tree_;
    buffer<std::uint32_t> keys_, order_;
    buffer<leaf_pair> touching_;
    buffer<search_counters> counters_;
    buffer<std::array<vertex_index, 4>> block_rows_, colliding_;
    buffer<outcome> answers_;
    selection<Launcher> selection_;
    buffer<vertex_face_pair> vertex_face_;
    buffer<edge_edge_pair> edge_edge_;
};

}  // namespace ccd::cuda::detail
