// Nearest features, nearest points, distance and normal of two features at one time.
//
//     ccd::nearness n = ccd::nearness_of(query);                    // at the start
//     ccd::nearness n = ccd::nearness_of(query, time.low);          // at any time of the step
//     auto data = ccd::nearnesses(positions, pairs);                // many queries, over threads
//     auto near = ccd::near_pairs(mesh, {.all = 1e-3});             // all pairs of a mesh at rest
//     double gap = ccd::least_distance(mesh).low;                   // and its nearest pair
//
// The features are exact for all finite coordinates, also for parallel edges and degenerate
// triangles. All numbers have certified errors. Results do not depend on instruction sets or
// threads. Calls for one query do not throw, and rarely allocate. Others throw
// std::invalid_argument for bad input.
#pragma once

#include <array>
#include <ccd/contact.hpp>
#include <ccd/kind.hpp>
#include <ccd/mesh.hpp>
#include <ccd/query.hpp>
#include <ccd/step.hpp>
#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace ccd {

/// The nearest features of a query, and the data of their nearest points. Points are numbered as in
/// first_contact.
///
/// The features are the smallest between which the distance is attained: two vertices, else a
/// vertex and an edge, else the query's features. If several are of that size, the first counts, in
/// this order: v with f0, f1, f2, then with f0f1, f1f2, f2f0. For edges: a0 with b0, b1, then a1
/// with b0, b1, then a0 and a1 with edge b, b0 and b1 with edge a.
struct nearness {
    static constexpr double unknown = std::numeric_limits<double>::infinity();

    meeting_features features;
    /// One weight in [0, 1] for each point, 0 for points not among `features`. Each feature's
    /// weights add up to 1 within one rounding. The weighted sum of its points is its nearest
    /// point. Without data all weights are 0 (test this) and errors infinite.
    std::array<double, 4> weights{};
    double weight_error = unknown;  ///< of each weight
    /// Distances that overflow are infinite, with infinite errors.
    double squared_distance = 0, squared_distance_error = unknown;
    double distance = 0, distance_error = unknown;
    /// From the second feature towards the first, of unit length. (0, 0, 0) with an infinite error
    /// if the features touch.
    point<double> normal{};
    double normal_error = unknown;  ///< length of the error

    /// True if the distance is exactly 0.
    constexpr bool touches() const { return distance == 0 && distance_error == 0; }

    friend constexpr bool operator==(const nearness&, const nearness&) = default;
};

/// Returns the data at t, for the exact positions (1 − t)·t0 + t·t1. At t = 0 it does not read t1,
/// at t = 1 not t0. There are no data if a coordinate is not finite or t is not in [0, 1].
///
/// The errors of weights and normal are at most 2^-24, those of distances at most 2^-24 of their
/// values. Exceptions are distances that overflow or are subnormal, and the normal of features that
/// touch.
///
/// Cost: some 30 to 90 ns; 0.2 to 0.3 µs for degenerate positions; microseconds, with allocations,
/// if coordinates span more than 125 bits, or if the time is inside the step and floating point
/// does not suffice.
template <any_query Query>
nearness nearness_of(const Query& query, double t = 0);

struct nearness_options {
    double t = 0;                             ///< in [0, 1]
    int threads = 0;                          ///< at most; 0: one per core
    std::optional<instruction_set> set = {};  ///< for pairs at t = 0; by default the strongest
    stop_query stop = {};                     ///< ends the call by throwing ccd::stopped
};

namespace detail {

/// With times, those of `options` are not used.
template <class Item>
std::vector<nearness> nearnesses_of_items(const batch_input<Item>& queries,
                                          const std::span<const first_time>* times,
                                          const nearness_options& options);

template <kind K>
using nearnesses_of_kind = std::vector<nearness>;

}  // namespace detail

/// Returns nearness_of each query at options.t. For pairs at t = 0, positions at t = 1 may be null.
/// Throws std::invalid_argument if t is not in [0, 1], an index is out of range or positions are
/// null.
template <pair_range Pairs>
std::vector<nearness> nearnesses(const vertex_rows& positions, const Pairs& pairs,
                                 const nearness_options& options = {}) {
    return detail::nearnesses_of_items(detail::input_of(positions, pairs), nullptr, options);
}
template <query_range Queries>
std::vector<nearness> nearnesses(const Queries& queries, const nearness_options& options = {}) {
    return detail::nearnesses_of_items(detail::input_of(queries), nullptr, options);
}

/// Returns nearness_of each query at times[i].low, the double at or just before its contact, if
/// `times` is a result of first_times. Queries without contact have no data. Throws also if the
/// numbers of queries and times differ.
template <pair_range Pairs>
std::vector<nearness> nearnesses(const vertex_rows& positions, const Pairs& pairs,
                                 std::span<const first_time> times,
                                 const nearness_options& options = {}) {
    return detail::nearnesses_of_items(detail::input_of(positions, pairs), &times, options);
}
template <query_range Queries>
std::vector<nearness> nearnesses(const Queries& queries, std::span<const first_time> times,
                                 const nearness_options& options = {}) {
    return detail::nearnesses_of_items(detail::input_of(queries), &times, options);
}

/// Pairs of a mesh at rest, each list sorted as step_result::pairs, and the data of each pair.
struct near_lists {
    pair_lists pairs;
    by_kind<detail::nearnesses_of_kind> data;

    friend bool operator==(const near_lists&, const near_lists&) = default;
};

struct near_options {
    int threads = 0;                          ///< at most; 0: one per core
    std::optional<instruction_set> set = {};  ///< by default the strongest
    stop_query stop = {};                     ///< ends the call by throwing ccd::stopped
    pair_filter filter = {};
};

/// Returns the pairs of the mesh at t = 0 whose exact distance is at most that of `within`; the
/// default reports pairs that touch. Pairs are those of steps (ccd/step.hpp): elements without a
/// common vertex. Positions at t = 1 are not read. Throws as mesh_steps::run. Cost: the search, a
/// nearness_of for each candidate, and sorting.
near_lists near_pairs(mesh_steps& mesh, const vertex_rows& positions, const pair_distances& within,
                      const near_options& options = {});
near_lists near_pairs(const mesh& mesh, const pair_distances& within,
                      const near_options& options = {});

/// The least distance of the pairs of a mesh. Bounds are infinite, and there are no data, if there
/// is no pair or all distances overflow.
struct least_distance_result {
    double low = nearness::unknown, high = nearness::unknown;  ///< bounds
    /// A pair whose distance is within the bounds, and its data. It is the first by
    /// nearness::distance, kind and vertices. Vertices are in the order of its kind.
    ccd::kind kind = ccd::kind::vertex_face;
    std::array<vertex_index, 4> vertices{};
    nearness data;

    friend bool operator==(const least_distance_result&, const least_distance_result&) = default;
};

/// Returns the least distance of the pairs of the mesh at t = 0. Throws as near_pairs. Cost: if
/// some boxes touch, that of two searches: for an upper bound, then for all pairs within it.
/// Otherwise, of up to a dozen searches at growing distances.
least_distance_result least_distance(mesh_steps& mesh, const vertex_rows& positions,
                                     const near_options& options = {});
least_distance_result least_distance(const mesh& mesh, const near_options& options = {});

}  // namespace ccd
