// Shapes of bodies: triangle meshes and tetrahedra, in metres.
#pragma once

#include <array>
#include <ccd/mesh.hpp>
#include <functional>
#include <vector>

#include "examples/simulation/bodies/positions.hpp"

namespace simulation {

struct surface_shape {
    rows points;
    std::vector<ccd::face> faces;
};
struct solid_shape {
    rows points;
    std::vector<std::array<vertex_index, 4>> tetrahedra;
};

/// Maps (columns + 1)·(rows + 1) points of [0, 1]² to space, with two triangles per cell and
/// alternating diagonals. `closed`: the last column is the first.
surface_shape grid(int columns, int rows, const std::function<vec3(double, double)>& place,
                   bool closed = false);
/// A square in the plane z = height with its centre above the origin.
surface_shape square(int cells, double side, double height);
surface_shape sphere(int refinements, double radius, const vec3& centre);
/// The surface at a radius from a segment, of 20·4^refinements triangles.
surface_shape capsule(int refinements, double radius, const vec3& from, const vec3& to);
/// A surface of revolution about z, from a curve of (radius, z). It is open at its ends.
surface_shape revolved(const std::vector<std::array<double, 2>>& profile, int segments);
/// The cells with keep(i, j, k), of five tetrahedra each, mirrored alternately so that they fit.
solid_shape block(const std::array<int, 3>& cells, const vec3& from, const vec3& to,
                  const std::function<bool(int, int, int)>& keep = {});
surface_shape spike(int sides, double radius, const vec3& base, const vec3& apex);
rows line(int edges, const vec3& from, const vec3& to);

void translate(rows& points, const vec3& by);

}  // namespace simulation
