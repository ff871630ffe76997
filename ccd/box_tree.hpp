// A tree over boxes, eight to a node, that finds all boxes touching a given one.
//
// The boxes come in an order in which neighbours are near each other; eight consecutive boxes form
// a leaf, eight consecutive leaves a node above it, and so on up to one root. Nodes therefore need
// no pointers, and one box is compared with a whole node by straight loops over floats.
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace ccd {

/// A closed box whose coordinates are at most about 1 in magnitude.
struct float_box {
    std::array<float, 3> low, high;
};

/// Bit i stands for box i of a pack.
using pack_mask = std::uint32_t;

template <class Visit>
void for_each_bit(pack_mask mask, const Visit& visit) {
    for (; mask != 0; mask &= mask - 1) visit(static_cast<std::size_t>(std::countr_zero(mask)));
}

/// Up to eight boxes side by side; the rest are nowhere and touch nothing.
class box_pack {
  public:
    static constexpr std::size_t size = 8;

    box_pack() {
        for (std::size_t k = 0; k < 3; ++k) {
            low_[k].fill(nowhere);
            high_[k].fill(-nowhere);
        }
    }

    void set(std::size_t i, const float_box& b) {
        for (std::size_t k = 0; k < 3; ++k) {
            low_[k][i] = b.low[k];
            high_[k][i] = b.high[k];
        }
    }

    float_box box(std::size_t i) const {
        return {{low_[0][i], low_[1][i], low_[2][i]}, {high_[0][i], high_[1][i], high_[2][i]}};
    }

    /// The smallest box around all of them.
    float_box hull() const {
        float_box b;
        for (std::size_t k = 0; k < 3; ++k) {
            b.low[k] = *std::ranges::min_element(low_[k]);
            b.high[k] = *std::ranges::max_element(high_[k]);
        }
        return b;
    }

    /// Those that touch b.
    pack_mask touching(const float_box& b) const {
        pack_mask found = 0;
        for (std::size_t i = 0; i < size; ++i) found |= gap(i, b) <= 0 ? bits[i] : 0;
        return found;
    }

    struct comparison {
        pack_mask touching;  ///< as touching()
        pack_mask overlap;   ///< those of them that reach into b on every axis
    };
    comparison compare(const float_box& b) const {
        comparison found{0, 0};
        for (std::size_t i = 0; i < size; ++i) {
            found.touching |= gap(i, b) <= 0 ? bits[i] : 0;
            found.overlap |= gap(i, b) < 0 ? bits[i] : 0;
        }
        return found;
    }

  private:
    static constexpr float nowhere = 4;
    static constexpr std::array<pack_mask, size> bits = [] {
        std::array<pack_mask, size> powers{};
        for (std::size_t i = 0; i < size; ++i) powers[i] = pack_mask(1) << i;
        return powers;
    }();

    /// The largest distance between box i and b along an axis; negative where they overlap. Its
    /// sign is right: a difference of floats is 0 only between equals, and where a processor
    /// flushes small ones to 0, boxes seem to touch on that axis without overlap.
    float gap(std::size_t i, const float_box& b) const {
        float largest = std::max(low_[0][i] - b.high[0], b.low[0] - high_[0][i]);
        for (std::size_t k = 1; k < 3; ++k)
            largest =
                std::max(largest, std::max(low_[k][i] - b.high[k], b.low[k] - high_[k][i]));
        return largest;
    }

    std::array<std::array<float, size>, 3> low_, high_;
};

class box_tree {
  public:
    /// Over the boxes box_of(0), ..., box_of(count - 1). Cost: O(count), on all threads of the
    /// arena; memory: 27.5 bytes a box.
    template <class BoxOf>
    box_tree(std::size_t count, const BoxOf& box_of) {
        std::size_t packs = 0, in_level = count;
        do {
            in_level = (in_level + box_pack::size - 1) / box_pack::size;
            level_start_[levels_++] = packs;
            packs += in_level;
        } while (in_level > 1);
        level_start_[levels_] = packs;
        packs_.resize(packs);

        fill(0, count, box_of);
        for (std::size_t level = 1; level < levels_; ++level) {
            const box_pack* below = &packs_[level_start_[level - 1]];
            fill(level, level_start_[level] - level_start_[level - 1],
                 [below](std::size_t i) { return below[i].hull(); });
        }
    }

    /// Leaf p holds boxes 8 p to 8 p + 7.
    std::span<const box_pack> leaves() const { return {packs_.data(), level_start_[1]}; }

    /// Calls visit(p, members) for every leaf p >= first with members that touch b.
    template <class Visit>
    void find(const float_box& b, std::size_t first, const Visit& visit) const {
        if (packs_.empty()) return;
        struct node {
            std::size_t level, position;
        };
        std::array<node, box_pack::size * most_levels> open;
        std::size_t opened = 0;
        open[opened++] = {levels_ - 1, 0};
        while (opened > 0) {
            const auto [level, position] = open[--opened];
            const pack_mask members = packs_[level_start_[level] + position].touching(b);
            if (level == 0) {
                if (members != 0) visit(position, members);
                continue;
            }
            const std::size_t first_child = first >> (pack_bits * (level - 1));
            for_each_bit(members, [&](std::size_t i) {
                const std::size_t child = box_pack::size * position + i;
                if (child >= first_child) open[opened++] = {level - 1, child};
            });
        }
    }

  private:
    /// Eight to the power of 11 exceeds every number of indices.
    static constexpr std::size_t most_levels = 11;
    static constexpr std::size_t pack_bits = std::countr_zero(box_pack::size);

    /// Sets the packs of a level to `count` boxes.
    template <class BoxOf>
    void fill(std::size_t level, std::size_t count, const BoxOf& box_of) {
        const std::size_t start = level_start_[level];
        tbb::parallel_for(
            tbb::blocked_range<std::size_t>(0, level_start_[level + 1] - start, 128),
            [&](const tbb::blocked_range<std::size_t>& range) {
                for (std::size_t p = range.begin(); p < range.end(); ++p)
                    for (std::size_t i = p * box_pack::size;
                         i < std::min(count, (p + 1) * box_pack::size); ++i)
                        packs_[start + p].set(i % box_pack::size, box_of(i));
            });
    }

    std::vector<box_pack> packs_;  ///< the leaves, the nodes above them, ..., the root
    std::array<std::size_t, most_levels + 1> level_start_{};
    std::size_t levels_ = 0;
};

/// Calls visit(local, i, j, certain) for all pairs of box i of `a` and box j of `b` that touch; if
/// both are one tree, once for each pair of two of its boxes. `certain`: they overlap on every
/// axis. From several threads at once; `local` is local_of() of the thread that calls.
template <class LocalOf, class Visit>
void for_each_touching(const box_tree& a, const box_tree& b, const LocalOf& local_of,
                       const Visit& visit) {
    const bool within_one = &a == &b;
    constexpr std::size_t size = box_pack::size;
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, a.leaves().size(), 16),
        [&](const tbb::blocked_range<std::size_t>& range) {
            auto& local = local_of();
            for (std::size_t p = range.begin(); p < range.end(); ++p) {
                const box_pack& group = a.leaves()[p];
                b.find(group.hull(), within_one ? p : 0, [&](std::size_t q, pack_mask members) {
                    for_each_bit(members, [&](std::size_t j) {
                        auto [touching, overlap] = group.compare(b.leaves()[q].box(j));
                        if (within_one && p == q) touching &= (pack_mask(1) << j) - 1;
                        for_each_bit(touching, [&](std::size_t i) {
                            visit(local, size * p + i, size * q + j, (overlap >> i & 1) != 0);
                        });
                    });
                });
            }
        });
}

}  // namespace ccd
