// What a step's search compares: extents of elements along nine axes at both ends of the step, of
// sixteen elements side by side. Internal; kernels of all instruction sets share it.
//
// An axis that separates two elements the same way at both ends separates them throughout, the
// motion being linear. The same holds of groups of elements, whose extents are around theirs. So a
// tree of such packs finds, without a list of candidates, the pairs that no axis separates.
//
// Axes are x, y, z, x ± y, y ± z and z ± x of coordinates rounded to float (ccd/batch/
// rounded_axes.hpp). Along the first three rounding keeps the order: extents that do not meet prove
// that the exact ones do not. Sums and differences are off by 4.04ε, ε = 2^-23, and a margin of 7ε
// is added outwards, whose own rounding loses 2.04ε: extents hold the exact ones.
// Proof: proofs/Extents.v, coordinate_extents_hold, diagonal_extents_hold, group_extents_hold,
// apart_face_separate, apart_edges_separate.
#pragma once

#include <ccd/kind.hpp>
#include <cstddef>
#include <limits>

namespace ccd::detail {

/// Along each of nine axes: the least at the start and at the end of the step, the most at both.
struct extents {
    static constexpr std::size_t axes = 9, columns = 4 * axes;
    /// What is added outwards along x ± y, y ± z and z ± x.
    static constexpr float margin = 7 * std::numeric_limits<float>::epsilon();

    float of[columns];
};

/// Those of sixteen elements or groups, side by side.
struct extents_pack {
    static constexpr std::size_t size = 16;

    alignas(64) float at[extents::columns][size];
};

/// The vertices of a leaf's elements, side by side; elements of fewer leave rows unset.
struct leaf_vertices {
    alignas(64) vertex_index at[3][extents_pack::size];
};

/// A tree as kernels see it. Pack p of level 0 holds elements 16 p to 16 p + 15 and is a leaf; pack
/// p of the level above holds packs 16 p to 16 p + 15 of this one, and so on up to one root.
struct extents_levels {
    static constexpr std::size_t most = 8;  ///< 16^8 is the number of indices

    struct level {
        const extents_pack* packs;
        const extents* hulls;  ///< of the packs
    };
    level at[most];
    std::size_t count = 0;
    const leaf_vertices* vertices = nullptr;  ///< of the leaves
};

/// Positions of elements in a tree.
struct element_pair {
    unsigned first, second;
};

}  // namespace ccd::detail
