// Scenes of advances: small hard meshes, in space and in the plane, with minimum distances and
// groups, and the checks of their results.
#pragma once

#include <ccd/advance.hpp>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "tests/ccd/step/brute_force.hpp"
#include "tests/support/query_families.hpp"

namespace soak {

struct advance_scene {
    brute_force::two_frames at;
    bool in_plane = false;
    double distance = 0;                 ///< of all pairs
    std::vector<double> thickness = {};  ///< of each vertex, or empty
    std::vector<int> groups = {};        ///< of each vertex, or empty: all are one
    std::string_view distances_name = {}, groups_name = {};

    ccd::mesh_steps steps() const;
    ccd::pair_distances distances() const { return {distance, thickness}; }
    ccd::advance_options options(int threads) const {
        return {.groups = groups, .distances = distances(), .keep = 0, .threads = threads};
    }
    /// Calls visit(pair) for every pair.
    template <class Visit>
    void for_each_pair(const Visit& visit) const {
        if (in_plane)
            brute_force::for_each_pair_in_plane(at.first, visit);
        else
            brute_force::for_each_pair(at.first, visit);
        if (!in_plane && distances().is_contact())
            brute_force::for_each_adjacent_pair(at.first, visit);
    }
    /// A text with all data of the scene.
    std::string text() const;
};

/// The names of the scenes' kinds of distances and groups.
inline constexpr std::string_view distances_names[] = {"contact", "one distance", "thicknesses"};
inline constexpr std::string_view groups_names[] = {"all are one", "bodies", "each vertex", "few"};

/// Meshes for advances only, with contacts a last place apart.
struct advance_family {
    std::string_view name;
    brute_force::two_frames (*make)(query_families::source& random);
};
extern const std::vector<advance_family> advance_families;

/// A mesh of a family of queries (mesh_of) or of one of these families; all else is random.
advance_scene scene_of(const query_families::family& family, std::uint64_t seed,
                       std::uint64_t index);
advance_scene scene_of(const advance_family& family, std::uint64_t seed, std::uint64_t index);

struct advance_check {
    std::string faults = {};  ///< faults found, or empty
    std::size_t pairs = 0;
    /// True if a vertex moves less than 0.99 of the way to the first contact that could hold it.
    bool is_short = false;
};

/// Checks the promises of include/ccd/advance.hpp by the oracle on every pair:
/// - Lists of pairs at the start are complete, and the earliest contact is right.
/// - No other pair is in contact, or within its distance, on the way to the positions.
/// - Positions agree with the fractions.
/// - A contact stops every vertex that does not move all the way. It is one
///   of the vertex's group, or of a group near enough to be joined with it.
///
/// The caller checks `is_short`, which gaps of a few last places excuse.
advance_check check(const advance_scene& scene, const ccd::advance_result& result);

/// Checks by the oracle that the ways from the start to x + alpha * p are free, as rounded twice
/// and fused. `found` is the result of ccd::free_step along p.
std::string line_search_faults(const advance_scene& scene, const ccd::advance_result& found,
                               const ccd::mesh& p);
/// Checks by the oracle that a result with each_vertex is free, and that no vertex goes less far
/// than in `by_groups`.
std::string each_vertex_faults(const advance_scene& scene, const ccd::advance_result& by_groups,
                               const ccd::advance_result& found);

}  // namespace soak
