// First contact: the first time at which the features of a query touch, exactly.
//
// Closed semantics as in ccd/exact.hpp, of which this is the other half: what `exact` says yes to
// has a first time, t*. It is 0, a rational number, or a root of a quadratic or a cubic, and seldom
// a double; so it comes as a bracket of two neighbouring doubles, which no arithmetic can narrow,
// or as the double that it is. Every case is answered so: planar motion, touching without crossing,
// parallel edges, degenerate triangles.
//
// No allocation and no exceptions but in the last stage, which is that of ccd/reference.hpp.
#pragma once

#include <ccd/query.hpp>
#include <ccd/verdict.hpp>

namespace ccd {

/// The first time in [0, t_max] at which something holds; by default nothing is decided.
struct first_time {
    /// `collides`: there is one. `separate`: there is none. `uncertain`: a coordinate, or t_max, is
    /// not finite.
    ccd::outcome outcome = ccd::outcome::uncertain;
    /// Where there is one: the time itself if low == high, else two neighbouring doubles between
    /// which it lies. It holds nowhere in [0, low), nor at `low` if low < high.
    double low = 0, high = 0;

    /// Whether it holds at t = 0 already. (A first time below the least double above 0 has low = 0,
    /// too, but not high.)
    constexpr bool at_start() const { return outcome == ccd::outcome::collides && high == 0; }

    friend constexpr bool operator==(const first_time&, const first_time&) = default;
};

/// When the features first touch, for t in [0, t_max]; of a t_max above 1, in [0, 1]; there is no
/// time in [0, t_max] if t_max < 0.
first_time time_of_impact(const vertex_face<double>& query, double t_max = 1);
first_time time_of_impact(const edge_edge<double>& query, double t_max = 1);
first_time time_of_impact(const vertex_edge<double>& query, double t_max = 1);
first_time time_of_impact(const vertex_vertex<double>& query, double t_max = 1);

}  // namespace ccd
