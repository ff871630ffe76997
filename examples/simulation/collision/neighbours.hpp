// Tests if a nearest point of a feature is also a nearest point of the surface. Without this test,
// a point above a triangle would also touch the next one, with an oblique normal at their common
// edge. Bodies would not slide past edges of a flat floor.
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

    /// True if no direction along the surface from `on`, a point of `feature`, leads towards
    /// `from`, a point of `other`. Ignores directions towards vertices next to `other`, as in a
    /// fold, since features that share vertices are no pairs.
    bool nearest_of_surface(std::span<const vertex_index> feature, const vec3& on, const vec3& from,
                            std::span<const vertex_index> other, const rows& positions) const;

  private:
    bool next_to(vertex_index v, std::span<const vertex_index> feature) const;
    std::span<const vertex_index> around(std::span<const vertex_index> feature) const;

    std::vector<std::vector<vertex_index>> of_vertex_;
    std::map<ccd::edge, std::vector<vertex_index>> of_edge_;
};

}  // namespace simulation
