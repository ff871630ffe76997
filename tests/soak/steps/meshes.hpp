// The part of the soak that takes whole steps of small meshes.
#pragma once

#include <functional>

#include "tests/ccd/step/brute_force.hpp"
#include "tests/soak/long_run.hpp"

namespace soak {

/// What must report the pairs of a mesh: ccd::step on so many threads, candidates counted or not.
using stepper =
    std::function<ccd::step_result(const brute_force::two_frames&, int threads, bool counted)>;
ccd::step_result exact_step(const brute_force::two_frames& at, int threads, bool counted);

/// Small meshes of every family of queries, faces, rods and points, some given twice, and soups on
/// a grid: candidates and pairs of `step`, counted or not, on one thread and on two, against every
/// pair asked of the reference.
part mesh_part(stepper step = exact_step);

}  // namespace soak
