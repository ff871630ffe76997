// Scenes of bodies in JSON: meshes, and poses for each frame. docs/program.md has the format.
#pragma once

#include <ccd/bodies/motion.hpp>
#include <ccd/io/mesh_file.hpp>
#include <ccd/mesh.hpp>
#include <cstddef>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace ccd::io {

struct body_scene {
    std::vector<std::string> names;   ///< of the bodies, each different
    std::vector<std::string> groups;  ///< of the bodies; "": none
    std::vector<mesh> meshes;         ///< at rest
    std::vector<std::filesystem::path> mesh_files;
    std::vector<double> times;  ///< of the frames, ascending
    /// For each step, from one frame to the next: a valid motion for each body.
    std::vector<std::vector<body_motion>> steps;
    std::vector<std::pair<std::size_t, std::size_t>> skipped;  ///< two bodies, sorted

    /// False for bodies of one group and for skipped pairs. Precondition: a < b.
    bool may_touch(std::size_t a, std::size_t b) const;
};

/// Reads a scene and its meshes, whose paths are relative to its folder. Throws
/// errbound::support::file_error if a member is unknown, missing, repeated or invalid. Also throws
/// if a body turns by half a turn or more in a step, and as read_mesh.
body_scene read_body_scene(const std::filesystem::path& path, const mesh_options& options = {});

}  // namespace ccd::io
