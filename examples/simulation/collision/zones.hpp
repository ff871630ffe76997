// Rigid impact zones: vertices that pairs in contact join move as one rigid body for a step.
//
// Provot, Collision and Self-Collision Handling in Cloth Model Dedicated to Design Garments, 1997;
// Bridson, Fedkiw, Anderson, Robust Treatment of Collisions, Contact and Friction for Cloth
// Animation, 2002. Zones only grow during a step.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "examples/simulation/bodies/positions.hpp"

namespace simulation {

class impact_zones {
  public:
    explicit impact_zones(std::size_t vertices);

    /// The vertices of a pair are in one zone from now on, and all that were with one of them.
    void join(std::span<const vertex_index> vertices);

    /// Every zone as a rigid body, from `before` to as near as can be, by masses, to where `after`
    /// has its vertices; or to where its driven vertices (mass 0) go, if it has any.
    void move(const std::vector<double>& masses, const rows& before, rows& after);

    /// Zones of more than one vertex.
    std::size_t count() const;

  private:
    vertex_index root_of(vertex_index v);
    std::vector<std::vector<vertex_index>> zones();

    std::vector<vertex_index> parent_;
};

}  // namespace simulation
