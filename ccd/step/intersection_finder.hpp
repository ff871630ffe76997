// Decides which elements of a mesh at rest intersect.
#pragma once

#include <tbb/enumerable_thread_specific.h>

#include <array>
#include <ccd/intersections.hpp>
#include <ccd/mesh.hpp>
#include <optional>
#include <span>
#include <vector>

#include "ccd/step/candidate_search.hpp"
#include "ccd/step/vertex_fans.hpp"

namespace ccd::detail {

/// The vertices of an element, each once.
struct simplex_vertices {
    std::array<vertex_index, 3> vertices;
    std::size_t size = 0;

    explicit simplex_vertices(const face& element);
    const vertex_index* begin() const { return vertices.data(); }
    const vertex_index* end() const { return vertices.data() + size; }
};

/// One search for intersections. Keeps references.
class intersection_finder {
  public:
    /// Reads positions.before only.
    intersection_finder(const candidate_search& search, const vertex_rows& positions,
                        const intersection_options& options);

    /// Decides pairs without a common vertex. Thread-safe. Throws found_first if one pair suffices.
    void decide(std::span<const face> elements, std::span<const element_pair> pairs);
    /// Decides pairs with common vertices. Throws as decide.
    void decide_adjacent(const vertex_fans& fans);

    /// Precondition: no call of others is running.
    intersection_result take();

    /// Ends the search.
    struct found_first {};

  private:
    struct found_by_thread {
        std::vector<intersection> pairs;
        intersection_counts counts;
        std::vector<edge_face_pair> edge_faces;
    };

    bool may_meet(const simplex_vertices& a, const simplex_vertices& b) const;
    void decide(found_by_thread& found, const face& a, const face& b);
    void find_edges_in_faces(found_by_thread& found, const face& edges_of, const face& f) const;
    void report(found_by_thread& found, const face& a, const face& b,
                errbound::relation relation) const;
    mesh_element element_of(const face& element) const;

    const candidate_search& search_;
    vertex_rows positions_;
    const intersection_options& options_;
    bool all_pass_;
    tbb::enumerable_thread_specific<found_by_thread> found_;
};

/// Finds intersections at positions.before, in the arena of the caller. Sets `fans` if it is empty;
/// keep it for the next call. `of_step` has the positions of the last search.find(), if its trees
/// are to be used.
intersection_result find_intersections(candidate_search& search, std::optional<vertex_fans>& fans,
                                       const vertex_rows& positions,
                                       const intersection_options& options,
                                       const batch_positions* of_step = nullptr);

}  // namespace ccd::detail
