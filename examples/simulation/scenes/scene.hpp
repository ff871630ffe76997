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
    int frames = 0;                                ///< one time step each
    rows velocities = {};                          ///< initial; empty: at rest
    vec3 eye{1.2, -2.4, 1.0}, target{0, 0, -0.3};  ///< of the camera for pictures
    /// Sets the rows of driven vertices at the end of a frame, from 1 on.
    std::function<void(int frame, rows& positions)> drive = [](int, rows&) {};
};

struct scene_maker {
    std::string name, description;
    int small, full;  ///< resolutions: for minutes of run time, and for the paper's size
    /// Each scene's file defines its resolution.
    std::function<scene(int resolution)> make;
};

/// In the order of tables.
std::span<const scene_maker> scenes();

scene funnel(int layers, int resolution);
scene clothes(int resolution);
scene twist(int resolution);
scene car_against_post(int resolution);
scene car_on_ramp(int resolution);
scene needles(int resolution);
scene stiff(int resolution);

}  // namespace simulation
