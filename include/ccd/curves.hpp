// Motion along curves: points that move by polynomials in t of any degree.
//
// The decisions and first times of ccd/exact.hpp, ccd/contact.hpp and ccd/separation.hpp, with the
// same meaning and as exact, for points given in Bernstein form (Bézier curves in time). Floating
// point under tracked bounds decides what is clearly separate; the rest is decided in unbounded
// integers, as ccd/reference.hpp says. Allocates; throws only std::bad_alloc.
//
// What else motion is given by has this form: degrees may differ from point to point, a power basis
// converts, and a B-spline is the Bézier pieces that knot insertion makes of it.
#pragma once

#include <algorithm>
#include <ccd/contact.hpp>
#include <ccd/query.hpp>
#include <ccd/separation.hpp>
#include <ccd/verdict.hpp>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>

namespace ccd {

/// A point's motion, x(t) = Σ C(m, i)(1 − t)^(m−i) t^i c_i for t in [0, 1], by its m + 1 control
/// points: one for a point at rest, two for motion along a line at constant speed. Not owned.
using curve = std::span<const point<double>>;

/// The four kinds of query (ccd/query.hpp), with every point on a curve of its own.
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

/// As decide_exact of ccd/exact.hpp; `uncertain` only if a coordinate is not finite or a curve has
/// no control point.
verdict decide_exact(const vertex_face_curves& query);
verdict decide_exact(const edge_edge_curves& query);
verdict decide_exact(const vertex_edge_curves& query);
verdict decide_exact(const vertex_vertex_curves& query);

/// As time_of_impact of ccd/contact.hpp. The first time is algebraic, of degree 3m at most for
/// curves of degree m.
first_time time_of_impact(const vertex_face_curves& query, double t_max = 1);
first_time time_of_impact(const edge_edge_curves& query, double t_max = 1);
first_time time_of_impact(const vertex_edge_curves& query, double t_max = 1);
first_time time_of_impact(const vertex_vertex_curves& query, double t_max = 1);

/// As decide_within and time_within of ccd/separation.hpp.
verdict decide_within(const vertex_face_curves& query, separation d);
verdict decide_within(const edge_edge_curves& query, separation d);
verdict decide_within(const vertex_edge_curves& query, separation d);
verdict decide_within(const vertex_vertex_curves& query, separation d);
first_time time_within(const vertex_face_curves& query, separation d, double t_max = 1);
first_time time_within(const edge_edge_curves& query, separation d, double t_max = 1);
first_time time_within(const vertex_edge_curves& query, separation d, double t_max = 1);
first_time time_within(const vertex_vertex_curves& query, separation d, double t_max = 1);

/// One piece of motion along splines: between two knots, t from 0 to 1 as time goes from `from` to
/// `to`.
template <class Curves>
struct spline_piece {
    double from = 0, to = 1;
    Curves motion;
};

/// The first time of motion in pieces.
struct spline_time {
    ccd::outcome outcome = ccd::outcome::uncertain;
    std::size_t piece = 0;  ///< the first piece with such a time, or that is uncertain
    first_time in_piece;    ///< when, in that piece's t: exact as always
    /// Where there is one: it is between these, within some units in the last place of knots; at a
    /// knot they are that knot.
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

/// When the features first touch, or come within d if given, of consecutive pieces: a contiguous
/// range of spline_piece of one kind. Knots are finite and ascend.
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
