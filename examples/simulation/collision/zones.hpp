// Rigid impact zones: vertices joined by pairs in contact move as one rigid body in a step. Zones
// only grow during a step. Sources: Provot, Collision and Self-Collision Handling in Cloth Model
// Dedicated to Design Garments, 1997; Bridson, Fedkiw, Anderson, Robust Treatment of Collisions,
// Contact and Friction for Cloth Animation, 2002.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "examples/simulation/bodies/positions.hpp"

namespace simulation {

class impact_zones {
  public:
    explicit impact_zones(std::size_t vertices);

    void join(std::span<const vertex_index> vertices);

    /// Moves every zone as a rigid body from `before` as close to `after` as possible, weighted by
    /// masses. If a zone has driven vertices (mass 0), only these count.
    void move(const std::vector<double>& masses, const rows& before, rows& after);

    std::size_t count() const;

  private:
    vertex_index root_of(vertex_index v);
    std::vector<std::vector<vertex_index>> zones();

    std::vector<vertex_index> parent_;
};

}  // namespace simulation
