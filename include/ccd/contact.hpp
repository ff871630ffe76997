// First contacts and distances, exactly: the first time, the contact point, the normal.
//
//     ccd::first_time t = ccd::time_of_impact(query);           // between adjacent doubles
//     ccd::first_contact c = ccd::find_first_contact(query);    // features, weights, normal
//     ccd::first_time d = ccd::time_within(query, {1e-3, 0});   // first time within a distance
//     auto times = ccd::first_times(positions, pairs);          // many queries, over threads
//
// Semantics are those of ccd/exact.hpp, also for planar motion, parallel edges and degenerate
// triangles. Coordinates that are not finite give `uncertain`. Calls for one query do not allocate
// or throw, except in their last stage (ccd/reference.hpp). Batches throw std::invalid_argument for
// bad input; answers do not depend on instruction sets or threads.
#pragma once

#include <algorithm>
#include <array>
#include <ccd/execution.hpp>
#include <ccd/kind.hpp>
#include <ccd/mesh.hpp>
#include <ccd/query.hpp>
#include <ccd/verdict.hpp>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace ccd {

/// Returns the first time in [0, min(t_max, 1)] at which the features touch: 0, a rational number,
/// or a root of a quadratic or a cubic. There is none if t_max < 0.
template <any_query Query>
first_time time_of_impact(const Query& query, double t_max = 1);

/// Returns `collides` if the Euclidean distance of the features is <= d at some t in [0, 1]; d = 0
/// means contact. Returns `uncertain`, with cause `range`, only if a coordinate or a part of d is
/// not finite, or a part of d is negative.
template <any_query Query>
verdict decide_within(const Query& query, separation d);

/// Returns the first time in [0, t_max] at which the distance of the features is <= d.
template <any_query Query>
first_time time_within(const Query& query, separation d, double t_max = 1);

/// The features of a query that meet.
struct meeting_features {
    /// vertex_vertex, vertex_edge, or the kind of the query if both of its features meet inside.
    ccd::kind kind = ccd::kind::vertex_vertex;
    /// Indices into points_of(query), one for each point of `kind`. If a vertex meets an edge, the
    /// vertex comes first, even if it belongs to the query's second feature.
    std::array<std::uint8_t, 4> points{};

    friend constexpr bool operator==(const meeting_features&, const meeting_features&) = default;
};

/// The origin of a normal.
enum class normal_source : std::uint8_t {
    /// (f1 − f0) × (f2 − f0), or (a1 − a0) × (b1 − b0), at the contact.
    cross_product,
    /// The direction from the second feature's nearest point to the first's, in the limit before
    /// the contact: the reversed relative velocity, without its component along an edge that a
    /// vertex meets.
    nearest_points,
    /// The reversed relative velocity, which is along the edge that a vertex meets.
    relative_velocity,
    /// There is no normal: (0, 0, 0).
    none,
};

/// The data of a first contact. The features are exact. Weights, normal and velocity each have a
/// certified error, for every time in the bracket. Without a contact at `time`, all weights are 0
/// (test this) and errors infinite.
///
/// A query's first feature is its vertex v or edge a, the second its face, edge or vertex w. Points
/// are numbered as in points_of (v f0 f1 f2; a0 a1 b0 b1; v e0 e1; v w).
struct first_contact {
    first_time time;
    meeting_features features;
    /// One weight in [0, 1] for each point, 0 for points not among `features`. Each feature's
    /// weights add up to 1 within one rounding. The weighted sum of its points is the contact
    /// point.
    std::array<double, 4> weights{};
    double weight_error =
        std::numeric_limits<double>::infinity();  ///< of each; may be infinite in slivers
    point<double> normal{};  ///< of unit length, from the second feature towards the first
    double normal_error = std::numeric_limits<double>::infinity();  ///< length of the error
    normal_source normal_from = normal_source::none;
    /// True if the normal points to the side on which the first feature was just before the
    /// contact. False at the start, in slivers (triangles that are nearly segments), and for some
    /// motions in a plane. Then the order of the points determines the direction of a cross
    /// product.
    bool sided = false;
    /// The component along the normal of the first feature's velocity relative to the second's at
    /// the contact point, in lengths per step. Negative if they approach; <= 0 within its error if
    /// `sided`.
    double normal_velocity = 0;
    double normal_velocity_error = std::numeric_limits<double>::infinity();

    friend constexpr bool operator==(const first_contact&, const first_contact&) = default;
};

/// Returns the data of the contact at `time`, the result of time_of_impact(query). If the features
/// certainly do not touch at `time`, the result keeps `time`, but all weights are 0.
///
/// If several features meet, the result has the smallest: two vertices, else a vertex and an edge,
/// else the query's features. The normal is the cross product if its direction and side are
/// certain. It is also the cross product, not sided, if features meet inside at the start or in a
/// sliver. Otherwise it is the first of these with a certain direction: `nearest_points`, the cross
/// product without a side, `relative_velocity`.
///
/// Cost: 700 to 1,000 ns on the bundled scene (./run bench --sections contacts). May use unbounded
/// integers (ccd/reference.hpp) if features meet at a border, or if the sign of the velocity along
/// the cross product is not certain.
template <any_query Query>
first_contact contact_at(const Query& query, const first_time& time);

/// Returns the first contact in [0, t_max]: time_of_impact, then contact_at.
template <any_query Query>
first_contact find_first_contact(const Query& query, double t_max = 1) {
    return contact_at(query, time_of_impact(query, t_max));
}

/// The derivative of a first time of contact by the positions of the query's points: by[i].t0 holds
/// the partial derivatives by point i at t = 0, by[i].t1 those by point i at t = 1, in steps per
/// length. Points are numbered as in points_of.
///
/// The derivative is defined if the features meet inside, after the start, at a simple root (the
/// normal velocity is not 0). It is undefined, with all of `by` 0, if
/// - there is no contact, or it is at the start;
/// - smaller features meet: even a tiny change of positions can then make other features meet
///   first;
/// - the root is multiple, or so close to a multiple one that the normal velocity may be 0;
/// - two vertices meet, or a vertex and an edge in space. Almost every change parts them.
/// For a vertex and an edge in the plane (all z are equal), motions stay in it: derivatives by z
/// are 0. At t = 1, the motion counts as continued after the step.
struct time_derivative {
    std::array<moving_point<double>, 4> by{};
    /// A certified bound on the error of each component; infinite if undefined.
    double error = std::numeric_limits<double>::infinity();

    constexpr bool is_defined() const { return error < std::numeric_limits<double>::infinity(); }

    friend constexpr bool operator==(const time_derivative&, const time_derivative&) = default;
};

/// Returns the derivative of contact.time. Precondition: `contact` is find_first_contact(query), or
/// contact_at for the query's time of impact. Cost: about a third of contact_at. Derivation:
/// ccd/contact/data/derivative.cpp.
template <any_query Query>
time_derivative derivative_of(const Query& query, const first_contact& contact);

/// How features move on after their first contact.
enum class contact_motion : std::uint8_t {
    unknown,     ///< there is no contact, or it is at the start and the features part or cross
    approaches,  ///< one moves to the other side of the other, or the normal velocity is < 0
    touches,     ///< on one side before and after the bracket: they touch without crossing
    slides,      ///< the motion stays in the plane of the features, or on the line of the edge
};
constexpr std::string_view name(contact_motion m) {
    constexpr std::string_view names[] = {"unknown", "approaches", "touches", "slides"};
    return names[static_cast<std::size_t>(m)];
}

/// Returns how the features move on after a contact, which is the result of contact_at or
/// find_first_contact for this query. Exact: if the normal velocity does
/// not decide, the signs of Y (docs/notation.md) just before and just after the bracket do. Y may
/// be zero throughout. Then a vertex that meets an edge is judged by its side of the edge's line
/// before and after; for features that meet inside, the result is `slides`. Cost: one comparison if
/// the normal velocity decides, otherwise unbounded integers.
template <any_query Query>
contact_motion motion_after(const Query& query, const first_contact& contact);

/// The distance within which a pair is reported: `all` for every pair, or the exact sum of the
/// thicknesses of its elements. An element's thickness is the largest `thickness` of its vertices.
/// The default, 0, means contact. Values are finite and >= 0, in the unit of the coordinates. Not
/// owned.
struct pair_distances {
    double all = 0;
    std::span<const double> thickness = {};

    /// True if there is no distance, only contact.
    bool is_contact() const { return all == 0 && thickness.empty(); }

    /// An upper bound on the distances of all pairs.
    double max_distance() const {
        double most = all;
        for (const double t : thickness) most = (std::max)(most, 2 * t);
        return most;
    }

    /// The distance of a pair. Precondition: a `thickness` that is not empty has the pair's
    /// vertices.
    template <any_pair Pair>
    separation of(const Pair& pair) const {
        if (thickness.empty()) return {all, 0};
        const auto vertices = vertices_of(pair);
        const std::span<const vertex_index> both(vertices);
        constexpr std::size_t first = kind_traits<kind_of<Pair>>::first_vertices;
        return {thickness_of(both.first(first)), thickness_of(both.subspan(first))};
    }

    /// The thickness of an element. Precondition: `thickness` has its vertices.
    double thickness_of(std::span<const vertex_index> vertices) const {
        double most = 0;
        for (const vertex_index v : vertices) most = (std::max)(most, thickness[v]);
        return most;
    }
};

struct time_options {
    double t_max = 1;                         ///< the last time; decide_within_batch: always 1
    pair_distances distances = {};            ///< for queries by value only `all`
    int threads = 0;                          ///< at most; 0: one per core
    std::optional<instruction_set> set = {};  ///< by default the strongest
    stop_query stop = {};                     ///< ends the call by throwing ccd::stopped
};

struct timed_contact {
    std::size_t query;
    first_time time;

    friend bool operator==(const timed_contact&, const timed_contact&) = default;
};

/// The earliest of many first times.
struct earliest_time {
    /// The least time by `low`, then by `high`, without those at the start; `separate` if there is
    /// none. `uncertain` if a query has a coordinate that is not finite. Then `queries` lists these
    /// queries, and nothing else is reported.
    first_time time;
    std::vector<std::size_t> queries;   ///< with that time, ascending
    std::vector<std::size_t> at_start;  ///< in contact at t = 0, ascending
};

namespace detail {

template <class Item>
struct timed_batch {
    batch_input<Item> queries;
    const time_options& options;

    std::vector<outcome> decisions() const;
    std::vector<timed_contact> contacts() const;
    std::vector<first_time> times() const;
    earliest_time earliest() const;
};
template <pair_range Pairs>
timed_batch<item_of<Pairs>> timed(const vertex_rows& positions, const Pairs& pairs,
                                  const time_options& options) {
    return {input_of(positions, pairs), options};
}
template <query_range Queries>
timed_batch<item_of<Queries>> timed(const Queries& queries, const time_options& options) {
    return {input_of(queries), options};
}

template <class Item>
std::vector<first_contact> contacts_of_items(const batch_input<Item>& queries,
                                             std::span<const first_time> times, int threads);
template <class Item>
std::vector<time_derivative> derivatives_of_items(const batch_input<Item>& queries,
                                                  std::span<const first_contact> contacts,
                                                  int threads);

}  // namespace detail

/// Calls decide_within for many queries. Throws as timed_contacts. Cost, for pairs: less than twice
/// that of decide_batch, if distances are far below the edge lengths and few pairs come within
/// their distance.
template <pair_range Pairs>
std::vector<outcome> decide_within_batch(const vertex_rows& positions, const Pairs& pairs,
                                         const time_options& options = {}) {
    return detail::timed(positions, pairs, options).decisions();
}
template <query_range Queries>
std::vector<outcome> decide_within_batch(const Queries& queries, const time_options& options = {}) {
    return detail::timed(queries, options).decisions();
}

/// Returns the queries that collide in [0, t_max], with their first times, and those that are
/// `uncertain` because a coordinate is not finite; ascending. All others are separate.
///
/// Throws std::invalid_argument as decide_batch, and if t_max is not finite or a distance is
/// negative or not finite. Also throws if `all` and `thickness` are both given, the numbers of
/// thicknesses and vertices differ, or queries by value have a thickness. Cost: that of
/// decide_batch or decide_within_batch, plus the times: some 0.15 to 0.5 µs for a vertex/face or
/// edge/edge contact, a time_of_impact for other kinds, a time_within with distances.
template <pair_range Pairs>
std::vector<timed_contact> timed_contacts(const vertex_rows& positions, const Pairs& pairs,
                                          const time_options& options = {}) {
    return detail::timed(positions, pairs, options).contacts();
}
template <query_range Queries>
std::vector<timed_contact> timed_contacts(const Queries& queries,
                                          const time_options& options = {}) {
    return detail::timed(queries, options).contacts();
}

/// Returns one time for each query. If few queries collide, timed_contacts is faster, since
/// first_times writes 24 bytes for each query.
template <pair_range Pairs>
std::vector<first_time> first_times(const vertex_rows& positions, const Pairs& pairs,
                                    const time_options& options = {}) {
    return detail::timed(positions, pairs, options).times();
}
template <query_range Queries>
std::vector<first_time> first_times(const Queries& queries, const time_options& options = {}) {
    return detail::timed(queries, options).times();
}

/// Returns the earliest time and its queries. With distances, this is cheaper than all times: only
/// times before the least one found are computed.
template <pair_range Pairs>
earliest_time earliest(const vertex_rows& positions, const Pairs& pairs,
                       const time_options& options = {}) {
    return detail::timed(positions, pairs, options).earliest();
}
template <query_range Queries>
earliest_time earliest(const Queries& queries, const time_options& options = {}) {
    return detail::timed(queries, options).earliest();
}

/// Returns contact_at for each query and its first time, on at most `threads` threads (0: one per
/// core). Throws std::invalid_argument if the numbers of queries and times differ, an index is out
/// of range or positions are null.
template <pair_range Pairs>
std::vector<first_contact> first_contacts(const vertex_rows& positions, const Pairs& pairs,
                                          std::span<const first_time> times, int threads = 0) {
    return detail::contacts_of_items(detail::input_of(positions, pairs), times, threads);
}
template <query_range Queries>
std::vector<first_contact> first_contacts(const Queries& queries, std::span<const first_time> times,
                                          int threads = 0) {
    return detail::contacts_of_items(detail::input_of(queries), times, threads);
}

/// Returns derivative_of for each query and its first contact. Threads and exceptions: as
/// first_contacts.
template <pair_range Pairs>
std::vector<time_derivative> time_derivatives(const vertex_rows& positions, const Pairs& pairs,
                                              std::span<const first_contact> contacts,
                                              int threads = 0) {
    return detail::derivatives_of_items(detail::input_of(positions, pairs), contacts, threads);
}
template <query_range Queries>
std::vector<time_derivative> time_derivatives(const Queries& queries,
                                              std::span<const first_contact> contacts,
                                              int threads = 0) {
    return detail::derivatives_of_items(detail::input_of(queries), contacts, threads);
}

}  // namespace ccd
