// The search for candidates: pairs whose swept boxes touch and that, except adjacent rods, share no
// vertex.
#pragma once

#include <array>
#include <ccd/mesh.hpp>
#include <ccd/step.hpp>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "ccd/step/extents_tree.hpp"
#include "ccd/step/rest/kept_positions.hpp"
#include "ccd/step/rest/vertex_fans.hpp"
#include "ccd/step/swept_boxes.hpp"
#include "ccd/step/trees/box_tree.hpp"
#include "ccd/step/vertex_order.hpp"

namespace ccd::detail {

class pair_test;

/// Elements of N vertices. Their order gathers neighbours, and is kept from step to step while it
/// is good.
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

    /// Calls build(), after sort(elements) if they have no order yet. If long leaves show that the
    /// order is no longer good, calls sort(elements) and build() again. Pass whole_way = false if
    /// t_max < 1: the leaves of such a tree do not show if the order is good for the whole step.
    template <class Real, class Tree, class Sort, class Build>
    void build_tree(const Tree& tree, bool whole_way, const Sort& sort, const Build& build);
    void forget_order() { ordered_ = false; }

  private:
    std::vector<std::array<vertex_index, N>> elements_;
    bool ordered_ = false, by_doubles_ = false;
    /// The least length_of_leaves() of the trees since the last sort.
    std::optional<double> least_of_boxes_, least_of_extents_;
};

/// The candidates to find; by default all.
struct wanted_candidates {
    /// Only for contact: the search may omit vertex/face and edge/edge pairs that an axis separates
    /// in floats. It does not always test this.
    bool close = false;
    /// The search may omit pairs that do not meet until this time.
    double t_max = 1;
    /// For t_max < 1: also pairs that may meet if each vertex goes straight to the rounded position
    /// that `between` (ccd/step/advance/advancing.hpp) returns for it. All vertices use the same
    /// fraction of the step, at most t_max.
    bool spare = false;
    /// Only some of the close pairs; none if they cannot be found in floats.
    bool sample = false;
    /// Positions with a list of active vertices, those that move in this step or did recently, or
    /// null. Close pairs without an active vertex are skipped if few elements have one: see
    /// candidate_search::skipped_rest().
    const kept_positions* kept = nullptr;
};

/// Called with blocks of pairs of these elements, from several threads at once.
using resting_visitor =
    std::function<void(std::span<const face> elements, std::span<const element_pair> pairs)>;

/// The search in one mesh. Keeps its working memory: 70 KB a thread, and about the bytes below.
/// Faces and edges use the same memory one after the other: of their two totals, the larger counts.
/// With wanted_candidates::close, half of the edges' total counts, as edges are then searched in
/// pieces. While few vertices are active, elements near them take 110 bytes more.
///
///                                    a face   an edge   a vertex
///     in floats                          40        44         18
///     if floats do not suffice           80        88         36
///     with wanted_candidates::close     187       191         18
class candidate_search {
  public:
    /// Precondition: indices are in range.
    candidate_search(std::span<const face> faces, std::span<const edge> edges,
                     std::size_t vertices);
    ~candidate_search();
    candidate_search(candidate_search&&) noexcept;

    /// Pairs are each vertex with each edge, and each two points.
    static candidate_search in_plane(std::span<const edge> edges, std::size_t vertices);

    /// Only for find_at_start(), with less memory and time for its preparation.
    static candidate_search at_start(std::span<const face> faces, std::span<const edge> edges,
                                     std::size_t vertices, bool in_plane = false);

    std::size_t vertices() const { return vertex_count_; }
    bool is_in_plane() const { return in_plane_; }

    /// Visits each pair once if its kind has a visitor. Returns the number of pairs. Preconditions:
    /// positions are finite and distances valid.
    pair_counts find(const batch_positions& positions, const step_options& options,
                     const candidate_visitor& visitor, const wanted_candidates& wanted = {});

    /// True if the last find() skipped the vertex/face and edge/edge pairs without an active
    /// vertex.
    bool skipped_rest() const { return skipped_rest_; }

    /// The trees that find_at_start may use.
    enum class trees : bool { new_ones, of_last_find };

    /// Visits each pair of resting_elements() without a common vertex once, unless an axis
    /// separates the two at t = 0. If `one_suffices` is true, pairs that probably intersect come
    /// first, and may come again. The only part of options.filter that it applies is skip_unused.
    /// `of_last_find` is only for the positions and options of the last find(); otherwise positions
    /// at t = 1 must be those at t = 0.
    void find_at_start(const batch_positions& positions, const step_options& options,
                       const resting_visitor& visit, trees from, bool one_suffices);

    void skip_unused(bool skip);
    /// Faces, edges of no face and vertices of neither, in any order. Edges {v, w, w} and vertices
    /// {v, v, v} repeat their last vertex, degenerate faces {v, v, w} the first.
    std::span<const face> resting_elements() const {
        return resting_.size() > 0 ? resting_ : faces_;
    }
    /// True for one of them if it is a vertex of no face and no edge.
    bool is_point(const face& element) const;
    bool is_rod(const face& element) const;

  private:
    class active_parts;
    template <class Real>
    struct tree_pair {
        box_tree<Real> first, second;
    };
    struct search_request {
        const swept_boxes& boxes;
        const pair_test* filter;  // null: all pairs pass
        const candidate_visitor& visitor;
        const stop_query& stop;
        const float* rounded;
        float margin;  // of `rounded`
        const search_kernels& kernels;
        const wanted_candidates& wanted;
        active_parts* active;  // null: all pairs are searched
        bool rests;            // all positions at the end are those at the start
    };

    struct extents_trees {
        extents_tree first, second;
    };

    /// Returns a function that sorts elements along a Hilbert curve (ccd/step/vertex_order.hpp).
    /// The curve's cells are about as large as the elements of `sample`.
    template <class Real, std::size_t N>
    auto sorting(const swept_boxes& boxes, const ordered_elements<N>& sample);
    template <kind K, class First, class Second>
    std::size_t find_kind(const search_request& request, First& first, Second& second);
    template <kind K, class Real, class First, class Second>
    std::size_t find_by(tree_pair<Real>& trees, const search_request& request, First& first,
                        Second& second);
    /// Visits the pairs of step_options::adjacent_rods.
    std::size_t find_adjacent_rods(const search_request& request);
    template <class Elements, class Sample>
    void improve_order(Elements& elements, const Sample& sample, const search_request& request);
    /// Adds the candidate pair_of(i, j) for each i of `elements` and j of `b` that `find` reports.
    /// Trees over the elements are built piece by piece.
    template <std::size_t N, class Blocks, class PairOf>
    void search_elements(search_kernels::find_pairs find, const search_request& request,
                         std::span<const std::array<vertex_index, N>> elements, extents_of ends,
                         const extents_tree& b, Blocks& blocks, const PairOf& pair_of);
    /// Sets active_ for these positions. Returns null if the search of all pairs pays.
    active_parts* choose_active(const kept_positions& kept, const swept_boxes& boxes,
                                const search_kernels& kernels);
    /// Only pairs with an active vertex.
    template <kind K, class First, class Second>
    std::size_t find_close_active(const search_request& request, const First& first,
                                  const Second& second);
    template <kind K, class First, class Second>
    std::size_t find_close(const search_request& request, First& first, Second& second);

    void set_resting();
    void find_resting_by_boxes(const swept_boxes& boxes, ordered_elements<3>& elements,
                               const step_options& options, const resting_visitor& visit);
    template <std::size_t N>
    void skip_in(ordered_elements<N>& set, bool skip);

    std::size_t vertex_count_;
    bool has_edges_;  ///< other than those of faces were given
    std::vector<vertex_index> unused_;
    bool skips_unused_ = false;
    vertex_order order_;
    ordered_elements<1> vertices_, points_;
    ordered_elements<2> edges_, rods_;
    ordered_elements<3> faces_;
    ordered_elements<3> resting_;  ///< empty if there are faces only
    std::vector<vertex_index> resting_points_;
    tree_pair<float> in_floats_;
    tree_pair<double> in_doubles_;
    extents_trees of_extents_;
    const void* in_second_ = nullptr;  ///< the elements of of_extents_.second
    std::unique_ptr<active_parts> active_;
    std::size_t active_searched_ = 0;  ///< elements, since the last search of all
    bool skipped_rest_ = false;
    bool in_plane_ = false;
};

/// Finds intersections at positions.before, in the arena of the caller. Sets `fans` if it is empty;
/// keep it for the next call. `of_step` has the positions of the last search.find(), if its trees
/// are to be used.
intersection_result find_intersections(candidate_search& search, std::optional<vertex_fans>& fans,
                                       const vertex_rows& positions,
                                       const intersection_options& options,
                                       const batch_positions* of_step = nullptr);

}  // namespace ccd::detail
