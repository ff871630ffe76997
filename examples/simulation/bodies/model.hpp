// A simulated model: vertices with masses, surfaces that collide, and elastic terms.
// Units: metres, kilograms, seconds. A vertex of mass 0 is driven: the scene moves it.
#pragma once

#include <array>
#include <ccd/mesh.hpp>
#include <cstddef>
#include <vector>

#include "examples/simulation/bodies/positions.hpp"

namespace simulation {

/// An elastic term of projective dynamics: weight/2 · |G x − P(G x)|². G x is `columns` vectors,
/// each a combination of vertices, and P projects to the rest set of the term.
struct elastic_term {
    enum class target {
        singular_values,  ///< P clamps those of the 3 by `columns` matrix G x to [low, high]
        length,           ///< P clamps the length of the one vector to [low, high]
    };
    target kind;
    int columns;
    int vertices;
    std::array<vertex_index, 4> vertex;              ///
    std::array<std::array<double, 3>, 4> gradients;  ///< G: one factor per vertex and column
    double weight;                                   ///< in newtons per metre, or joules
    double low, high;
};

struct cloth_material {
    double density = 0.2;            ///< kg/m²
    double membrane = 200;           ///< N/m, against stretch and shear
    double bending = 2e-5;           ///< N m
    double strain_limit = 0.05;      ///< `limit_stiffness` acts beyond this stretch
    double limit_stiffness = 20000;  ///< N/m
};

struct solid_material {
    double density = 1000;   ///< kg/m³
    double stiffness = 1e5;  ///< N/m²; co-rotated
};

struct rod_material {
    double density = 0.05;    ///< kg/m
    double stretching = 2e4;  ///< N
    double bending = 1e-3;    ///< N m²
};

struct model {
    rows start;
    std::vector<double> mass;  ///< of each vertex; 0: driven
    std::vector<ccd::face> faces;
    std::vector<ccd::edge> edges;
    std::vector<elastic_term> terms;
    std::vector<int> body;  ///< of each vertex: the index of the call that added it

    std::size_t vertices() const { return mass.size(); }
    bool driven(std::size_t v) const { return mass[v] == 0; }

    /// These add a body at rest in this shape and return its first vertex.
    vertex_index add_cloth(const rows& shape, const std::vector<ccd::face>& triangles,
                           const cloth_material& material);
    vertex_index add_solid(const rows& shape,
                           const std::vector<std::array<vertex_index, 4>>& tetrahedra,
                           const solid_material& material);
    vertex_index add_rod(const rows& points, const rod_material& material);
    vertex_index add_obstacle(const rows& shape, const std::vector<ccd::face>& triangles);
    void pin(vertex_index v) { mass[v] = 0; }

    ccd::mesh surface(const rows& positions) const;

  private:
    vertex_index append(const rows& shape);
    void add_bending(const std::vector<ccd::face>& triangles, vertex_index first, double stiffness);
};

}  // namespace simulation
