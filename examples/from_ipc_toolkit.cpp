// ipc-toolkit's narrow phase by `exact`: the step size of a vertex that falls towards a triangle.
// Tests build it with a copy of the interface.
#include <ccd/adapters/ipc_toolkit.hpp>  // includes your <ipc/ccd/narrow_phase_ccd.hpp>
#include <cstdio>

namespace {

/// Calls the narrow phase as the toolkit's compute_collision_free_stepsize does.
double step_size(const ipc::NarrowPhaseCCD& narrow_phase, const Eigen::Vector3d& before,
                 const Eigen::Vector3d& after, double min_distance) {
    const Eigen::Vector3d t0(0, 0, 0), t1(1, 0, 0), t2(0, 1, 0);
    double toi = 1;
    const bool collides = narrow_phase.point_triangle_ccd(before, t0, t1, t2, after, t0, t1, t2,
                                                          toi, min_distance, /*tmax=*/1);
    return collides ? toi : 1;
}

}  // namespace

int main() {
    const ccd::adapters::exact_narrow_phase exact;                 // steps may end in contact
    const ccd::adapters::exact_narrow_phase with_a_gap(0.8);       // keeps a fifth of each distance
    const ccd::adapters::exact_narrow_phase small_gap(0.8, 1e-4);  // a fifth, but at most 1e-4

    const Eigen::Vector3d before(0.25, 0.25, 1), after(0.25, 0.25, -1);
    std::printf("until they touch: %g\n", step_size(exact, before, after, 0));
    std::printf("until they are 0.5 apart: %g\n", step_size(exact, before, after, 0.5));
    std::printf("with a fifth of the distance left: %g\n", step_size(with_a_gap, before, after, 0));
    std::printf("with 1e-4 left: %g\n", step_size(small_gap, before, after, 0));
}
