#include <algorithm>
#include <ccd/contact.hpp>
#include <ccd/exact.hpp>
#include <ccd/kind.hpp>
#include <ccd/methods/transform.hpp>
#include <ccd/reference.hpp>
#include <cmath>
#include <limits>
#include <span>

#include "ccd/contact/first_times.hpp"
#include "ccd/contact/separation_filter.hpp"
#include "ccd/exact/finite.hpp"

namespace ccd {
namespace {

using moving_points = std::span<const moving_point<double>>;

/// True if p is above q by more than `distance` at both ends of the step, and therefore throughout.
/// Rounding is monotone: if the rounded difference exceeds a double, so does the difference.
bool above(moving_points p, moving_points q, double point<double>::*axis, double distance) {
    return std::all_of(p.begin(), p.end(), [&](const moving_point<double>& x) {
        return std::all_of(q.begin(), q.end(), [&](const moving_point<double>& y) {
            return x.t0.*axis - y.t0.*axis > distance && x.t1.*axis - y.t1.*axis > distance;
        });
    });
}

/// Proof: proofs/times/Separation.v, coordinates_apart, vertices_apart, vertex_edge_apart,
/// face_apart, edges_apart.
template <class Query>
bool separated_by_distance(const Query& query, separation d) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    constexpr auto first = kind_traits<kind_of<Query>>::first_vertices;
    const auto points = points_of(query);
    const moving_points p = std::span(points).first(first), q = std::span(points).subspan(first);
    const double distance = std::nextafter(d.first + d.second, infinity);
    for (const auto axis : {&point<double>::x, &point<double>::y, &point<double>::z})
        if (above(p, q, axis, distance) || above(q, p, axis, distance)) return true;
    return false;
}

}  // namespace

template <any_query Query>
verdict decide_within(const Query& query, separation d) {
    if (!detail::is_distance(d) || !detail::is_finite(query))
        return {outcome::uncertain, cause::range};
    if (d.first == 0 && d.second == 0) return decide_exact(query);
    if (separated_by_distance(query, d)) return {outcome::separate, cause::none};
    const outcome answer = detail::separation_filter::features(query, d).decide();
    if (answer != outcome::uncertain) return {answer, cause::none};
    return decide_within_reference(query, d);
}

template <any_query Query>
first_time time_within(const Query& query, separation d, double t_max) {
    if (!detail::is_distance(d) || !detail::is_finite(query) || !std::isfinite(t_max)) return {};
    if (d.first == 0 && d.second == 0) return time_of_impact(query, t_max);
    if (separated_by_distance(query, d) ||
        detail::separation_filter::features(query, d).decide() == outcome::separate)
        return {outcome::separate, 0, 0};
    return detail::first_within_of(query, d, t_max, detail::arithmetic::floating_point_first);
}

template verdict decide_within(const vertex_face<double>&, separation);
template verdict decide_within(const edge_edge<double>&, separation);
template verdict decide_within(const vertex_edge<double>&, separation);
template verdict decide_within(const vertex_vertex<double>&, separation);

template first_time time_within(const vertex_face<double>&, separation, double);
template first_time time_within(const edge_edge<double>&, separation, double);
template first_time time_within(const vertex_edge<double>&, separation, double);
template first_time time_within(const vertex_vertex<double>&, separation, double);

}  // namespace ccd
