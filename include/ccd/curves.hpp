// Motion along curves: points that move by polynomials in t of any degree, or by quotients of them.
//
// The calls of ccd/exact.hpp and ccd/contact.hpp, equally exact, for points in Bernstein form
// (Bézier curves in time). Degrees may differ from point to point. A power basis converts to this
// form; knot insertion converts a B-spline to Bézier pieces. Floating point under tracked bounds
// decides clearly separate queries, unbounded integers the others (ccd/reference.hpp). Allocates;
// throws only std::bad_alloc. ccd/bodies/motion.hpp has the same calls for points of rigid bodies.
#pragma once

#include <ccd/kind.hpp>
#include <ccd/query.hpp>
#include <ccd/verdict.hpp>
#include <concepts>
#include <cstddef>
#include <span>
#include <string>
#include <utility>

namespace ccd {

/// The m + 1 control points c_i of x(t) = Σ C(m, i)(1 − t)^(m−i) t^i c_i for t in [0, 1]: one for a
/// point at rest, two for motion along a line at constant speed. Not owned.
using curve = std::span<const point<double>>;

/// The rational curve x(t) = Σ B_i(t) w_i c_i / Σ B_i(t) w_i with the control points c_i, weights
/// w_i and B_i(t) = C(m, i)(1 − t)^(m−i) t^i. Not owned.
struct rational_curve {
    curve points;
    std::span<const double> weights = {};  ///< one for each point, all > 0; none: all are 1
};

/// Returns "" if the weights are valid, else the reason, such as `weight 2 is -1; expected a finite
/// number > 0`.
std::string fault_of(const rational_curve& motion);

/// The four kinds of query (ccd/query.hpp), with any description of motion for each point.
template <class Motion>
struct vertex_face_of {
    Motion v, f0, f1, f2;
};
template <class Motion>
struct edge_edge_of {
    Motion a0, a1, b0, b1;
};
template <class Motion>
struct vertex_edge_of {
    Motion v, e0, e1;
};
template <class Motion>
struct vertex_vertex_of {
    Motion v, w;
};

using vertex_face_curves = vertex_face_of<curve>;
using edge_edge_curves = edge_edge_of<curve>;
using vertex_edge_curves = vertex_edge_of<curve>;
using vertex_vertex_curves = vertex_vertex_of<curve>;

namespace detail {

template <class Motion>
struct kind_constant<vertex_face_of<Motion>> : kind_constant<vertex_face<double>> {};
template <class Motion>
struct kind_constant<edge_edge_of<Motion>> : kind_constant<edge_edge<double>> {};
template <class Motion>
struct kind_constant<vertex_edge_of<Motion>> : kind_constant<vertex_edge<double>> {};
template <class Motion>
struct kind_constant<vertex_vertex_of<Motion>> : kind_constant<vertex_vertex<double>> {};

/// The motion of all points of a query above.
template <class Query>
struct motion_of_query;
template <template <class> class Query, class Motion>
struct motion_of_query<Query<Motion>> {
    using type = Motion;
};

/// True for the descriptions of motion that the calls below accept.
template <class Motion>
inline constexpr bool is_motion = false;
template <>
inline constexpr bool is_motion<curve> = true;
template <>
inline constexpr bool is_motion<rational_curve> = true;

inline verdict as_verdict(const first_time& found) {
    const bool certain = found.outcome != outcome::uncertain;
    return {found.outcome, certain ? cause::none : cause::range};
}

}  // namespace detail

/// One of the four kinds above.
template <class T>
concept curve_query = detail::has_kind<T> && requires {
    requires detail::is_motion<typename detail::motion_of_query<T>::type>;
};

namespace detail {

enum class answer { outcome, time };
/// Same as time_within. If only the outcome is wanted, `low` and `high` of a contact are
/// unspecified.
template <curve_query Query>
first_time first_within(const Query& query, separation d, double t_max, answer wanted);

}  // namespace detail

/// Same as in ccd/contact.hpp, and `uncertain` also if a curve has no control point or invalid
/// weights. For curves of degree m the first time has algebraic degree <= 3m, and a higher one if
/// weights differ among the points.
template <curve_query Query>
first_time time_within(const Query& query, separation d, double t_max = 1) {
    return detail::first_within(query, d, t_max, detail::answer::time);
}
template <curve_query Query>
first_time time_of_impact(const Query& query, double t_max = 1) {
    return time_within(query, {}, t_max);
}
template <curve_query Query>
verdict decide_within(const Query& query, separation d) {
    return detail::as_verdict(detail::first_within(query, d, 1, detail::answer::outcome));
}
/// Same as decide_exact of ccd/exact.hpp. `uncertain` as time_within.
template <curve_query Query>
verdict decide_exact(const Query& query) {
    return decide_within(query, {});
}

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
    /// Bounds of the first time, some units in the last place of the larger knot apart. They are
    /// equal at a knot, and if in_piece is one double and no operation rounds.
    double low = 0, high = 0;
};

namespace detail {

/// Bounds of from + t(to − from), which are equal if no operation rounds. Precondition: from <= to,
/// 0 <= t <= 1.
std::pair<double, double> time_between(double from, double to, double t);

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
