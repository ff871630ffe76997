// Checks the input of steps on hosts and devices. check_... throw std::invalid_argument, with a
// message that opens with `caller`.
#pragma once

#include <ccd/mesh.hpp>
#include <ccd/step.hpp>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace ccd::detail {

void check_frames(const mesh& before, const mesh& after, const std::string& caller);

/// Indices must be below `vertices` and able to represent all elements.
void check_elements(std::span<const face> faces, std::span<const edge> edges, std::size_t vertices,
                    const std::string& caller);

/// Checks that there are finite positions of this many vertices. Messages use the numbers of
/// vertices, or their indices if there are no numbers.
void check_positions(const vertex_rows& positions, std::size_t vertices, const std::string& caller,
                     std::span<const std::uint64_t> numbers = {});

/// The same for ccd::intersections, which reads positions.before only.
void check_at_rest(const vertex_rows& positions, std::size_t vertices, const pair_filter& filter,
                   bool in_plane = false);

/// True if the options need times or distances, which only `exact` computes.
bool needs_times_or_distances(const step_options& options);

void check_plane(const vertex_rows& positions, const std::string& caller);

void check_options(const step_options& options, std::size_t vertices, const std::string& caller);
void check_shares(double conservative, double keep, const std::string& caller);

/// True if a mesh has vertex/face and edge/edge pairs only: no edges except those of its faces, and
/// at most one point. Precondition: indices are in range.
bool has_faces_only(const mesh& mesh);

}  // namespace ccd::detail
