// The scenes: each makes its bodies, says how driven vertices move, and how long it takes.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "examples/simulation/bodies/model.hpp"
#include "examples/simulation/bodies/projective_solver.hpp"
#include "examples/simulation/collision/collision_handler.hpp"

namespace simulation {

struct scene {
    model bodies;
    solver_options solver = {};
    collision_options collision = {};
    int frames = 0;                                ///< each one time step
    rows velocities = {};                          ///< at the start; none: at rest
    vec3 eye{1.2, -2.4, 1.0}, target{0, 0, -0.3};  ///< where pictures are taken from, and of what
    /// Sets the rows of driven vertices to where they are at the end of a frame, from 1 on.
    std::function<void(int frame, rows& positions)> drive = [](int, rows&) {};
};

struct scene_maker {
    std::string name, what;
    int small, full;  ///< resolutions: for minutes, and that of the paper or as large
    /// Of a resolution: what of, the scene's file says.
    std::function<scene(int resolution)> make;
};

/// All scenes, in the order in which tables show them.
std::span<const scene_maker> scenes();

scene funnel(int layers, int resolution);
scene clothes(int resolution);
scene twist(int resolution);
scene car_against_post(int resolution);
scene car_on_ramp(int resolution);
scene needles(int resolution);
scene stiff(int resolution);

}  // namespace simulation
