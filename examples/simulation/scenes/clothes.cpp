// A skirt, sewn to the waist of a body of capsules that walks in place and turns.
// Resolution: columns around the waist.
#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "examples/simulation/bodies/shapes.hpp"
#include "examples/simulation/scenes/scene.hpp"

namespace simulation {
namespace {

constexpr double waist = 0.16, hem = 0.36, length = 0.75;

double swing(double time, double side) {
    return side * 0.45 * std::sin(2 * std::numbers::pi * time);
}

Eigen::AngleAxisd turn(double time) {
    return {1.2 * std::sin(0.5 * std::numbers::pi * time) * std::min(1.0, time), vec3::UnitZ()};
}

}  // namespace

scene clothes(int resolution) {
    scene s;
    s.frames = 400;
    s.solver.time_step = 0.01;
    s.collision.thickness = std::min(2e-3, 0.3 / resolution);
    s.eye = {1.6, -1.9, 0.5};
    s.target = {0, 0, -0.35};
    const int rings = std::max(8, resolution * 2 / 5);
    const surface_shape skirt = grid(
        resolution, rings,
        [](double u, double v) {
            const double angle = 2 * std::numbers::pi * u, radius = std::lerp(waist, hem, v);
            return vec3(radius * std::cos(angle), radius * std::sin(angle), -length * v);
        },
        true);
    const vertex_index cloth = s.bodies.add_cloth(skirt.points, skirt.faces, {});
    for (int i = 0; i < resolution; ++i) s.bodies.pin(cloth + vertex_index(i));

    const int finer = resolution < 100 ? 2 : 3;
    const surface_shape torso = capsule(finer, waist - 0.02, {0, 0, -0.02}, {0, 0, 0.35});
    const vertex_index trunk = s.bodies.add_obstacle(torso.points, torso.faces);
    std::array<surface_shape, 2> leg;
    std::array<vertex_index, 2> first;
    for (std::size_t i = 0; i < 2; ++i) {
        const double y = i == 0 ? -0.075 : 0.075;
        leg[i] = capsule(finer, 0.06, {0, y, -0.9}, {0, y, -0.1});
        first[i] = s.bodies.add_obstacle(leg[i].points, leg[i].faces);
    }
    s.drive = [=, step = s.solver.time_step, ring = rows(skirt.points.topRows(resolution))](
                  int frame, rows& positions) {
        const double time = frame * step;
        const Eigen::Matrix3d body = turn(time).toRotationMatrix();
        const auto place = [&](vertex_index at, const rows& points, const Eigen::Matrix3d& own) {
            positions.middleRows(at, points.rows()) = points * (body * own).transpose();
        };
        place(cloth, ring, Eigen::Matrix3d::Identity());
        place(trunk, torso.points, Eigen::Matrix3d::Identity());
        for (std::size_t i = 0; i < 2; ++i) {
            const Eigen::AngleAxisd own(swing(time, i == 0 ? 1 : -1), vec3::UnitY());
            place(first[i], leg[i].points, own.toRotationMatrix());
        }
    };
    return s;
}

}  // namespace simulation
