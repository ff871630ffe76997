// Inputs of whole constructions, and the same by CGAL if it is installed.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace bench {

using plane_points = std::vector<std::array<double, 2>>;
using space_points = std::vector<std::array<double, 3>>;

// Each returns the number of cells, vertices or loops. Segments are pairs of neighbours.
std::size_t cgal_delaunay3d(const space_points& points);
std::size_t cgal_arrangement(const plane_points& ends);
std::size_t cgal_intersection(const plane_points& first, const plane_points& second);

}  // namespace bench
