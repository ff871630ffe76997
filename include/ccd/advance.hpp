// Steps that are certainly free: how far, and to which positions, a mesh may move without contact.
//
// A time of contact alone does not say: who moves to x0 + α (x1 − x0) gets there rounded, and
// rounding may make the contact that α avoids. Here positions are rounded first, and asked then:
// `exact` finds no contact on the straight way from the positions before to those returned.
#pragma once

#include <ccd/first_times.hpp>
#include <ccd/mesh.hpp>
#include <ccd/query.hpp>
#include <ccd/step.hpp>
#include <optional>
#include <span>
#include <vector>

namespace ccd {

struct advance_options {
    /// The group of each vertex. Vertices of one group move by one fraction of their ways, and so
    /// do groups with a contact between them, as they go: islands. Empty: all are one. (Bodies:
    /// connected_parts of ccd/mesh.hpp. Every vertex by itself: a number of its own for each.)
    std::span<const int> groups = {};
    pair_distances distances = {};            ///< to be kept; by default contact alone is avoided
    int threads = 0;                          ///< at most; 0: one per core
    std::optional<instruction_set> set = {};  ///< by default the strongest
    stop_query stop = {};                     ///< ends the call by throwing ccd::stopped
    pair_filter filter = {};                  ///< which pairs are looked at
};

struct advance_result {
    /// Of vertex v std::lerp(before, after, fractions[v]), coordinate by coordinate (that is
    /// x0 + α (x1 − x0) in doubles, (1 − α) x0 + α x1 where x0 and x1 differ in sign). For α = 0
    /// and 1 it is `before` and `after`, bit for bit. If rounding brings the vertex into contact,
    /// it is moved back towards `before` by up to 1024 last places.
    std::vector<point<double>> positions;
    double fraction = 1;            ///< the least of all
    std::vector<double> fractions;  ///< of each vertex
    /// The earliest contact on the whole way, or distance, of pairs that are not left out;
    /// `separate` if there is none.
    first_time first_contact;
    pair_lists touching_at_start;  ///< left out: no step of theirs is free
    /// Not touching, but within their distance already at t = 0: of them contact alone is avoided.
    pair_lists near_at_start;
};

/// The longest step found to be free from positions.before towards positions.after: a step from
/// positions.before to the result's positions has no pair in contact (or within its distance), but
/// for those that its lists say. All is done where that is free; else a group goes to just before
/// its first contact, and where rounding makes a contact of that, a little less far.
///
/// A group's fraction is at least 0.99 of its first contact's time (that of the groups it was
/// joined with, too), unless no free positions were found within 1024 last places of there, which
/// only gaps of a few last places lead to. Then it is less, at worst 0: the positions before.
///
/// Throws std::invalid_argument as mesh_steps::run, and if there is not a group for each vertex.
/// Time: two such steps, one if all is free, and few more where groups meet by different fractions
/// or by rounding: 80 at worst.
advance_result advance(mesh_steps& steps, const vertex_rows& positions,
                       const advance_options& options = {});
/// Of two frames of one mesh; throws also if they are not.
advance_result advance(const mesh& before, const mesh& after, const advance_options& options = {});

}  // namespace ccd
