// Calls of Tight-Inclusion's interface, implemented by `exact`.
#include <ccd/adapters/tight_inclusion.hpp>
#include <cstdio>

namespace ticcd = ccd::adapters::tight_inclusion;

int main() {
    const ticcd::Vector3 v_t0(0.25, 0.25, 1), f0(0, 0, 0), f1(1, 0, 0), f2(0, 1, 0);
    const ticcd::Vector3 v_t1(0.25, 0.25, -1);
    const ticcd::Array3 err(-1, -1, -1);
    const double ms = 0, tolerance = 1e-6, t_max = 1;
    const long max_itr = 1000000;

    double toi, output_tolerance;
    if (ticcd::vertexFaceCCD(v_t0, f0, f1, f2, v_t1, f0, f1, f2, err, ms, toi, tolerance, t_max,
                             max_itr, output_tolerance))
        std::printf("they touch at %g\n", toi);

    // Keeps a box of 0.1 free, and so a ball of radius 0.1.
    if (ticcd::vertexFaceCCD(v_t0, f0, f1, f2, v_t1, f0, f1, f2, err, /*ms=*/0.1, toi, tolerance,
                             t_max, max_itr, output_tolerance))
        std::printf("within sqrt(3) 0.1 of each other at %.3f\n", toi);
}
