// Checks of what steps on the host and on devices are given; check_... throw std::invalid_argument.
#pragma once

#include <ccd/mesh.hpp>
#include <ccd/step.hpp>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace ccd::detail {

/// That two frames are of one mesh.
void check_frames(const mesh& before, const mesh& after);

/// That all indices are below `vertices`, and that indices can name all elements. `caller` is named
/// in the message.
void check_elements(std::span<const face> faces, std::span<const edge> edges, std::size_t vertices,
                    const std::string& caller);

/// That there are positions of so many vertices, all finite. A message names a vertex by its
/// number, or by its place where vertices have none.
void check_positions(const vertex_rows& positions, std::size_t vertices,
                     std::span<const std::uint64_t> numbers = {});

/// Whether something beyond contact in the whole step is asked for, which `exact` alone answers.
bool ask_for_times_or_distances(const step_options& options);

/// That z is 0 everywhere.
void check_plane(const vertex_rows& positions);

/// That the method is one and does what is asked, and that lists are as long as there are vertices.
void check_options(const step_options& options, std::size_t vertices);

/// Whether vertex/face and edge/edge pairs are all that a mesh has: no edges beside those of its
/// faces, at most one point. Indices must be in range.
bool has_faces_alone(const mesh& mesh);

}  // namespace ccd::detail
