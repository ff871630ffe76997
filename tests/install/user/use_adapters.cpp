// The installed adapters: exits with 0 if both find a head-on vertex/face collision.
#include <ccd/adapters/ipc_toolkit.hpp>
#include <ccd/adapters/tight_inclusion.hpp>

int main() {
    const Eigen::Vector3d above(0.25, 0.25, 1), below(0.25, 0.25, -3), a(0, 0, 0), b(1, 0, 0),
        c(0, 1, 0);
    double toi = 0, other_toi = 0, tolerance = 0;
    const bool found =
        ccd::adapters::exact_narrow_phase().point_triangle_ccd(above, a, b, c, below, a, b, c, toi);
    const bool found_other = ccd::adapters::tight_inclusion::vertexFaceCCD(
        above, a, b, c, below, a, b, c, {-1, -1, -1}, 0, other_toi, 1e-6, 1, 1000, tolerance);
    return found && found_other && toi == 0.25 && other_toi == 0.25 ? 0 : 1;
}
