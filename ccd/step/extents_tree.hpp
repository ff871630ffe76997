// A tree over the extents of elements, sixteen to a node: see ccd/step/trees/extents_pack.hpp.
#pragma once

#include <algorithm>
#include <array>
#include <ccd/kind.hpp>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "ccd/batch/first_touch.hpp"
#include "ccd/batch/rounded_positions.hpp"
#include "ccd/batch/threads.hpp"
#include "ccd/step/search_kernels.hpp"
#include "ccd/step/swept_boxes.hpp"
#include "ccd/step/trees/extents_pack.hpp"

namespace ccd::detail {

/// The extents in a tree: at the start of the step, at both ends, or at both ends where those at
/// the start contain those at the end.
enum class extents_of { start, both_ends, whole_way };

/// The leaves of a tree over elements, without the tree.
template <std::size_t N>
struct extents_leaves {
    const float* rounded;  ///< rounded_positions::data()
    std::span<const std::array<vertex_index, N>> elements;
    std::size_t ends = 2;  ///< of the step

    /// The sum of the lengths of a sample along the coordinate axes. A good order keeps it small.
    double length_of_leaves() const {
        constexpr std::size_t size = extents_column::size;
        const std::size_t stride = size * sampling_stride(elements.size() / size);
        double sum = 0;
        for (std::size_t first = 0; first < elements.size(); first += stride)
            for (std::size_t end = 0; end < ends; ++end)
                sum += length(elements.subspan(first, std::min(size, elements.size() - first)),
                              4 * end);
        return sum;
    }

  private:
    double length(std::span<const std::array<vertex_index, N>> leaf, std::size_t end) const {
        const auto row = [&](vertex_index v) {
            return rounded + rounded_positions::row * std::size_t(v) + end;
        };
        double sum = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            float low = row(leaf[0][0])[k], high = low;
            for (const auto& element : leaf)
                for (const vertex_index v : element) {
                    low = std::min(low, row(v)[k]);
                    high = std::max(high, row(v)[k]);
                }
            sum += double(high) - double(low);
        }
        return sum;
    }
};

class extents_tree {
  public:
    /// Builds the tree over `elements`, at least one, whose vertices have rows in `rounded`
    /// (rounded_positions::data()), off by less than `margin`. Cost: O(count), on all threads of
    /// the arena. Memory, reused: 175 bytes an element, 95 at rest.
    template <std::size_t N>
    void build(const search_kernels& kernels, const float* rounded, float margin,
               std::span<const std::array<vertex_index, N>> elements,
               extents_of ends = extents_of::both_ends) {
        levels_.columns = extents::columns_of_end * (ends == extents_of::start ? 1 : 2);
        set_levels(elements.size());
        for_packs(0, [&](std::size_t first, std::size_t end, extents_column* packs, float* hulls) {
            constexpr auto fill = N == 1   ? &search_kernels::of_vertices
                                  : N == 2 ? &search_kernels::of_edges
                                           : &search_kernels::of_faces;
            (kernels.*fill)(rounded, margin, ends == extents_of::whole_way, elements.data()->data(),
                            elements.size(), first, end, levels_.columns, packs, hulls,
                            vertices_.data());
        });
        for (std::size_t level = 1; level < levels_.count; ++level)
            for_packs(level,
                      [&](std::size_t first, std::size_t end, extents_column* packs, float* hulls) {
                          kernels.fill_nodes(levels_.at[level - 1].hulls, sizes_[level - 1], first,
                                             end, levels_.columns, packs, hulls);
                      });
    }

    /// Makes the extents at the start contain those at the end. Precondition: built with both ends.
    /// Proof: proofs/filters/Extents.v, swept_extents_hold.
    void sweep() {
        constexpr std::size_t at_end = extents::columns_of_end;
        const auto sweep = [](std::size_t column, float& start, float end) {
            start = column % 2 == 0 ? std::min(start, end) : std::max(start, end);
        };
        const auto sweep_pack = [&](extents_column* pack, float* hull) {
            for (std::size_t c = 0; c < at_end; ++c) {
                for (std::size_t i = 0; i < extents_column::size; ++i)
                    sweep(c, pack[c].at[i], pack[c + at_end].at[i]);
                sweep(c, hull[c], hull[c + at_end]);
            }
        };
        for (std::size_t level = 0; level < levels_.count; ++level)
            for_packs(level,
                      [&](std::size_t p, std::size_t end, extents_column* packs, float* hulls) {
                          for (; p < end; ++p)
                              sweep_pack(packs + levels_.columns * p, hulls + levels_.columns * p);
                      });
    }

    const extents_levels& levels() const { return levels_; }
    std::size_t leaves() const { return sizes_[0]; }

    std::vector<std::size_t> longest_leaves(std::size_t count) const {
        std::vector<std::pair<double, std::size_t>> all(leaves());
        for (std::size_t leaf = 0; leaf < leaves(); ++leaf) all[leaf] = {-length(leaf), leaf};
        std::ranges::nth_element(all, all.begin() + static_cast<std::ptrdiff_t>(count));
        std::vector<std::size_t> longest(count);
        std::ranges::transform(std::span(all).first(count), longest.begin(),
                               [](const auto& leaf) { return leaf.second; });
        return longest;
    }

  private:
    double length(std::size_t leaf) const {
        const std::size_t ends = levels_.columns / extents::columns_of_end;
        double sum = 0;
        for (std::size_t end = 0; end < ends; ++end) {
            const float* hull = levels_.hull(0, leaf) + extents::columns_of_end * end;
            for (std::size_t k = 0; k < 3; ++k)
                sum += double(hull[2 * k + 1]) - double(hull[2 * k]);
        }
        return sum / static_cast<double>(ends);
    }
    void set_levels(std::size_t count) {
        std::size_t packs = 0, in_level = count;
        levels_.count = 0;
        do {
            in_level = (in_level + extents_column::size - 1) / extents_column::size;
            starts_[levels_.count] = packs;
            sizes_[levels_.count++] = in_level;
            packs += in_level;
        } while (in_level > 1);
        packs_.resize(levels_.columns * packs);
        hulls_.resize(levels_.columns * packs);
        vertices_.resize(sizes_[0]);
        levels_.vertices = vertices_.data();
        for (std::size_t level = 0; level < levels_.count; ++level)
            levels_.at[level] = {packs_of(level), hulls_of(level)};
    }

    template <class Fill>
    void for_packs(std::size_t level, const Fill& fill) {
        constexpr std::size_t few = 64;  // for one thread, which takes up no other task meanwhile
        if (sizes_[level] <= few) return fill(0, sizes_[level], packs_of(level), hulls_of(level));
        for_each_range(sizes_[level], few, [&](std::size_t begin, std::size_t end) {
            fill(begin, end, packs_of(level), hulls_of(level));
        });
    }
    extents_column* packs_of(std::size_t level) {
        return packs_.data() + levels_.columns * starts_[level];
    }
    float* hulls_of(std::size_t level) { return hulls_.data() + levels_.columns * starts_[level]; }

    first_touch_vector<extents_column> packs_;  ///< the leaves, the nodes above them, ..., the root
    first_touch_vector<float> hulls_;
    first_touch_vector<leaf_vertices> vertices_;
    extents_levels levels_;
    std::array<std::size_t, extents_levels::most> starts_{}, sizes_{};
};

}  // namespace ccd::detail
