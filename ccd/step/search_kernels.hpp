// Builds and searches trees of extents. Internal; compiled by the rules of
// ccd/batch/batch_kernels.hpp.
#pragma once

#include <ccd/batch.hpp>
#include <ccd/kind.hpp>
#include <cstddef>
#include <optional>

#include "ccd/step/extents_pack.hpp"

namespace ccd::detail {

struct search_kernels {
    using visitor = void (*)(void* context, const element_pair* pairs, std::size_t count);

    /// Sets leaves p, first <= p < end, and their hulls. `rounded` is rounded_positions::data(), of
    /// coordinates that are off by less than `margin` (see short_way); `count` is the number of
    /// elements. If `swept`, extents at the start contain those at the end.
    using fill_leaves = void (*)(const float* rounded, float margin, bool swept,
                                 const vertex_index* elements, std::size_t count, std::size_t first,
                                 std::size_t end, extents_pack* leaves, extents* hulls,
                                 leaf_vertices* vertices);
    fill_leaves of_vertices, of_edges, of_faces;

    /// Sets packs p, first <= p < end, of the level over these hulls.
    void (*fill_nodes)(const extents* below, std::size_t count, std::size_t first, std::size_t end,
                       extents_pack* packs, extents* hulls);

    /// Finds pairs, without a common vertex, that no axis separates. They have an element in the
    /// leaves first <= p < end of `a` and one of `b`. If both are elements of one tree, the later
    /// one is second. For `at_start` and `swept`, the axis need only separate the
    /// extents at the start.
    using find_pairs = void (*)(const extents_levels& a, const extents_levels& b, std::size_t first,
                                std::size_t end, void* context, visitor visit);
    /// `of_edges_of_two_trees`, unlike the other kernels of edges, has different trees.
    find_pairs of_vertices_and_faces, of_two_edges, of_edges_of_two_trees,
        of_swept_vertices_and_faces, of_two_swept_edges, of_two_faces_at_start;
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
