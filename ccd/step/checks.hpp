// Checks for hosts and devices. check_... throw std::invalid_argument.
#pragma once

#include <ccd/mesh.hpp>
#include <ccd/step.hpp>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace ccd::detail {

void check_frames(const mesh& before, const mesh& after);

/// Indices must be below `vertices` and able to represent all elements. Messages name `caller`.
void check_elements(std::span<const face> faces, std::span<const edge> edges, std::size_t vertices,
                    const std::string& caller);

/// Checks finiteness and count. Messages use the numbers of vertices, or their indices without
/// numbers.
void check_positions(const vertex_rows& positions, std::size_t vertices,
                     std::span<const std::uint64_t> numbers = {});

/// Only `exact` computes these.
bool needs_times_or_distances(const step_options& options);

void check_plane(const vertex_rows& positions);

void check_options(const step_options& options, std::size_t vertices);

/// True if there are no edges except those of faces, and at most one point. Precondition: indices
/// are in range.
bool has_faces_only(const mesh& mesh);

}  // namespace ccd::detail
