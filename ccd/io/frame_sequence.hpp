// Frames of a recorded simulation: mesh files (PLY, OBJ), or arrays of positions (.npy, .npz).
#pragma once

#include <ccd/io/mesh_file.hpp>
#include <ccd/mesh.hpp>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace ccd::io {

/// An array of float32 or float64 positions in a file.
struct stored_positions {
    std::size_t frames = 1, vertices = 0;
    bool in_floats = false, big_endian = false;
    std::uint64_t offset = 0;  ///< of the first number

    std::uint64_t bytes_per_frame() const {
        return std::uint64_t{3} * vertices * (in_floats ? 4 : 8);
    }
};

/// Frames are read from the files when they are needed. Functions throw file_error.
class frame_sequence {
  public:
    /// Each file has one frame (PLY, OBJ, or shape (n, 3)) or several (shape (frames, n, 3)). A
    /// .npz file, as numpy.savez writes it, has one array or one with the name `positions`, whose
    /// checksum is compared here. Faces and edges are those of `mesh`, or of the first file. Throws
    /// also if that file has none.
    frame_sequence(const std::vector<std::filesystem::path>& files,
                   const std::optional<std::filesystem::path>& mesh, const mesh_options& options);

    std::size_t size() const { return frames_.size(); }
    const mesh& topology() const { return topology_; }
    /// The file of a frame, and its index there: run.npy[3].
    std::string name(std::size_t frame) const;
    /// Coordinates are finite, and floats are converted exactly.
    std::vector<point<double>> positions(std::size_t frame) const;

  private:
    struct place {
        std::size_t file, index;
    };
    struct frame_file {
        std::filesystem::path path;
        std::optional<stored_positions> stored;  ///< none: a mesh
    };
    mesh_options options_;
    mesh topology_;
    std::string topology_name_;
    std::vector<frame_file> files_;
    std::vector<place> frames_;
};

}  // namespace ccd::io
