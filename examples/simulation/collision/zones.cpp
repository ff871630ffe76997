#include "examples/simulation/collision/zones.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <numeric>
#include <utility>

namespace simulation {
namespace {

/// x ↦ rotation (x − from) + to.
struct rigid_motion {
    Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
    vec3 from = vec3::Zero(), to = vec3::Zero();
};

/// Returns the rigid motion nearest to `after` in weighted least squares. Source: Kabsch, A
/// solution for the best rotation to relate two sets of vectors, 1976.
template <class Weight>
rigid_motion nearest_motion(std::span<const vertex_index> vertices, const Weight& weight,
                            const rows& before, const rows& after) {
    rigid_motion motion;
    double total = 0;
    for (const vertex_index v : vertices) {
        total += weight(v);
        motion.from += weight(v) * before.row(v).transpose();
        motion.to += weight(v) * after.row(v).transpose();
    }
    motion.from /= total;
    motion.to /= total;
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    for (const vertex_index v : vertices)
        covariance += weight(v) * (after.row(v).transpose() - motion.to) *
                      (before.row(v) - motion.from.transpose());
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance,
                                                Eigen::ComputeFullU | Eigen::ComputeFullV);
    // A point or a line does not determine a rotation.
    if (svd.singularValues()[1] <= 1e-12 * svd.singularValues()[0]) return motion;
    Eigen::Matrix3d u = svd.matrixU();
    if ((u * svd.matrixV().transpose()).determinant() < 0) u.col(2) = -u.col(2);
    motion.rotation = u * svd.matrixV().transpose();
    return motion;
}

}  // namespace

impact_zones::impact_zones(std::size_t vertices) : parent_(vertices) {
    std::iota(parent_.begin(), parent_.end(), vertex_index{0});
}

vertex_index impact_zones::root_of(vertex_index v) {
    while (parent_[v] != v) v = parent_[v] = parent_[parent_[v]];
    return v;
}

void impact_zones::join(std::span<const vertex_index> vertices) {
    for (const vertex_index v : vertices) parent_[root_of(v)] = root_of(vertices[0]);
}

std::vector<std::vector<vertex_index>> impact_zones::zones() {
    std::vector<std::vector<vertex_index>> of_root(parent_.size()), found;
    for (vertex_index v = 0; v < parent_.size(); ++v) of_root[root_of(v)].push_back(v);
    for (auto& zone : of_root)
        if (zone.size() > 1) found.push_back(std::move(zone));
    return found;
}

std::size_t impact_zones::count() const {
    return impact_zones(*this).zones().size();
}

void impact_zones::move(const std::vector<double>& masses, const rows& before, rows& after) {
    for (const auto& zone : zones()) {
        std::vector<vertex_index> driven;
        for (const vertex_index v : zone)
            if (masses[v] == 0) driven.push_back(v);
        const rigid_motion motion =
            driven.empty() ? nearest_motion(
                                 zone, [&](vertex_index v) { return masses[v]; }, before, after)
                           : nearest_motion(
                                 driven, [](vertex_index) { return 1.0; }, before, after);
        for (const vertex_index v : zone)
            if (masses[v] > 0)
                after.row(v) =
                    (motion.rotation * (before.row(v).transpose() - motion.from) + motion.to)
                        .transpose();
    }
}

}  // namespace simulation
