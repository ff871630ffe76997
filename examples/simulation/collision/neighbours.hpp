// What lies next to a vertex or an edge of the surfaces: whether a nearest point of a feature is
// one of the surface around it, too.
//
// Of a point above the inside of a triangle, a nearest point of the next triangle is on the edge
// between the two, and a contact there has a normal that leans: on a flat floor whatever slides
// towards an edge would be held back by it. The surface is nearer elsewhere, where there is a
// contact with the right normal.
#pragma once

#include <ccd/mesh.hpp>
#include <map>
#include <span>
#include <vector>

#include "examples/simulation/bodies/positions.hpp"

namespace simulation {

class neighbours {
  public:
    neighbours(const std::vector<ccd::face>& faces, const std::vector<ccd::edge>& edges,
               std::size_t vertices);

    /// Of the feature with these vertices (1: a vertex, 2: an edge, 3: a face) inside which `on`
    /// is: whether no direction along the surface from there leads towards `from`, a point of
    /// `other`. In a fold directions lead to where features share vertices and are no pairs: those
    /// towards vertices next to `other` do not count.
    bool nearest_of_surface(std::span<const vertex_index> feature, const vec3& on, const vec3& from,
                            std::span<const vertex_index> other, const rows& positions) const;

  private:
    bool next_to(vertex_index v, std::span<const vertex_index> feature) const;
    std::span<const vertex_index> around(std::span<const vertex_index> feature) const;

    std::vector<std::vector<vertex_index>> of_vertex_;        ///< the other ends of its edges
    std::map<ccd::edge, std::vector<vertex_index>> of_edge_;  ///< its faces' third vertices
};

}  // namespace simulation
