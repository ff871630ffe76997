// The part of the soak that advances small meshes.
#pragma once

#include <functional>

#include "tests/soak/long_run.hpp"
#include "tests/soak/steps/advance_scenes.hpp"

namespace soak {

/// What must advance a scene: ccd::advance on so many threads.
using advancer = std::function<ccd::advance_result(const advance_scene&, int threads)>;
ccd::advance_result library_advance(const advance_scene& scene, int threads);

/// Small meshes of every family of queries, and others with contacts a last place apart, in space
/// and in the plane, with and without distances and groups: advanced on one thread, where the
/// oracle is asked about every pair, and on two, which must be the same. Tables: "scenes" by
/// family, and "where", "distances", "groups" by what was asked.
part advance_part(advancer advance = library_advance);

}  // namespace soak
