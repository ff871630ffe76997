// Extents of sixteen elements in columns, along nine axes at one or both ends of the step.
// Internal; kernels of all instruction sets share it.
//
// An axis that separates two elements, or groups of elements, in the same order at both ends does
// so throughout. So a tree of such packs finds the pairs that no axis separates without a list of
// candidates.
//
// Axes: x, y, z, x ± y, y ± z, z ± x of coordinates rounded to float (ccd/batch/rounded_axes.hpp).
// Along x, y and z rounding keeps the order. Sums and differences are off by 4.04ε, ε = 2^-23; a
// margin of 7ε outwards, which loses 2.04ε to rounding, makes extents contain the exact ones.
// Proof: proofs/filters/Extents.v, coordinate_extents_hold, diagonal_extents_hold,
// group_extents_hold, apart_face_separate, apart_edges_separate.
#pragma once

#include <ccd/kind.hpp>
#include <cstddef>
#include <limits>

namespace ccd::detail {

/// The columns of elements, or of packs: least and most along each of nine axes at the start of the
/// step, then the same at its end, unless elements are at rest.
struct extents {
    static constexpr std::size_t axes = 9, columns_of_end = 2 * axes;
    /// The margin outwards along x ± y, y ± z and z ± x.
    static constexpr float margin = 7 * std::numeric_limits<float>::epsilon();
};

/// One number for each of the sixteen members of a pack.
struct extents_column {
    static constexpr std::size_t size = 16;

    alignas(64) float at[size];
};

/// One column for each element of a leaf. Elements with fewer vertices leave rows unset.
struct leaf_vertices {
    alignas(64) vertex_index at[3][extents_column::size];
};

struct element_pair {
    unsigned first, second;
};

}  // namespace ccd::detail
