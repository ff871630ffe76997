// An elastic car body of tetrahedra at 15 m/s hits a post, or drives onto a ramp of rods.
// Resolution: cells along the car; a quarter of these across and high.
#include <algorithm>
#include <cmath>

#include "examples/simulation/bodies/shapes.hpp"
#include "examples/simulation/scenes/scene.hpp"

namespace simulation {
namespace {

constexpr double length = 4.0, width = 1.6, height = 1.2, clearance = 0.05;

/// The cabin is shorter than the body below it.
solid_shape car_body(int resolution) {
    const int across = std::max(4, resolution / 4), high = std::max(4, resolution / 4);
    return block({resolution, across, high}, {0, -width / 2, clearance},
                 {length, width / 2, clearance + height}, [=](int i, int, int k) {
                     const double along = (i + 0.5) / resolution;
                     return k < high / 2 || (along > 0.25 && along < 0.8);
                 });
}

scene car(int resolution) {
    scene s;
    s.frames = 300;
    s.solver.time_step = 2e-3;
    s.collision.thickness = 5e-3;
    s.eye = {-4, -7, 4};
    s.target = {0, 0, 0.4};
    const solid_shape body = car_body(resolution);
    s.bodies.add_solid(body.points, body.tetrahedra, {.density = 300, .stiffness = 2e6});
    const surface_shape floor =
        grid(20, 8, [](double u, double v) { return vec3(-12 + 20 * u, -4 + 8 * v, 0); });
    s.bodies.add_obstacle(floor.points, floor.faces);
    return s;
}

void set_off(scene& s) {
    s.velocities = rows::Zero(s.bodies.start.rows(), 3);
    for (std::size_t v = 0; v < s.bodies.vertices(); ++v)
        if (!s.bodies.driven(v)) s.velocities(Eigen::Index(v), 0) = -15;
}

}  // namespace

scene car_against_post(int resolution) {
    scene s = car(resolution);
    const surface_shape post = revolved({{0.15, 0.02}, {0.15, 0.5}, {0.15, 1.0}, {0.15, 2.0}}, 16);
    rows points = post.points;
    translate(points, {-0.6, 0.2, 0});
    s.bodies.add_obstacle(points, post.faces);
    set_off(s);
    return s;
}

scene car_on_ramp(int resolution) {
    scene s = car(resolution);
    for (int i = 0; i < 12; ++i) {
        const double x = -0.5 - 0.35 * i, z = 0.02 + 0.06 * i;
        const vertex_index first =
            s.bodies.add_rod(line(6, {x, -1.2, z}, {x, 1.2, z + 0.01 * (i % 3)}), {});
        for (vertex_index v = 0; v <= 6; ++v) s.bodies.pin(first + v);
    }
    set_off(s);
    return s;
}

}  // namespace simulation
