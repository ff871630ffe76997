// Shapes to make bodies of: triangle meshes and tetrahedra, in metres.
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

/// (columns + 1)·(rows + 1) points of a map from [0, 1]² to space, two triangles a cell, diagonals
/// in turns. Closed: the last column is the first.
surface_shape grid(int columns, int rows, const std::function<vec3(double, double)>& place,
                   bool closed = false);
/// A square in the plane z = height with its centre above the origin.
surface_shape square(int cells, double side, double height);
/// A sphere of 20·4^refinements triangles.
surface_shape sphere(int refinements, double radius, const vec3& centre);
/// The points within a radius of a segment, of as many triangles.
surface_shape capsule(int refinements, double radius, const vec3& from, const vec3& to);
/// A surface of revolution about z, from a curve of (radius, z); open at its ends.
surface_shape revolved(const std::vector<std::array<double, 2>>& profile, int segments);
/// A block of cells, of five tetrahedra each, in turns, so that they fit; of those cells alone that
/// `keep`, by its place, lets stay.
solid_shape block(const std::array<int, 3>& cells, const vec3& from, const vec3& to,
                  const std::function<bool(int, int, int)>& keep = {});
/// A closed cone: a polygon of `sides` about `base`, and an apex.
surface_shape spike(int sides, double radius, const vec3& base, const vec3& apex);
/// Straight, of so many edges.
rows line(int edges, const vec3& from, const vec3& to);

void translate(rows& points, const vec3& by);

}  // namespace simulation
