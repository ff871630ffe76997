#pragma once

#include <Eigen/Core>
#include <ccd/mesh.hpp>

namespace simulation {

using ccd::vertex_index;
using vec3 = Eigen::Vector3d;
/// Rows x y z, contiguous, as ccd::vertex_rows takes them.
using rows = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

}  // namespace simulation
