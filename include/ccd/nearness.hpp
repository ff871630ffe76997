// Nearest features, nearest points, distance and normal of two features at one time.
//
//     ccd::nearness n = ccd::nearness_of(query);                 // at the start
//     ccd::nearness n = ccd::nearness_of(query, time.low);       // at any time of the step
//
// The features are exact for all finite coordinates, also for parallel edges and degenerate
// triangles. All numbers have certified errors. Coordinates that are not finite give weights 0 and
// infinite errors. Calls for one query do not throw. They allocate only if coordinates span more
// than 125 bits or the time is inside the step, and the floating-point stage is not certain.
// Cost: some 40 ns, and 0.3 µs for degenerate positions (./run bench --sections contacts).
#pragma once

#include <array>
#include <ccd/contact.hpp>
#include <ccd/kind.hpp>
#include <ccd/query.hpp>
#include <limits>

namespace ccd {

/// The nearest features of a query, and the data of their nearest points. Points are numbered as in
/// first_contact.
///
/// The features are the smallest between which the distance is attained: two vertices, else a
/// vertex and an edge, else the query's features. Of several, they are the first in this order:
/// v and f0, f1, f2, then v and f0f1, f1f2, f2f0; or a0 and b0, b1, a1 and b0, b1, then a0 and b,
/// a1 and b, b0 and a, b1 and a.
struct nearness {
    static constexpr double unknown = std::numeric_limits<double>::infinity();

    meeting_features features;
    /// One weight in [0, 1] for each point, 0 for points not among `features`. Each feature's
    /// weights add up to 1 within one rounding. The weighted sum of its points is its nearest
    /// point. Without data all weights are 0 (test this).
    std::array<double, 4> weights{};
    double weight_error = unknown;  ///< of each weight
    /// Overflow gives infinity, with an infinite error.
    double squared_distance = 0, squared_distance_error = unknown;
    double distance = 0, distance_error = unknown;
    /// From the second feature towards the first, of unit length. (0, 0, 0) with an infinite error
    /// if the features touch.
    point<double> normal{};
    double normal_error = unknown;  ///< length of the error

    /// True if the distance is exactly 0.
    bool touches() const { return distance == 0 && distance_error == 0; }

    friend constexpr bool operator==(const nearness&, const nearness&) = default;
};

/// Returns the data at t in [0, 1], exactly at the positions (1 − t)·t0 + t·t1. Any other t gives
/// no data.
///
/// Errors are at most 2^-24: of weights and normal, and of both distances relative to their values.
/// Exceptions are distances that overflow, or are subnormal, and the normal of touching features.
template <any_query Query>
nearness nearness_of(const Query& query, double t = 0);

}  // namespace ccd
