// Builds and searches trees of extents. Internal; compiled by the rules of
// ccd/batch/batch_kernels.hpp.
#pragma once

#include <ccd/batch.hpp>
#include <ccd/kind.hpp>
#include <cstddef>
#include <errbound/sign.hpp>
#include <optional>

#include "ccd/step/trees/extents_pack.hpp"

namespace ccd::detail {

/// Pack p of level 0 is a leaf with elements 16 p to 16 p + 15. Pack p of the level above holds
/// packs 16 p to 16 p + 15 of this one, and so on up to one root.
struct extents_levels {
    static constexpr std::size_t most = 8;  ///< 16^8 is the number of indices

    struct level {
        const extents_column* packs;
        const float* hulls;  ///< the extents of the packs
    };
    level at[most];
    std::size_t count = 0;
    std::size_t columns = 0;                  ///< of a pack, and numbers of a hull
    const leaf_vertices* vertices = nullptr;  ///< of the leaves

    const extents_column* pack(std::size_t level, std::size_t p) const {
        return at[level].packs + columns * p;
    }
    const float* hull(std::size_t level, std::size_t p) const {
        return at[level].hulls + columns * p;
    }
};

struct search_kernels {
    using visitor = void (*)(void* context, const element_pair* pairs, std::size_t count);

    /// Sets leaves p, first <= p < end, and their hulls. `rounded` is rounded_positions::data(), of
    /// coordinates that are off by less than `margin` (see short_way); `count` is the number of
    /// elements, `columns` that of a pack. If `swept`, extents at the start contain those at the
    /// end.
    using fill_leaves = void (*)(const float* rounded, float margin, bool swept,
                                 const vertex_index* elements, std::size_t count, std::size_t first,
                                 std::size_t end, std::size_t columns, extents_column* leaves,
                                 float* hulls, leaf_vertices* vertices);
    fill_leaves of_vertices, of_edges, of_faces;

    /// Sets packs p, first <= p < end, of the level over these hulls.
    void (*fill_nodes)(const float* below, std::size_t count, std::size_t first, std::size_t end,
                       std::size_t columns, extents_column* packs, float* hulls);

    /// Finds pairs, without a common vertex, that no axis separates. They have an element in the
    /// leaves first <= p < end of `a` and one of `b`. If a is b, by address, the later element is
    /// second, and each pair is found once. For `at_start` and `swept`, the axis need only separate
    /// the extents at the start.
    using find_pairs = void (*)(const extents_levels& a, const extents_levels& b, std::size_t first,
                                std::size_t end, void* context, visitor visit);
    find_pairs of_vertices_and_faces, of_two_edges, of_swept_vertices_and_faces, of_two_swept_edges,
        of_two_faces_at_start;

    /// Sets the signs of triangle_intersects_triangle (errbound/simplices/predicates.hpp) for pairs
    /// of elements at rest, or `uncertain`. `positions` are rows x y z.
    void (*triangle_signs)(const double* positions, const vertex_index* elements,
                           const element_pair* pairs, std::size_t count,
                           errbound::sign_type* signs);
};

const search_kernels& search_kernels_for(std::optional<instruction_set> set);

namespace baseline {
extern const search_kernels searching;
}
namespace avx2 {
extern const search_kernels searching;
}
namespace avx512 {
extern const search_kernels searching;
}

}  // namespace ccd::detail
