// A run as a series for ParaView: each frame with the contacts of the step that the solver proposed
// from there.
#pragma once

#include <filesystem>

#include "examples/simulation/simulation.hpp"

namespace simulation {

/// Writes folder/paraview/NNNNN.vtp, the frame `before` and what the way to `proposed` would meet,
/// by `exact`. Throws file_error.
void write_vtp(const std::filesystem::path& folder, const scene& scene, int frame,
               const rows& before, const rows& proposed);

/// Writes folder/paraview/series.pvd, of all such files that there are. Throws file_error.
void write_series(const std::filesystem::path& folder, const scene& scene);

}  // namespace simulation
