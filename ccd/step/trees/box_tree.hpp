// A tree over boxes, eight to a node, that finds all boxes touching a given one.
//
// Boxes come in an order that keeps neighbours together. Eight consecutive boxes form a leaf, eight
// consecutive leaves a node, and so on up to one root. Nodes need no pointers, and straight loops
// compare one box with a whole node.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <type_traits>

#include "ccd/batch/first_touch.hpp"
#include "ccd/batch/threads.hpp"

namespace ccd::detail {

/// A closed box with finite coordinates.
template <class Real>
struct box {
    std::array<Real, 3> low, high;
};

/// Bit i represents box i of a pack.
using pack_mask = std::uint32_t;

template <class Mask, class Visit>
void for_each_bit(Mask mask, const Visit& visit) {
    for (; mask != 0; mask &= mask - 1) visit(static_cast<std::size_t>(std::countr_zero(mask)));
}

/// Up to eight boxes in columns; unused ones touch nothing. Uses vector types of GCC and clang,
/// because not all plain loops were vectorised.
template <class Real>
class box_pack {
  public:
    static constexpr std::size_t size = 8;

    box_pack() {
        constexpr Real infinity = std::numeric_limits<Real>::infinity();
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t part = 0; part < parts; ++part) {
                low_[k][part] = reals{} + infinity;
                high_[k][part] = reals{} - infinity;
            }
    }

    void set(std::size_t i, const box<Real>& b) {
        for (std::size_t k = 0; k < 3; ++k) {
            low_[k][i / width][i % width] = b.low[k];
            high_[k][i / width][i % width] = b.high[k];
        }
    }

    box<Real> operator[](std::size_t i) const {
        box<Real> b;
        for (std::size_t k = 0; k < 3; ++k) {
            b.low[k] = low_[k][i / width][i % width];
            b.high[k] = high_[k][i / width][i % width];
        }
        return b;
    }

    box<Real> hull() const {
        box<Real> all = (*this)[0];
        for (std::size_t i = 1; i < size; ++i) {
            const box<Real> b = (*this)[i];
            for (std::size_t k = 0; k < 3; ++k) {
                all.low[k] = std::min(all.low[k], b.low[k]);
                all.high[k] = std::max(all.high[k], b.high[k]);
            }
        }
        return all;
    }

    pack_mask touching(const box<Real>& b) const {
        return mask_of([&](std::size_t part) {
            lanes found = lanes{} - 1;
            for (std::size_t k = 0; k < 3; ++k)
                found &= (low_[k][part] <= b.high[k]) & (high_[k][part] >= b.low[k]);
            return found;
        });
    }

    /// Returns the boxes that touch b, no bound of which equals the opposite bound of b.
    pack_mask overlapping(const box<Real>& b) const {
        return mask_of([&](std::size_t part) {
            lanes found = lanes{} - 1;
            for (std::size_t k = 0; k < 3; ++k)
                found &= (low_[k][part] < b.high[k]) & (high_[k][part] > b.low[k]);
            return found;
        });
    }

  private:
    using lane = std::conditional_t<sizeof(Real) == 4, std::int32_t, std::int64_t>;
    static constexpr std::size_t vector_bytes = 16;  // available on every processor
    static constexpr std::size_t width = vector_bytes / sizeof(Real), parts = size / width;
    typedef Real reals __attribute__((vector_size(vector_bytes)));
    typedef lane lanes __attribute__((vector_size(vector_bytes)));

    /// Collects the lanes of lanes_of(0), lanes_of(1), ... that are -1 rather than 0 as bits.
    template <class LanesOf>
    static pack_mask mask_of(const LanesOf& lanes_of) {
        lanes bits, found{};
        for (std::size_t i = 0; i < width; ++i) bits[i] = lane(1) << i;
        for (std::size_t part = 0; part < parts; ++part, bits <<= width)
            found |= lanes_of(part) & bits;
        lane mask = 0;
        for (std::size_t i = 0; i < width; ++i) mask |= found[i];
        return static_cast<pack_mask>(mask);
    }

    reals low_[3][parts], high_[3][parts];
};

template <class Real>
class box_tree {
  public:
    using pack = box_pack<Real>;

    /// Builds the tree over box_of(0), ..., box_of(count - 1). Cost: O(count), on all threads of
    /// the arena. Memory, reused: 27.5 bytes a box for floats, 55 for doubles.
    template <class BoxOf>
    void build(std::size_t count, const BoxOf& box_of) {
        levels_ = 0;
        std::size_t packs = 0, in_level = count;
        do {
            in_level = (in_level + pack::size - 1) / pack::size;
            level_start_[levels_++] = packs;
            packs += in_level;
        } while (in_level > 1);
        level_start_[levels_] = packs;
        packs_.resize(packs);

        fill(0, count, box_of);
        for (std::size_t level = 1; level < levels_; ++level) {
            const pack* below = &packs_[level_start_[level - 1]];
            fill(level, level_start_[level] - level_start_[level - 1],
                 [below](std::size_t i) { return below[i].hull(); });
        }
    }

    /// Leaf p holds boxes 8 p to 8 p + 7.
    std::span<const pack> leaves() const { return {packs_.data(), level_start_[1]}; }

    /// The sum of the leaves' lengths along the axes; 0 if there is only one leaf. A good order
    /// keeps it small.
    double length_of_leaves() const {
        double sum = 0;
        if (levels_ < 2) return sum;
        const pack* hulls = &packs_[level_start_[1]];
        for (std::size_t leaf = 0; leaf < level_start_[1]; ++leaf) {
            const box<Real> b = hulls[leaf / pack::size][leaf % pack::size];
            for (std::size_t k = 0; k < 3; ++k) sum += double(b.high[k]) - double(b.low[k]);
        }
        return sum;
    }

    /// Calls visit(i) for every box i with holds(box). Precondition: holds is then true for every
    /// box that contains it.
    template <class Holds, class Visit>
    void find_where(const Holds& holds, const Visit& visit) const {
        const auto members_of = [&](const pack& boxes) {
            pack_mask members = 0;
            for (std::size_t i = 0; i < pack::size; ++i) {
                const box<Real> b = boxes[i];
                const bool is_used = b.low[0] <= b.high[0];
                members |= pack_mask(is_used && holds(b)) << i;
            }
            return members;
        };
        descend(0, members_of, [&](std::size_t leaf, pack_mask members) {
            for_each_bit(members, [&](std::size_t i) { visit(pack::size * leaf + i); });
        });
    }

    /// Calls visit(p, members) for every leaf p >= first with members that touch b.
    template <class Visit>
    void find(const box<Real>& b, std::size_t first, const Visit& visit) const {
        descend(
            first, [&](const pack& boxes) { return boxes.touching(b); }, visit);
    }

  private:
    struct node {
        std::size_t level, position;
    };
    /// Eight to the power of 11 exceeds the number of indices.
    static constexpr std::size_t max_levels = 11;
    static constexpr std::size_t pack_bits = std::countr_zero(pack::size);

    /// Calls visit(p, members) for every leaf p >= first with members. `members_of` selects boxes
    /// of leaves and nodes.
    template <class MembersOf, class Visit>
    void descend(std::size_t first, const MembersOf& members_of, const Visit& visit) const {
        if (packs_.empty()) return;
        std::array<node, pack::size * max_levels> open;
        std::size_t opened = 0;
        open[opened++] = {levels_ - 1, 0};
        while (opened > 0) {
            const node n = open[--opened];
            const pack_mask members = members_of(packs_[level_start_[n.level] + n.position]);
            if (n.level == 0) {
                if (members != 0) visit(n.position, members);
                continue;
            }
            const std::size_t first_child = first >> (pack_bits * (n.level - 1));
            for_each_bit(members, [&](std::size_t i) {
                const std::size_t child = pack::size * n.position + i;
                if (child >= first_child) open[opened++] = {n.level - 1, child};
            });
        }
    }

    template <class BoxOf>
    void fill(std::size_t level, std::size_t count, const BoxOf& box_of) {
        const std::size_t start = level_start_[level];
        for_each_range(level_start_[level + 1] - start, 128,
                       [&](std::size_t begin, std::size_t end) {
                           for (std::size_t p = begin; p < end; ++p) {
                               pack boxes;
                               for (std::size_t i = p * pack::size;
                                    i < std::min(count, (p + 1) * pack::size); ++i)
                                   boxes.set(i % pack::size, box_of(i));
                               packs_[start + p] = boxes;
                           }
                       });
    }

    first_touch_vector<pack> packs_;  ///< the leaves, the nodes above them, ..., the root
    std::array<std::size_t, max_levels + 1> level_start_{};
    std::size_t levels_ = 0;
};

/// Calls visit(local, i, j, certain) for all pairs of box i of `a` and box j of `b` that touch. If
/// both are one tree, visits each pair once. `certain`: no bound of one equals
/// the opposite bound of the other, so boxes before rounding touch, too. Calls come from
/// several threads at once; `local` is local_of() of the calling thread.
template <class Real, class LocalOf, class Visit>
void for_each_touching(const box_tree<Real>& a, const box_tree<Real>& b, const LocalOf& local_of,
                       const Visit& visit) {
    const bool within_one = &a == &b;
    constexpr std::size_t size = box_pack<Real>::size;
    constexpr std::uint64_t below_diagonal = [] {
        std::uint64_t mask = 0;
        for (std::size_t j = 0; j < size; ++j) mask |= ((std::uint64_t(1) << j) - 1) << (size * j);
        return mask;
    }();
    for_each_range(a.leaves().size(), 16, [&](std::size_t begin, std::size_t end) {
        auto& local = local_of();
        for (std::size_t p = begin; p < end; ++p) {
            const box_pack<Real>& group = a.leaves()[p];
            b.find(group.hull(), within_one ? p : 0, [&](std::size_t q, pack_mask members) {
                // Bit size j + i: box i of the group and box j of leaf q.
                std::uint64_t touching = 0, certain = 0;
                for_each_bit(members, [&](std::size_t j) {
                    const box<Real> member = b.leaves()[q][j];
                    touching |= std::uint64_t(group.touching(member)) << (size * j);
                    certain |= std::uint64_t(group.overlapping(member)) << (size * j);
                });
                if (within_one && p == q) touching &= below_diagonal;
                for_each_bit(touching, [&](std::size_t bit) {
                    visit(local, size * p + bit % size, size * q + bit / size,
                          (certain >> bit & 1) != 0);
                });
            });
        }
    });
}

}  // namespace ccd::detail
