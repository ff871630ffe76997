// Needles, a thousand times as long as thick, are pressed into a sheet that is held at its border,
// and drawn sideways through its folds. Resolution: cells along a side of the sheet.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "examples/simulation/bodies/shapes.hpp"
#include "examples/simulation/scenes/scene.hpp"

namespace simulation {

scene needles(int resolution) {
    scene s;
    s.frames = 500;
    s.solver.time_step = 0.01;
    s.collision.thickness = std::min(5e-4, 0.1 / resolution);
    s.eye = {1.1, -1.6, 0.9};
    s.target = {0, 0, -0.05};
    const surface_shape sheet = square(resolution, 1, 0);
    const vertex_index cloth = s.bodies.add_cloth(
        sheet.points, sheet.faces, {.membrane = 50, .strain_limit = 0.3, .limit_stiffness = 2000});
    const int side = resolution + 1;
    for (int i = 0; i < side; ++i)
        for (const int v : {i, resolution * side + i, i * side, i * side + resolution})
            s.bodies.pin(cloth + vertex_index(v));

    rows all(0, 3);
    const vertex_index first = static_cast<vertex_index>(s.bodies.vertices());
    for (int i = 0; i < 9; ++i) {
        const double angle = 2 * std::numbers::pi * i / 9, radius = 0.04 + 0.02 * i;
        const vec3 tip(radius * std::cos(angle), radius * std::sin(angle), 0.01 + 0.002 * i);
        const surface_shape needle =
            spike(3, 2.5e-4,
                  tip + vec3(0.05 * std::cos(3 * angle), 0.05 * std::sin(3 * angle), 0.5), tip);
        s.bodies.add_obstacle(needle.points, needle.faces);
        all.conservativeResize(all.rows() + needle.points.rows(), 3);
        all.bottomRows(needle.points.rows()) = needle.points;
    }
    s.drive = [=](int frame, rows& positions) {
        const double down = std::min(1.0, frame / 250.0),
                     aside = std::clamp((frame - 250) / 250.0, 0.0, 1.0);
        const vec3 by(0.15 * aside, 0, -0.12 * down);
        positions.middleRows(first, all.rows()) = all.rowwise() + by.transpose();
    };
    return s;
}

}  // namespace simulation
