// What is measured: scenes of two frames with all candidates of their step, and stored queries.
#pragma once

#include <ccd/mesh.hpp>
#include <string>
#include <vector>

#include "ccd/report/measuring/query_set.hpp"

namespace bench {

using ccd::report::query_set;
using ccd::report::query_sets;

struct scene {
    std::string name;
    ccd::mesh before, after;  ///< empty where there are only queries
    query_sets queries;       ///< by index into the two frames: a scene must not be copied or moved
    bool is_step() const { return !before.vertices.empty(); }

    scene() = default;
    scene(const scene&) = delete;
    scene& operator=(const scene&) = delete;
};

/// All names, in the order of tables.
std::vector<std::string> scene_names();

/// Fills in the scene of that name; false if its data is not here. Throws
/// errbound::support::file_error.
bool load(const std::string& name, scene& into);

/// A cloth of n x n vertices, draped over a sphere of as fine a mesh, that sinks by half a cell and
/// ripples: finer meshes have as many candidates for each vertex.
void make_cloth_over_sphere(int n, ccd::mesh& before, ccd::mesh& after);

/// The vertex/face and edge/edge pairs of a step that share no vertex and whose swept boxes touch,
/// sorted by index; by a sweep that shares nothing with the step which is measured.
query_sets candidates(const ccd::mesh& before, const ccd::mesh& after);

}  // namespace bench
