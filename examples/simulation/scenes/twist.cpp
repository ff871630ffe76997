// The ends of a sheet are held and turned against each other, by five turns each.
// Resolution: cells along the sheet.
#include <Eigen/Geometry>
#include <algorithm>
#include <numbers>

#include "examples/simulation/bodies/shapes.hpp"
#include "examples/simulation/scenes/scene.hpp"

namespace simulation {

scene twist(int resolution) {
    scene s;
    s.frames = 1000;
    s.solver.time_step = 0.01;
    s.collision.thickness = std::min(2e-3, 0.15 / resolution);
    s.eye = {0.4, -2.0, 0.6};
    s.target = {0, 0, 0};
    const int across = std::max(4, resolution / 2);
    const surface_shape sheet = grid(
        across, resolution, [](double u, double v) { return vec3(v - 0.5, (u - 0.5) / 2, 0); });
    const vertex_index first = s.bodies.add_cloth(sheet.points, sheet.faces, {});
    const int width = across + 1;
    const vertex_index last = first + vertex_index(resolution * width);
    for (int i = 0; i < width; ++i) {
        s.bodies.pin(first + vertex_index(i));
        s.bodies.pin(last + vertex_index(i));
    }
    s.drive = [=, left = rows(sheet.points.topRows(width)),
               right = rows(sheet.points.bottomRows(width))](int frame, rows& positions) {
        const double done = std::min(1.0, frame / 1000.0);
        const double angle = 10 * std::numbers::pi * done, nearer = 0.15 * done;
        const auto hold = [&](vertex_index at, const rows& end, double by, double shift) {
            const Eigen::Matrix3d turn = Eigen::AngleAxisd(by, vec3::UnitX()).toRotationMatrix();
            positions.middleRows(at, width) = end * turn.transpose();
            positions.middleRows(at, width).col(0).array() += shift;
        };
        hold(first, left, angle, nearer);
        hold(last, right, -angle, -nearer);
    };
    return s;
}

}  // namespace simulation
