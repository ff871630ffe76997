// The part of the soak that takes whole steps of small meshes.
#pragma once

#include <functional>

#include "tests/ccd/step/brute_force.hpp"
#include "tests/soak/long_run.hpp"

namespace soak {

/// What must report the pairs of a mesh: ccd::step on so many threads.
using stepper = std::function<ccd::step_result(const brute_force::two_frames&, int threads)>;
ccd::step_result exact_step(const brute_force::two_frames& at, int threads);

/// Small meshes of every family of queries, faces, rods and points, some given twice, and soups on
/// a grid: the pairs of `step` on one thread, pairs and candidates on two, against every pair asked
/// of the reference.
part mesh_part(stepper step = exact_step);

}  // namespace soak
