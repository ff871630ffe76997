#include <algorithm>
#include <ccd/contact.hpp>
#include <ccd/kind.hpp>
#include <ccd/methods/forms.hpp>
#include <ccd/methods/transform.hpp>
#include <initializer_list>

#include "ccd/contact/data/normal.hpp"
#include "ccd/exact/unbounded_integers.hpp"

namespace ccd {
namespace {

using detail::integer;
using errbound::sign_type;

struct sides {
    sign_type before, after;
};

template <int N>
sides sides_of(const errbound::bernstein<integer, N>& f, const first_time& time) {
    const bool exact = time.low == time.high;
    return {detail::sign_beside(f, time.low, exact), detail::sign_beside(f, time.high, !exact)};
}

/// The sign of a polynomial that is not zero is not zero just before or after a time.
contact_motion motion_of(const first_time& time, std::initializer_list<sides> all) {
    const auto moves = [](const sides& s) { return s.after != sign_type::zero; };
    const auto crosses = [](const sides& s) { return s.before != s.after; };
    if (std::ranges::none_of(all, moves)) return contact_motion::slides;
    if (time.at_start()) return contact_motion::unknown;
    return std::ranges::any_of(all, crosses) ? contact_motion::approaches : contact_motion::touches;
}

/// W = (v − e0) × (e1 − e0) is zero where v is on the edge's line.
contact_motion motion_beside_edge(const vertex_edge<double>& query, const first_time& time) {
    const vertex_edge<integer> q = detail::to_integers(query);
    const auto w = cross(difference(q.v, q.e0), difference(q.e1, q.e0));
    return motion_of(time, {sides_of(w.x, time), sides_of(w.y, time), sides_of(w.z, time)});
}

/// Vertices that meet after the start have a relative velocity.
contact_motion motion_of_vertices(const vertex_vertex<double>& query, const first_time& time) {
    if (!time.at_start()) return contact_motion::approaches;
    return query.v.t1 == query.w.t1 ? contact_motion::slides : contact_motion::unknown;
}

}  // namespace

template <any_query Query>
contact_motion motion_after(const Query& query, const first_contact& contact) {
    const bool any = std::ranges::any_of(contact.weights, [](double w) { return w > 0; });
    if (contact.time.outcome != outcome::collides || !any) return contact_motion::unknown;
    if (contact.sided && contact.normal_from != normal_source::relative_velocity &&
        contact.normal_velocity < -contact.normal_velocity_error)
        return contact_motion::approaches;
    if constexpr (is_cubic(kind_of<Query>)) {
        const sides of_plane = sides_of(forms_of(detail::to_integers(query)).y(), contact.time);
        if (of_plane.after != sign_type::zero || contact.time.at_start())
            return motion_of(contact.time, {of_plane});
    }
    const auto points = points_of(query);
    const auto& i = contact.features.points;
    if (contact.features.kind == kind::vertex_vertex)
        return motion_of_vertices({points[i[0]], points[i[1]]}, contact.time);
    if (contact.features.kind == kind::vertex_edge)
        return motion_beside_edge({points[i[0]], points[i[1]], points[i[2]]}, contact.time);
    return contact_motion::slides;
}

template contact_motion motion_after(const vertex_face<double>&, const first_contact&);
template contact_motion motion_after(const edge_edge<double>&, const first_contact&);
template contact_motion motion_after(const vertex_edge<double>&, const first_contact&);
template contact_motion motion_after(const vertex_vertex<double>&, const first_contact&);

}  // namespace ccd
