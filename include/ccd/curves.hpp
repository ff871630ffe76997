// Motion along curves: points that move by polynomials in t of any degree.
//
// The calls of ccd/exact.hpp and ccd/contact.hpp, equally exact, for points in Bernstein form
// (Bézier curves in time). Degrees may differ from point to point. A power basis converts to this
// form; knot insertion converts a B-spline to Bézier pieces. Floating point under tracked bounds
// decides clearly separate queries, unbounded integers the others (ccd/reference.hpp). Allocates;
// throws only std::bad_alloc.
#pragma once

#include <algorithm>
#include <ccd/kind.hpp>
#include <ccd/query.hpp>
#include <ccd/verdict.hpp>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>

namespace ccd {

/// The m + 1 control points c_i of x(t) = Σ C(m, i)(1 − t)^(m−i) t^i c_i for t in [0, 1]: one for a
/// point at rest, two for motion along a line at constant speed. Not owned.
using curve = std::span<const point<double>>;

/// The four kinds of query (ccd/query.hpp), with a curve for each point.
struct vertex_face_curves {
    curve v, f0, f1, f2;
};
struct edge_edge_curves {
    curve a0, a1, b0, b1;
};
struct vertex_edge_curves {
    curve v, e0, e1;
};
struct vertex_vertex_curves {
    curve v, w;
};

namespace detail {

template <>
struct kind_constant<vertex_face_curves> : kind_constant<vertex_face<double>> {};
template <>
struct kind_constant<edge_edge_curves> : kind_constant<edge_edge<double>> {};
template <>
struct kind_constant<vertex_edge_curves> : kind_constant<vertex_edge<double>> {};
template <>
struct kind_constant<vertex_vertex_curves> : kind_constant<vertex_vertex<double>> {};

}  // namespace detail

/// One of the four kinds above.
template <class T>
concept curve_query = std::same_as<T, vertex_face_curves> || std::same_as<T, edge_edge_curves> ||
    std::same_as<T, vertex_edge_curves> || std::same_as<T, vertex_vertex_curves>;

/// Same as decide_exact of ccd/exact.hpp. `uncertain` only if a coordinate is not finite or a curve
/// has no control point.
template <curve_query Query>
verdict decide_exact(const Query& query);

/// Same as in ccd/contact.hpp. For curves of degree m the first time has algebraic degree <= 3m.
template <curve_query Query>
first_time time_of_impact(const Query& query, double t_max = 1);
template <curve_query Query>
verdict decide_within(const Query& query, separation d);
template <curve_query Query>
first_time time_within(const Query& query, separation d, double t_max = 1);

/// The motion between two knots of splines: t goes from 0 to 1 as time goes from `from` to `to`.
template <class Curves>
struct spline_piece {
    double from = 0, to = 1;
    Curves motion;
};

/// The first time of motion along splines.
struct spline_time {
    ccd::outcome outcome = ccd::outcome::uncertain;
    std::size_t piece = 0;  ///< the first piece with a first time, or that is uncertain
    first_time in_piece;    ///< exact, in that piece's t
    /// Bounds of the first time, some units in the last place apart; at a knot both are the knot.
    double low = 0, high = 0;
};

namespace detail {

/// Bounds of from + t(to − from).
inline std::pair<double, double> time_between(double from, double to, double t) {
    if (t == 0) return {from, from};
    if (t == 1) return {to, to};
    const double x = (1 - t) * from + t * to;
    const double error =
        4 * std::numeric_limits<double>::epsilon() * (std::max)(std::abs(from), std::abs(to)) +
        4 * std::numeric_limits<double>::denorm_min();
    return {(std::max)(from, x - error), (std::min)(to, x + error)};
}

}  // namespace detail

/// Returns the first time at which the features touch, or come within d, over consecutive pieces: a
/// contiguous range of spline_piece of one kind. Precondition: knots are finite and ascend.
template <class Pieces>
spline_time first_time_of_pieces(const Pieces& pieces, separation d = {}) {
    for (std::size_t i = 0; i < std::size(pieces); ++i) {
        const first_time found = time_within(pieces[i].motion, d);
        if (found.outcome == outcome::separate) continue;
        if (found.outcome == outcome::uncertain) return {outcome::uncertain, i, found, 0, 0};
        const double from = pieces[i].from, to = pieces[i].to;
        return {outcome::collides, i, found, detail::time_between(from, to, found.low).first,
                detail::time_between(from, to, found.high).second};
    }
    return {outcome::separate, 0, {outcome::separate, 0, 0}, 0, 0};
}

}  // namespace ccd
