// A run moves bodies frame by frame, with a solver, collision response and driven vertices.
#pragma once

#include <cstdint>
#include <string>

#include "examples/simulation/bodies/projective_solver.hpp"
#include "examples/simulation/collision/collision_handler.hpp"
#include "examples/simulation/scenes/scene.hpp"

namespace simulation {

struct run_state {
    int frame = 0;
    rows positions, velocities;
    forces_of_pairs forces;
};

struct frame_record {
    int frame = 0;
    double solver_seconds = 0;
    response_report response;
    double kinetic_energy = 0, elastic_energy = 0, potential_energy = 0;  ///< in joules
};

class simulation_run {
  public:
    /// Starts the scene. If `seed` is not 0, moves free vertices by up to 1e-5 m at random. Throws
    /// std::invalid_argument if there are contacts at the start.
    simulation_run(scene scene, std::uint64_t seed);

    frame_record next_frame();

    const scene& of() const { return scene_; }
    const run_state& state() const { return state_; }
    const rows& proposed() const { return proposed_; }
    void restore(run_state state);

  private:
    scene scene_;
    projective_solver solver_;
    collision_handler collisions_;
    run_state state_;
    rows proposed_;
};

}  // namespace simulation
