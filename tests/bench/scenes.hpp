// Scenes: two frames with all candidates of their step, or stored queries.
#pragma once

#include <ccd/mesh.hpp>
#include <string>
#include <vector>

#include "ccd/lab/query_set.hpp"

namespace bench {

using ccd::lab::query_set;
using ccd::lab::query_sets;

struct scene {
    std::string name;
    ccd::mesh before, after;  ///< empty if there are only queries
    query_sets queries;       ///< indexes into the two frames: do not copy or move a scene
    bool is_step() const { return !before.vertices.empty(); }

    scene() = default;
    scene(const scene&) = delete;
    scene& operator=(const scene&) = delete;
};

/// All names, in the order of tables.
std::vector<std::string> scene_names();

/// Loads the scene of that name; returns false if its data is missing. Throws
/// errbound::support::file_error.
bool load(const std::string& name, scene& into);

}  // namespace bench
