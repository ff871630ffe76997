// Declarations of ipc-toolkit that its adapter needs: names and signatures of version 1.6. With
// RESTATED_IPC_TOOLKIT_EARLY they are those of the first version, with positions by plain
// references and without conservative_rescaling.
#pragma once

#include <Eigen/Core>

namespace ipc {

using VectorMax3d = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 3, 1>;

#ifdef RESTATED_IPC_TOOLKIT_EARLY
template <class Vector>
using restated_position = const Vector&;
#else
template <class Vector>
using restated_position = const Eigen::Ref<const Vector>&;
#endif

class NarrowPhaseCCD {
    using any = restated_position<VectorMax3d>;
    using in_space = restated_position<Eigen::Vector3d>;

  public:
    NarrowPhaseCCD() = default;
    virtual ~NarrowPhaseCCD() = default;

    virtual bool point_point_ccd(any p0_t0, any p1_t0, any p0_t1, any p1_t1, double& toi,
                                 const double min_distance = 0, const double tmax = 1) const = 0;
    virtual bool point_edge_ccd(any p_t0, any e0_t0, any e1_t0, any p_t1, any e0_t1, any e1_t1,
                                double& toi, const double min_distance = 0,
                                const double tmax = 1) const = 0;
    virtual bool point_triangle_ccd(in_space p_t0, in_space t0_t0, in_space t1_t0, in_space t2_t0,
                                    in_space p_t1, in_space t0_t1, in_space t1_t1, in_space t2_t1,
                                    double& toi, const double min_distance = 0,
                                    const double tmax = 1) const = 0;
    virtual bool edge_edge_ccd(in_space ea0_t0, in_space ea1_t0, in_space eb0_t0, in_space eb1_t0,
                               in_space ea0_t1, in_space ea1_t1, in_space eb0_t1, in_space eb1_t1,
                               double& toi, const double min_distance = 0,
                               const double tmax = 1) const = 0;

#ifndef RESTATED_IPC_TOOLKIT_EARLY
    double conservative_rescaling;
#endif
};

}  // namespace ipc
