// The pairs of elements to test, by groups, flags, a callback or a region.
#pragma once

#include <array>
#include <ccd/kind.hpp>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>

namespace ccd {

/// An axis-aligned box, closed below and open above; by default all of space.
struct space_region {
    static constexpr double everywhere = std::numeric_limits<double>::infinity();
    std::array<double, 3> low{-everywhere, -everywhere, -everywhere};
    std::array<double, 3> high{everywhere, everywhere, everywhere};

    bool has(const std::array<double, 3>& x) const {
        for (std::size_t k = 0; k < 3; ++k)
            if (!(low[k] <= x[k] && x[k] < high[k])) return false;
        return true;
    }
};

/// The pairs that a step, or a search for intersections, tests: those with a vertex of one element
/// that may collide with a vertex of the other. Two vertices may collide unless a member excludes
/// it; empty members exclude nothing. Not owned; `groups` and `pinned` have one entry for each
/// vertex.
struct pair_filter {
    enum class group_rule : std::uint8_t {
        between_groups,  ///< two vertices of one group may not collide
        within_groups,   ///< two vertices of different groups may not collide
    };

    /// True if two vertices may collide. Called from several threads at once. An exception ends the
    /// call and leaves the mesh_steps object as before.
    std::function<bool(vertex_index, vertex_index)> can_collide = {};
    std::span<const int> groups = {};  ///< the group of each vertex: its body, its layer, ...
    group_rule rule = group_rule::between_groups;
    /// Not 0: the vertex is at rest, or its motion is prescribed. Two such vertices may not
    /// collide.
    std::span<const std::uint8_t> pinned = {};
    /// Keeps a pair if the lower corner of the intersection of its swept boxes (widened by the
    /// distance) lies in this region: regions that tile space partition the pairs. A step in a
    /// region needs only the elements whose boxes meet it.
    std::optional<space_region> region = {};
    /// Skips unused_vertices, which are points by default. To keep vertex v, add the edge {v, v}.
    bool skip_unused = false;
};

}  // namespace ccd
