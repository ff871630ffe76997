// Contact data: where the features of a query first touch, along which normal, and how fast.
//
// Which features meet is decided exactly; weights, normal and velocity are doubles with a certified
// error each. What the bracket of a first time (ccd/contact.hpp) does not tell apart is one moment
// here: `weights` and so on hold for the contact, at whatever time of the bracket it is.
//
// Conventions: the first feature of a query is its vertex v or its edge a, the second one its face,
// edge or vertex w; f0 f1 f2 and so on are numbered as points_of lists them (vertex/face: v f0 f1
// f2; edge/edge: a0 a1 b0 b1; vertex/edge: v e0 e1; vertex/vertex: v w). Velocities are per step:
// t1 − t0.
#pragma once

#include <array>
#include <ccd/contact.hpp>
#include <ccd/kind.hpp>
#include <ccd/query.hpp>
#include <cstdint>
#include <limits>

namespace ccd {

/// The features that meet, in terms of the points of a query.
struct meeting_features {
    /// vertex_vertex, vertex_edge, or the query's own kind: inside both.
    ccd::kind kind = ccd::kind::vertex_vertex;
    /// Numbers of points of the query, as many as the kind has, in its order: of a vertex and an
    /// edge the vertex first, be it of the query's first feature or of its second.
    std::array<std::uint8_t, 4> points{};

    friend constexpr bool operator==(const meeting_features&, const meeting_features&) = default;
};

/// What a normal is.
enum class normal_source : std::uint8_t {
    /// (f1 − f0) × (f2 − f0), or (a1 − a0) × (b1 − b0), at the contact.
    cross_product,
    /// The direction from the second feature's nearest point to the first's, in the limit just
    /// before the contact: against the relative velocity, less its part along the edge that meets.
    nearest_points,
    /// Against the relative velocity, which is along the edge that meets.
    relative_velocity,
    /// There is none: (0, 0, 0).
    none,
};

/// What happens at a first contact. Without one, `time` says why, and all else is as here: weights
/// are 0, errors infinite.
struct first_contact {
    first_time time;
    meeting_features features;
    /// Of each point of the query, in order; those of each feature add up to 1 (but for one
    /// rounding), those of points that take no part are 0. The contact is at the weighted sum of
    /// the first feature's points, and of the second's. Each is in [0, 1], and off by at most
    /// `weight_error`, which is infinite where nothing is known: of slivers.
    std::array<double, 4> weights{};
    double weight_error = std::numeric_limits<double>::infinity();
    /// Of unit length, from the second feature towards the first; as a vector, off by at most
    /// `normal_error`.
    point<double> normal{};
    double normal_error = std::numeric_limits<double>::infinity();
    normal_source normal_from = normal_source::none;
    /// Whether it points to the side on which the first feature was just before the contact, as far
    /// as the bracket tells. False at the start, which nothing was before, and in a plane that the
    /// features do not leave: a cross product then points where the order of the points makes it.
    bool sided = false;
    /// That of the first feature's contact point relative to the second's, along the normal, in
    /// units of length a step: negative if they approach. If `sided`, it is not positive but for
    /// its error.
    double normal_velocity = 0;
    double normal_velocity_error = std::numeric_limits<double>::infinity();

    friend constexpr bool operator==(const first_contact&, const first_contact&) = default;
};

/// The data of a contact whose time is known: `time` is what time_of_impact gives for this query.
/// Where the features certainly do not touch then, all is unknown, as without a contact: such is a
/// time within a distance (ccd/separation.hpp), at which no call tells features or normals.
///
/// Of several pairs of features that meet at this time, the smallest are named: vertex/vertex
/// before vertex/edge before the inside, and of several of a size the first.
///
/// The normal is the cross product where there is a side that it has to be on, or at the start;
/// else the first of these whose direction is known at all: `nearest_points`; the cross product,
/// without a side; `relative_velocity`. So queries of a vertex with a vertex or an edge have no
/// cross product, and motion within a plane, parallel edges and faces without area leave it
/// undefined or without a side.
///
/// Cost: about that of the first time; on the bundled scene 700 to 1,000 ns a contact, where the
/// machine was shared (`./run bench --sections contacts`).
/// No allocation and no exceptions but those of ccd/reference.hpp, which may be asked where the
/// features meet at the border, or the velocity along the cross product has no certain sign.
first_contact contact_at(const vertex_face<double>& query, const first_time& time);
first_contact contact_at(const edge_edge<double>& query, const first_time& time);
first_contact contact_at(const vertex_edge<double>& query, const first_time& time);
first_contact contact_at(const vertex_vertex<double>& query, const first_time& time);

/// The first contact in [0, t_max], with its data: time_of_impact, then contact_at.
inline first_contact find_first_contact(const vertex_face<double>& query, double t_max = 1) {
    return contact_at(query, time_of_impact(query, t_max));
}
inline first_contact find_first_contact(const edge_edge<double>& query, double t_max = 1) {
    return contact_at(query, time_of_impact(query, t_max));
}
inline first_contact find_first_contact(const vertex_edge<double>& query, double t_max = 1) {
    return contact_at(query, time_of_impact(query, t_max));
}
inline first_contact find_first_contact(const vertex_vertex<double>& query, double t_max = 1) {
    return contact_at(query, time_of_impact(query, t_max));
}

}  // namespace ccd
