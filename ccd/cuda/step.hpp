// A step of a mesh on the device: candidates by a tree of boxes, decided in blocks. Internal.
//
// The tree is that of ccd/step/box_tree.hpp without its packs: boxes sorted along a Morton curve,
// with eight per node, so that nodes have no pointers and a search has no stack. Each element
// counts its candidates, a prefix sum numbers them, and blocks of candidates are written and
// decided. Results do not depend on the order of threads, and no block can overflow.
#pragma once

#include <algorithm>
#include <array>
#include <ccd/cuda.hpp>
#include <ccd/mesh.hpp>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "ccd/cuda/exact_stages.hpp"
#include "ccd/cuda/launch.hpp"
#include "ccd/cuda/pairs.hpp"
#include "ccd/cuda/queries.hpp"
#include "ccd/step/elements.hpp"

namespace ccd::cuda::detail {

/// A closed box of rounded coordinates (ccd/batch/rounded_axes.hpp).
/// Proof: proofs/RoundedAxes.v, swept_rounded_first, swept_face_separate, swept_edges_separate,
/// swept_boxes_touch.
struct rounded_box {
    float low[3], high[3];

    constexpr void widen(const rounded_box& b) {
        for (std::size_t k = 0; k < 3; ++k) {
            low[k] = std::min(low[k], b.low[k]);
            high[k] = std::max(high[k], b.high[k]);
        }
    }
    /// Boxes that touch in exact arithmetic touch when rounded.
    constexpr bool touches(const rounded_box& b) const {
        bool touching = true;
        for (std::size_t k = 0; k < 3; ++k)
            touching = touching && low[k] <= b.high[k] && high[k] >= b.low[k];
        return touching;
    }
    /// If true, the boxes touch in exact arithmetic.
    constexpr bool overlaps(const rounded_box& b) const {
        bool overlapping = true;
        for (std::size_t k = 0; k < 3; ++k)
            overlapping = overlapping && low[k] < b.high[k] && high[k] > b.low[k];
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
constexpr rounded_box swept_box(const rounded_position* rows,
                                const std::array<vertex_index, N>& vertices) {
    const auto of_row = [](const rounded_position& r) {
        return rounded_box{{r.x, r.y, r.z}, {r.x, r.y, r.z}};
    };
    rounded_box b = of_row(load_aligned(rows + 2 * std::size_t(vertices[0])));
    for (std::size_t i = 0; i < N; ++i)
        for (std::size_t end = 0; end < 2; ++end)
            b.widen(of_row(load_aligned(rows + 2 * std::size_t(vertices[i]) + end)));
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

/// Boxes of sorted elements, level by level: box i of a level is around boxes 8i to 8i + 7 of the
/// level below it.
struct box_levels {
    static constexpr std::size_t children = 8, max_levels = 12;
    static constexpr unsigned child_bits = 3;

    const rounded_box* boxes = nullptr;
    const std::uint32_t* order = nullptr;  ///< leaf i holds element order[i]
    std::size_t levels = 0;
    std::size_t start[max_levels] = {}, count[max_levels] = {};

    constexpr box_levels() = default;
    explicit constexpr box_levels(std::size_t leaves) {
        std::size_t at = 0;
        for (std::size_t n = leaves; n > 0; n = n > 1 ? (n + children - 1) / children : 0) {
            start[levels] = at;
            count[levels++] = n;
            at += n;
        }
    }
    constexpr std::size_t size() const {
        return levels == 0 ? 0 : start[levels - 1] + count[levels - 1];
    }

    /// Calls visit(i) for every leaf i >= first whose box touches b, in ascending order.
    template <class Visit>
    constexpr void find(const rounded_box& b, std::size_t first, const Visit& visit) const {
        if (levels == 0) return;
        std::size_t level = levels - 1, i = 0;
        for (;;) {
            const bool in_reach = (i + 1) << (child_bits * level) > first;
            if (in_reach && boxes[start[level] + i].touches(b)) {
                if (level > 0) {
                    --level;
                    i *= children;
                    continue;
                }
                visit(static_cast<std::uint32_t>(i));
            }
            ++i;
            // The last child of a node is followed by the next node.
            while (level + 1 < levels && (i % children == 0 || i == count[level])) {
                i = (i + children - 1) / children;
                ++level;
            }
            if (i == count[level]) return;
        }
    }
};

template <std::size_t N>
struct curve_key {
    elements<N> all;
    const rounded_position* rows;
    std::uint32_t *keys, *order;

    constexpr void operator()(std::uint32_t i) const {
        const rounded_box b = swept_box(rows, all[i]);
        std::uint32_t key = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            // Coordinates are within about [−1, 1]; NaN counts as 0.
            const float place = (0.5f * b.low[k] + 0.5f * b.high[k] + 1.0f) * 512.0f;
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

    constexpr void operator()(std::uint32_t i) const { boxes[i] = swept_box(rows, all[order[i]]); }
};
struct make_node {
    const rounded_box* below;
    std::size_t count;
    rounded_box* level;

    constexpr void operator()(std::uint32_t i) const {
        const std::size_t first = box_levels::children * i;
        rounded_box b = below[first];
        for (std::size_t k = 1; k < box_levels::children && first + k < count; ++k)
            b.widen(below[first + k]);
        level[i] = b;
    }
};

/// Calls visit with the candidate of two elements, if it is one. `certain`: the boxes certainly
/// touch.
template <std::size_t A, std::size_t B, class Visit>
constexpr void visit_candidate(const positions& at, const std::array<vertex_index, A>& a,
                               const std::array<vertex_index, B>& b, bool certain,
                               const Visit& visit) {
    if (!ccd::detail::share_vertex(a, b) && (certain || exactly_touch(at, a, b)))
        visit(ccd::detail::candidate_of(a, b));
}

/// Calls visit(candidate) for all candidates of the vertices in the tree with face i.
struct face_search {
    using indices = vertex_face_pair;
    positions at;
    const rounded_position* rows;
    box_levels tree;
    elements<3> searching;
    const std::uint32_t* order;  ///< the order of searching faces, with neighbours together

    template <class Visit>
    constexpr void operator()(std::uint32_t i, const Visit& visit) const {
        const face f = searching[order[i]];
        const rounded_box b = swept_box(rows, f);
        tree.find(b, 0, [&](std::uint32_t leaf) {
            const std::array<vertex_index, 1> v{tree.order[leaf]};
            visit_candidate(at, v, f, tree.boxes[leaf].overlaps(b), visit);
        });
    }
};

/// Calls visit(candidate) for all candidates of leaf i with later ones.
struct edge_search {
    using indices = edge_edge_pair;
    positions at;
    box_levels tree;
    elements<2> searching;

    template <class Visit>
    constexpr void operator()(std::uint32_t i, const Visit& visit) const {
        const edge mine = searching[tree.order[i]];
        const rounded_box b = tree.boxes[i];
        tree.find(b, std::size_t(i) + 1, [&](std::uint32_t leaf) {
            const edge other = searching[tree.order[leaf]];
            visit_candidate(at, mine, other, tree.boxes[leaf].overlaps(b), visit);
        });
    }
};

template <class Search>
struct count_candidates {
    Search search;
    std::uint32_t* counts;

    constexpr void operator()(std::uint32_t i) const {
        std::uint32_t n = 0;
        search(i, [&](const auto&) { ++n; });
        counts[i] = n;
    }
};
struct count_of {
    const std::uint32_t* counts;
    constexpr std::uint64_t operator()(std::uint32_t i) const { return counts[i]; }
};

template <class Search>
struct write_candidates {
    Search search;
    const std::uint64_t* numbers;  ///< number of each search's first candidate, and the total
    std::uint64_t first;
    std::size_t count;
    typename Search::indices* to;

    constexpr void operator()(std::uint32_t i) const {
        if (numbers[i] >= first + count || numbers[i + 1] <= first) return;
        std::uint64_t number = numbers[i];
        search(i, [&](const auto& candidate) {
            if (number >= first && number < first + count) to[number - first] = candidate;
            ++number;
        });
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

    /// The maximum number of candidates that are decided at once.
    static constexpr std::size_t default_block = std::size_t(1) << 22;
    explicit step_memory(std::size_t block = default_block) : block_(block) {}

    /// Precondition: faces and edges are in host memory, with indices in range.
    void set_mesh(Launcher& launcher, std::size_t vertices, std::span<const face> faces,
                  std::span<const edge> edges) {
        vertices_ = vertices;
        faces_.resize(launcher, faces.size());
        launcher.write(faces_.data(), faces.size(), faces.data());
        edges_.resize(launcher, edges.size());
        launcher.write(edges_.data(), edges.size(), edges.data());
    }

    /// Finds the pairs, in vertex_face() and edge_edge(). `decide(candidates, answers, scene,
    /// rows)` queues the decision of a block, with positions rounded to `rows`, and returns the
    /// number of candidates decided on the host.
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
        {
            const box_levels tree = make_tree(launcher, vertices, tree_, order_);
            sort_along_curve(launcher, faces, search_order_);
            const face_search search{at, rows_.data(), tree, faces, search_order_.data()};
            found.vertex_face_candidates =
                run_search(launcher, search, faces.count, decide, vertex_face_, found.vertex_face,
                           found.finished_on_host);
        }
        {
            const box_levels tree = make_tree(launcher, edges, tree_, order_);
            const edge_search search{at, tree, edges};
            found.edge_edge_candidates =
                run_search(launcher, search, edges.count, decide, edge_edge_, found.edge_edge,
                           found.finished_on_host);
        }
        launcher.wait();
        return found;
    }

    buffer<vertex_face_pair>& vertex_face() { return vertex_face_; }
    buffer<edge_edge_pair>& edge_edge() { return edge_edge_; }

  private:
    template <std::size_t N>
    void sort_along_curve(Launcher& launcher, const elements<N>& all,
                          buffer<std::uint32_t>& order) {
        keys_.resize(launcher, all.count);
        order.resize(launcher, all.count);
        launcher.for_each(all.count, curve_key<N>{all, rows_.data(), keys_.data(), order.data()});
        launcher.sort(keys_.data(), order.data(), all.count);
    }

    template <std::size_t N>
    box_levels make_tree(Launcher& launcher, const elements<N>& all, buffer<rounded_box>& boxes,
                         buffer<std::uint32_t>& order) {
        sort_along_curve(launcher, all, order);
        box_levels tree(all.count);
        boxes.resize(launcher, tree.size());
        tree.boxes = boxes.data();
        tree.order = order.data();
        launcher.for_each(all.count, make_leaf<N>{all, rows_.data(), order.data(), boxes.data()});
        for (std::size_t level = 1; level < tree.levels; ++level)
            launcher.for_each(tree.count[level],
                              make_node{boxes.data() + tree.start[level - 1], tree.count[level - 1],
                                        boxes.data() + tree.start[level]});
        return tree;
    }

    template <class Search, class Decide, class Pair>
    std::size_t run_search(Launcher& launcher, const Search& search, std::size_t searches,
                           const Decide& decide, buffer<Pair>& pairs, std::size_t& pair_count,
                           std::size_t& finished_on_host) {
        counts_.resize(launcher, searches);
        numbers_.resize(launcher, searches + 1);
        launcher.for_each(searches, count_candidates<Search>{search, counts_.data()});
        launcher.exclusive_scan(count_of{counts_.data()}, numbers_.data(), searches);
        std::uint64_t total = 0;
        launcher.read(numbers_.data() + searches, 1, &total);

        const auto at_once = static_cast<std::size_t>(std::min<std::uint64_t>(total, block_));
        block_rows_.resize(launcher, at_once);
        auto* const rows = reinterpret_cast<Pair*>(block_rows_.data());
        answers_.resize(launcher, at_once);
        pair_count = 0;
        pairs.resize(launcher, 0);
        for (std::uint64_t first = 0; first < total && launcher.ok(); first += at_once) {
            const auto count =
                static_cast<std::size_t>(std::min<std::uint64_t>(at_once, total - first));
            launcher.for_each(
                searches, write_candidates<Search>{search, numbers_.data(), first, count, rows});
            finished_on_host += decide(candidates<Pair>::rows(rows, count), answers_.data(),
                                       scene_.data(), rows_.data());
            selection_.select(launcher, may_collide_at{answers_.data()}, count);
            selection_.copy(launcher, rows, pairs, pair_count);
            pair_count += selection_.size();
        }
        return static_cast<std::size_t>(total);
    }

    std::size_t block_;
    std::size_t vertices_ = 0;
    buffer<face> faces_;
    buffer<edge> edges_;
    buffer<scene_extent> scene_;
    buffer<rounded_position> rows_;
    buffer<rounded_box> tree_;
    buffer<std::uint32_t> keys_, order_, search_order_, counts_;
    buffer<std::uint64_t> numbers_;
    buffer<std::array<vertex_index, 4>> block_rows_;
    buffer<outcome> answers_;
    selection<Launcher> selection_;
    buffer<vertex_face_pair> vertex_face_;
    buffer<edge_edge_pair> edge_edge_;
};

}  // namespace ccd::cuda::detail
