// Sheets of cloth fall into a funnel, and a ball presses them through its neck. Source: the funnel
// of Wang, Tang, Tong, Manocha: TightCCD, 2015. Resolution: cells along a side of a sheet.
#include <algorithm>
#include <cmath>

#include "examples/simulation/bodies/shapes.hpp"
#include "examples/simulation/scenes/scene.hpp"

namespace simulation {
namespace {

constexpr double side = 1.0, rim = 0.55, neck = 0.13, slope_height = 0.45, neck_height = 0.3;
constexpr double ball = 0.09;

std::vector<std::array<double, 2>> profile(int rings) {
    std::vector<std::array<double, 2>> curve;
    const double slope = std::hypot(rim - neck, slope_height), length = slope + neck_height;
    for (int i = 0; i <= rings; ++i) {
        const double s = length * i / rings;
        if (s < slope)
            curve.push_back({std::lerp(rim, neck, s / slope), -slope_height * s / slope});
        else
            curve.push_back({neck, -slope_height - (s - slope)});
    }
    return curve;
}

}  // namespace

scene funnel(int layers, int resolution) {
    scene s;
    s.frames = 1330;
    s.solver.time_step = 0.01;
    s.collision.thickness = std::min(2e-3, 0.15 * side / resolution);
    for (int layer = 0; layer < layers; ++layer) {
        surface_shape sheet = square(resolution, side, 0.03 + 0.02 * layer);
        s.bodies.add_cloth(sheet.points, sheet.faces, {});
    }
    const surface_shape cone =
        revolved(profile(std::max(8, resolution / 3)), std::max(24, resolution));
    s.bodies.add_obstacle(cone.points, cone.faces);
    const double high = 0.03 + 0.02 * layers + ball + 0.05;
    const surface_shape pusher = sphere(resolution < 60 ? 2 : 3, ball, {0, 0, high});
    const vertex_index first = s.bodies.add_obstacle(pusher.points, pusher.faces);

    // The ball rests for 200 frames, then moves down through the neck.
    const double way = high + slope_height + neck_height + 2 * ball;
    s.drive = [=, start = pusher.points](int frame, rows& positions) {
        const double done = std::clamp((frame - 200) / 1100.0, 0.0, 1.0);
        positions.middleRows(first, start.rows()) = start;
        positions.middleRows(first, start.rows()).col(2).array() -= way * done;
    };
    return s;
}

}  // namespace simulation
