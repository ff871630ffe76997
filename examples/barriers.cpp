// Barriers: a bead falls on a face and comes to rest above it, on a barrier within d_hat. Each step
// keeps a tenth of the gap.
#include <algorithm>
#include <ccd/advance.hpp>
#include <cmath>
#include <cstdio>

namespace {

constexpr double d_hat = 0.1, stiffness = 10, gravity = 1;

/// Slope and curvature of gravity·d and, below d_hat, -stiffness (d - d_hat)² log(d / d_hat).
struct derivatives {
    double first = gravity, second = 0;
};
derivatives at_gap(double d) {
    if (d >= d_hat) return {};
    const double e = d - d_hat, l = std::log(d / d_hat);
    return {gravity - stiffness * (2 * e * l + e * e / d),
            -stiffness * (2 * l + 4 * e / d - e * e / (d * d))};
}

}  // namespace

int main() {
    ccd::mesh now{{{-1, -1, 0}, {2, -1, 0}, {-1, 2, 0}, {0, 0, 1}}, {{0, 1, 2}}};
    ccd::mesh_steps steps(now);
    for (int iteration = 1; iteration <= 30; ++iteration) {
        const double gap = now.vertices[3].z;
        // A step without motion finds the pairs that have a barrier.
        const ccd::pair_lists near = steps.run({now, now}, {.distances = {d_hat}}).pairs;

        ccd::mesh goal = now;
        const derivatives of = near.vertex_face.empty() ? derivatives() : at_gap(gap);
        goal.vertices[3].z -= of.second > 0 ? of.first / of.second : of.first;
        const ccd::advance_result free =
            ccd::advance(steps, {now, goal}, {.distances = {0.1 * gap}});
        now.vertices = free.positions;
        if (iteration % 5 == 0 || iteration < 4)
            std::printf("iteration %d: gap %.12g, by %.3g of the step\n", iteration,
                        now.vertices[3].z, free.fraction);
    }
    return std::abs(at_gap(now.vertices[3].z).first) < 1e-9 ? 0 : 1;
}
