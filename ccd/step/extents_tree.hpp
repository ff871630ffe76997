// A tree over the extents of elements, sixteen to a node: see ccd/step/extents_pack.hpp.
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <ccd/kind.hpp>
#include <cstddef>
#include <span>

#include "ccd/batch/first_touch.hpp"
#include "ccd/step/extents_pack.hpp"
#include "ccd/step/search_kernels.hpp"

namespace ccd::detail {

class extents_tree {
  public:
    /// Builds the tree over `elements`, at least one, whose vertices have rows in `rounded`
    /// (rounded_positions::data()), off by less than `margin`. If `swept`, extents at the start
    /// contain those at the end. Cost: O(count), on all threads of the arena. Memory, reused: 175
    /// bytes an element.
    template <std::size_t N>
    void build(const search_kernels& kernels, const float* rounded, float margin, bool swept,
               std::span<const std::array<vertex_index, N>> elements) {
        set_levels(elements.size());
        for_packs(0, [&](std::size_t first, std::size_t end, extents_pack* packs, extents* hulls) {
            constexpr auto fill = N == 1   ? &search_kernels::of_vertices
                                  : N == 2 ? &search_kernels::of_edges
                                           : &search_kernels::of_faces;
            (kernels.*fill)(rounded, margin, swept, elements.data()->data(), elements.size(), first,
                            end, packs, hulls, vertices_.data());
        });
        for (std::size_t level = 1; level < levels_.count; ++level)
            for_packs(level,
                      [&](std::size_t first, std::size_t end, extents_pack* packs, extents* hulls) {
                          kernels.fill_nodes(levels_.at[level - 1].hulls, sizes_[level - 1], first,
                                             end, packs, hulls);
                      });
    }

    const extents_levels& levels() const { return levels_; }
    std::size_t leaves() const { return sizes_[0]; }

    /// The leaves' lengths along the coordinate axes at both ends of the step. A good order keeps
    /// them small.
    double length_of_leaves() const {
        double sum = 0;
        for (std::size_t leaf = 0; leaf < leaves(); ++leaf) {
            const auto& hull = levels_.at[0].hulls[leaf].of;
            for (std::size_t k = 0; k < 3; ++k)
                for (std::size_t end = 0; end < 2; ++end)
                    sum += double(hull[4 * k + 2 + end]) - double(hull[4 * k + end]);
        }
        return sum;
    }

  private:
    void set_levels(std::size_t count) {
        std::size_t packs = 0, in_level = count;
        levels_.count = 0;
        do {
            in_level = (in_level + extents_pack::size - 1) / extents_pack::size;
            starts_[levels_.count] = packs;
            sizes_[levels_.count++] = in_level;
            packs += in_level;
        } while (in_level > 1);
        packs_.resize(packs);
        hulls_.resize(packs);
        vertices_.resize(sizes_[0]);
        levels_.vertices = vertices_.data();
        for (std::size_t level = 0; level < levels_.count; ++level)
            levels_.at[level] = {&packs_[starts_[level]], &hulls_[starts_[level]]};
    }

    template <class Fill>
    void for_packs(std::size_t level, const Fill& fill) {
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, sizes_[level], 64),
                          [&](const tbb::blocked_range<std::size_t>& range) {
                              fill(range.begin(), range.end(), &packs_[starts_[level]],
                                   &hulls_[starts_[level]]);
                          });
    }

    first_touch_vector<extents_pack> packs_;  ///< the leaves, the nodes above them, ..., the root
    first_touch_vector<extents> hulls_;
    first_touch_vector<leaf_vertices> vertices_;
    extents_levels levels_;
    std::array<std::size_t, extents_levels::most> starts_{}, sizes_{};
};

}  // namespace ccd::detail
