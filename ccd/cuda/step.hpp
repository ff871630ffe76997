// A step of a mesh on the device: candidates (ccd/cuda/packet_search.hpp) and their decision, block
// after block. Colliding pairs are sorted, so the order of threads does not matter. Internal.
#pragma once

#include <algorithm>
#include <array>
#include <ccd/cuda.hpp>
#include <ccd/mesh.hpp>
#include <cstddef>
#include <cstdint>
#include <span>

#include "ccd/cuda/exact_stages.hpp"
#include "ccd/cuda/launch.hpp"
#include "ccd/cuda/packet_search.hpp"
#include "ccd/cuda/pairs.hpp"

namespace ccd::cuda::detail {

/// Sets the keys to sort rows of vertices by one column. Stable sorts by each column, from the last
/// to the first, order the rows.
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

    /// The maximum number of pairs in a block; at least 32, those of a packet and a leaf.
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
            launcher.for_each(box_levels::children * box_levels::nodes(tree.count[level]),
                              make_node{boxes.data() + tree.start[level - 1], tree.count[level - 1],
                                        boxes.data() + tree.start[level]});
        return tree;
    }

    /// Searches one part after the other; no part has more than block_ pairs.
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
