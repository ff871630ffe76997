// The search for candidates: pairs that share no vertex and whose swept boxes touch.
#pragma once

#include <array>
#include <ccd/mesh.hpp>
#include <ccd/step.hpp>
#include <cstddef>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "ccd/step/box_tree.hpp"
#include "ccd/step/extents_tree.hpp"
#include "ccd/step/swept_boxes.hpp"
#include "ccd/step/vertex_order.hpp"

namespace ccd::detail {

class pair_test;

/// Elements of N vertices in an order that gathers neighbours, which stays from step to step as
/// long as it does.
template <std::size_t N>
class ordered_elements {
  public:
    static constexpr std::size_t vertices = N;

    ordered_elements() = default;
    explicit ordered_elements(std::vector<std::array<vertex_index, N>> elements)
        : elements_(std::move(elements)) {}

    std::size_t size() const { return elements_.size(); }
    const std::array<vertex_index, N>& operator[](std::size_t i) const { return elements_[i]; }
    operator std::span<const std::array<vertex_index, N>>() const { return elements_; }

    /// Makes `tree` one over them by calling build(), after sort(elements) where they are in no
    /// good order.
    template <class Real, class Tree, class Sort, class Build>
    void build_tree(const Tree& tree, const Sort& sort, const Build& build);

  private:
    std::vector<std::array<vertex_index, N>> elements_;
    bool ordered_ = false, by_doubles_ = false;
    /// Of a tree's leaves since they were sorted; unknown where there was none yet.
    std::optional<double> least_of_boxes_, least_of_extents_;
};

/// Of one mesh, from step to step. Working memory: about 40 bytes a face or 44 an edge, whichever
/// is more, and 18 a vertex, twice as much where floats do not do, or for close pairs 187, 191 and
/// 183; and 32 KB a thread; kept.
class candidate_search {
  public:
    /// Indices must be in range.
    candidate_search(std::span<const face> faces, std::span<const edge> edges,
                     std::size_t vertices);

    /// In the plane: every vertex with every edge, and every two points.
    static candidate_search in_plane(std::span<const edge> edges, std::size_t vertices);

    std::size_t vertices() const { return vertex_count_; }
    bool is_in_plane() const { return in_plane_; }

    /// What is handed out: all candidates, or of vertex/face and edge/edge pairs only those that no
    /// axis separates as floats tell, where that was found out. The latter know no distances.
    enum class wanted : bool { candidates, close_pairs };

    /// Hands pairs of the kinds that have a visitor to it, each once, as candidate_visitor tells.
    /// Positions must be finite, distances valid. Returns how many.
    pair_counts find(const batch_positions& positions, const step_options& options,
                     const candidate_visitor& visitor, wanted pairs = wanted::candidates);

  private:
    template <class Real>
    struct tree_pair {
        box_tree<Real> first, second;
    };
    struct question {
        const swept_boxes& boxes;
        const pair_test* filter;  // null: all pass
        const candidate_visitor& visitor;
        const stop_query& stop;
        const float* rounded;
        const search_kernels* close;  // null: all candidates
    };

    struct extents_trees {
        extents_tree first, second;
    };

    /// Sorts elements by the order of the vertices, with cells as elements of the sample ask for.
    template <class Real, std::size_t N>
    auto sorting(const swept_boxes& boxes, const ordered_elements<N>& sample);
    template <kind K, class First, class Second>
    std::size_t find_kind(const question& asked, First& first, Second& second);
    template <kind K, class Real, class First, class Second>
    std::size_t find_by(tree_pair<Real>& trees, const question& asked, First& first,
                        Second& second);
    template <kind K, class First, class Second>
    std::size_t find_close(const question& asked, First& first, Second& second);

    /// Removes the unused vertices from the search, or adds them again.
    void skip_unused(bool skip);

    std::size_t vertex_count_;
    std::vector<vertex_index> unused_;
    bool skips_unused_ = false;
    vertex_order order_;
    ordered_elements<1> vertices_, points_;
    ordered_elements<2> edges_, rods_;
    ordered_elements<3> faces_;
    tree_pair<float> in_floats_;
    tree_pair<double> in_doubles_;
    extents_trees of_extents_;
    bool in_plane_ = false;
};

}  // namespace ccd::detail
