// The part of a mesh that a rank is given, and the mesh that meets its region.
#pragma once

#include <array>
#include <ccd/mpi.hpp>
#include <ccd/step.hpp>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "ccd/mpi/checks.hpp"
#include "ccd/mpi/decomposition.hpp"
#include "ccd/mpi/exchange.hpp"

namespace ccd::mpi::detail {

/// The faces, edges and single vertices (those without an element) of a part, with their swept
/// boxes.
class given_elements {
  public:
    given_elements(const mesh_part& mesh, const pair_distances& distances, bool skip_unused);

    /// Boxes of faces, then edges, then single vertices.
    std::span<const swept_box> boxes() const { return boxes_; }
    std::span<const vertex_index> single_vertices() const { return single_vertices_; }

  private:
    std::vector<vertex_index> single_vertices_;
    std::vector<swept_box> boxes_;
};

class local_mesh {
  public:
    /// Sends elements to the ranks whose regions their boxes meet. Collective. Throws
    /// std::invalid_argument on all ranks if copies of a vertex differ.
    local_mesh(exchanger& ranks, const mesh_part& mesh, const given_elements& given,
               const decomposition& parts, const vertex_lists& of_vertices);

    /// The number of received faces and edges, each copy counted, and single vertices.
    std::size_t elements() const { return elements_; }
    vertex_number number(vertex_index v) const { return numbers_[v]; }
    std::size_t vertices() const { return numbers_.size(); }
    std::optional<vertex_index> find(vertex_number number) const;
    vertex_rows way() const { return {before_, after_}; }
    int island(vertex_index v) const { return islands_.empty() ? 0 : islands_[v]; }

    mesh_steps steps() const { return {faces_, edges_, numbers_.size()}; }
    pair_filter filter(const space_region& part, const pair_filter& given) const;
    pair_distances distances(const pair_distances& given) const { return {given.all, thickness_}; }

    /// The lowest rank that has the vertex.
    std::size_t owner(vertex_index v) const { return owner_of_vertex_[v]; }
    /// For each pair, the lowest rank that has the first element.
    template <class Pair>
    std::vector<std::size_t> owners(const std::vector<Pair>& pairs) const;

  private:
    struct sent_vertex {
        vertex_number number;
        std::array<double, 3> before, after;
    };
    using sent_face = std::array<vertex_number, 3>;
    using sent_edge = std::array<vertex_number, 2>;
    /// Indices into the given lists of the elements to send to each rank.
    struct routes {
        std::vector<std::vector<vertex_index>> vertices, faces, edges;
    };

    static routes routes_of(std::size_t ranks, const mesh_part& mesh, const given_elements& given,
                            const decomposition& parts);
    struct received_lists {
        received<int> groups;
        received<std::uint8_t> pinned;
        received<double> thickness;
        received<int> islands;
    };
    void keep_vertices(const received<sent_vertex>& sent, const received_lists& of_vertices);
    template <std::size_t N>
    std::vector<std::array<vertex_index, N>> by_index(
        const received<std::array<vertex_number, N>>& sent) const;

    std::vector<vertex_number> numbers_;  ///< ascending
    std::vector<std::size_t> owner_of_vertex_;
    std::vector<point<double>> before_, after_;
    std::vector<int> groups_;
    std::vector<std::uint8_t> pinned_;
    std::vector<double> thickness_;
    std::vector<int> islands_;
    std::vector<face> faces_;
    std::vector<edge> edges_;
    std::vector<std::size_t> owner_of_face_, owner_of_edge_;
    std::size_t elements_ = 0;
};

}  // namespace ccd::mpi::detail
