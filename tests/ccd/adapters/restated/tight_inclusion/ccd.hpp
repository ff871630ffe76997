// The types of Tight-Inclusion's calls that its adapter imitates, of its builds in double and in
// single precision.
#pragma once

#include <Eigen/Core>

namespace ticcd {

enum class CCDRootFindingMethod { DEPTH_FIRST_SEARCH, BREADTH_FIRST_SEARCH };

/// vertexFaceCCD and edgeEdgeCCD: eight positions, those at t0 first; err, ms, toi, tolerance,
/// t_max, max_itr, output_tolerance, no_zero_toi, ccd_method.
template <class Scalar, class Method = CCDRootFindingMethod,
          class Vector3 = Eigen::Matrix<Scalar, 3, 1>>
using call = bool(const Vector3&, const Vector3&, const Vector3&, const Vector3&, const Vector3&,
                  const Vector3&, const Vector3&, const Vector3&, const Eigen::Array<Scalar, 3, 1>&,
                  const Scalar, Scalar&, const Scalar, const Scalar, const long, Scalar&, bool,
                  const Method);

}  // namespace ticcd
