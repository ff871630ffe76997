// The collision handler with a custom solver, of falling particles (docs/simulation.md).
#include <cstddef>
#include <cstdio>
#include <vector>

#include "examples/simulation/bodies/shapes.hpp"
#include "examples/simulation/collision/collision_handler.hpp"

int main() {
    // A coarse fixed ball, and a square of four particles above it.
    const simulation::surface_shape ball = simulation::sphere(1, 0.5, {0, 0, 0});
    const auto first = static_cast<ccd::vertex_index>(ball.points.rows());
    simulation::rows positions(first + 4, 3);
    positions.topRows(first) = ball.points;
    positions.bottomRows(4) << -0.4, -0.4, 0.6, 0.4, -0.4, 0.6, 0.4, 0.4, 0.6, -0.4, 0.4, 0.6;
    std::vector<ccd::face> faces = ball.faces;
    faces.push_back({first, first + 1, first + 2});
    faces.push_back({first, first + 2, first + 3});
    std::vector<double> masses(first, 0.0);  // 0: responses do not move it
    masses.insert(masses.end(), 4, 0.1);
    const std::vector<int> bodies = ccd::connected_parts(faces, {}, masses.size());

    constexpr double h = 0.01;
    simulation::collision_handler collisions(faces, {}, masses, bodies, h, {.thickness = 1e-3});
    const simulation::particle_compliance particles(masses, h);
    simulation::rows velocities = simulation::rows::Zero(positions.rows(), 3);
    std::size_t passed_through = 0;
    for (int frame = 0; frame < 100; ++frame) {
        velocities.bottomRows(4).col(2).array() -= 9.81 * h;
        simulation::rows next = positions + h * velocities;
        const simulation::response_report report = collisions.resolve(positions, next, particles);
        velocities = (next - positions) / h;
        positions = next;
        passed_through += report.passed_through.value();
    }
    const double height = positions.bottomRows(4).col(2).mean();
    std::printf("after a second at a height of %.2f, %zu pairs passed through\n", height,
                passed_through);
    return passed_through == 0 && height > -1 ? 0 : 1;
}
