#pragma once

#include <filesystem>

#include "examples/simulation/simulation.hpp"

namespace simulation {

/// Writes folder/paraview/NNNNN.vtp: the frame `before` and the contacts of the step to `proposed`,
/// by `exact`. Throws file_error.
void write_vtp(const std::filesystem::path& folder, const scene& scene, int frame,
               const rows& before, const rows& proposed);

/// Writes folder/paraview/series.pvd with all these files. Throws file_error.
void write_series(const std::filesystem::path& folder, const scene& scene);

}  // namespace simulation
