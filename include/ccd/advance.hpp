// Steps that are certainly free of contact: how far a mesh may move, and to which positions.
//
//     const ccd::advance_result r = ccd::advance(before, after);  // r.positions are free
//     const double alpha = ccd::free_step(steps, {x, p}).fraction;  // x + alpha * p is free
//
// `exact` certifies that the straight way from `before` to the rounded positions has no contact.
// Precondition: `before` is free of intersections (ccd/intersections.hpp), which check_start tests.
#pragma once

#include <ccd/contact.hpp>
#include <ccd/mesh.hpp>
#include <ccd/query.hpp>
#include <ccd/step.hpp>
#include <optional>
#include <span>
#include <vector>

namespace ccd {

struct advance_options {
    /// The group of each vertex; empty: one group. Vertices of a group move by the same fraction of
    /// their ways. Groups with a contact between them, also at the start, are joined. For one group
    /// per body, pass connected_parts (ccd/mesh.hpp); for one per vertex, different indices.
    std::span<const int> groups = {};
    /// Each vertex goes at least as far as with its group (without groups: as with a group of its
    /// own), and further up to planes. For each pair that would touch, a plane separates its two
    /// elements where they are at the start, as in divide-and-truncate methods. Motion towards the
    /// plane is limited, motion along it is not.
    bool each_vertex = false;
    /// The distances that pairs keep. If 0, pairs only avoid contact, and rods with a common vertex
    /// are tested too. With distances such rods are not tested: they may fold through each other,
    /// which certify (ccd/certify.hpp) finds.
    pair_distances distances = {};
    /// Pairs that start nearer than (1 + 2^-10) times their distance may come nearer,
    /// but not below this share of their distance at the start: in [0, 1). So pairs that rest at
    /// their distance can slide on. With 0, pairs that start within their distance may come
    /// arbitrarily near, but do not touch; pairs that start farther apart keep the whole distance,
    /// so one just above it stops its group.
    double keep = 0.1;
    int threads = 0;                          ///< at most; 0: one per core
    std::optional<instruction_set> set = {};  ///< by default the strongest
    stop_query stop = {};                     ///< ends the call by throwing ccd::stopped
    pair_filter filter = {};                  ///< the pairs to test
    bool check_start = false;                 ///< fill advance_result::intersections_at_start
    /// The share of the way to the first contact (or distance) that is used: in (0, 1]. With 1, a
    /// step ends next to the contact. Barrier methods need a gap there; 0.8 is usual.
    double conservative = 1;
};

struct advance_result {
    /// std::lerp(before, after, fractions[v]) for each coordinate of vertex v; for fractions 0 and
    /// 1 `before` and `after`, bit for bit. A vertex that rounding brings into contact is moved
    /// back towards `before` by up to 1024 units in the last place.
    std::vector<point<double>> positions;
    double fraction = 1;            ///< the least of `fractions`
    std::vector<double> fractions;  ///< of each vertex
    /// The earliest contact (or distance) on the whole way, without the pairs of touching_at_start;
    /// `separate` if there is none.
    first_time first_contact;
    pair_lists first_pairs;        ///< the pairs with that time: they limit the step
    pair_lists touching_at_start;  ///< skipped: no step of these pairs is free
    pair_lists near_at_start;      ///< near at t = 0: only `keep` holds for them
    /// With check_start: elements that intersect at t = 0, as step_result::intersections_at_start.
    /// They may move on through each other: only a start without them has a free result.
    std::vector<intersection> intersections_at_start;
};

/// Returns the longest step from positions.before towards positions.after that was found to be
/// free: no pair is in contact (or within its distance), except those in touching_at_start
/// and near_at_start. A group with a contact on the way stops just before it.
///
/// A group's fraction is at least 0.99 of the time of its first contact, or of the least time among
/// joined groups, times `conservative`. It is less, at worst 0, only if moving vertices back by up
/// to 1024 units in the last place does not free them. Gaps of a few such units cause this. Each
/// round of the search joins groups, shortens ways or moves vertices back. If 60 rounds do not
/// suffice, all groups are joined, and vertices are no longer moved back.
///
/// Throws as mesh_steps::run, and std::invalid_argument if the numbers of groups and vertices
/// differ. Cost: one such step if the whole way is free, else usually at most two; without groups
/// and distances it is less than one if contacts are many and the first one is early. It is more,
/// at most 80 steps (120 with each_vertex), if groups with different fractions meet or rounding
/// causes contacts. Memory: that of the step, and up to 256 bytes a vertex.
advance_result advance(mesh_steps& steps, const vertex_rows& positions,
                       const advance_options& options = {});
/// Two frames of one mesh. Throws std::invalid_argument also if they differ in faces, edges or
/// number of vertices.
advance_result advance(const mesh& before, const mesh& after, const advance_options& options = {});

/// Returns the longest step along a direction that was found to be free. `x_and_p` are positions x
/// and displacements p, not positions at t = 1: free_step(steps, {x, p}), where advance takes {x, x
/// + p}. Line searches move to x + alpha * p, which rounds otherwise than
/// advance_result::positions, so a fraction of `advance` does not certify it.
///
/// The result's fraction is alpha, and its positions are x + alpha * p. The ways from x to these
/// are free in both forms: product and sum rounded, and fused, std::fma(alpha, p, x), for each
/// coordinate. first_contact is on the way from x to x + p, or to a half of p, a quarter, ... if
/// that overflows. alpha is within a few ulps of `conservative` times the time of that contact,
/// times 1/2, 1/4, ... after an overflow, and less only if rounding causes contacts.
///
/// Throws as advance, and std::invalid_argument with groups or each_vertex, or if a displacement is
/// not finite. Cost: as advance; one more step if fused positions differ.
advance_result free_step(mesh_steps& steps, const vertex_rows& x_and_p,
                         const advance_options& options = {});

}  // namespace ccd
