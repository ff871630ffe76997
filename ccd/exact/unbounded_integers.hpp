// Queries in unbounded integers, and their exact vertex/edge contacts, for the reference,
// `bsc-exact` and `root-parity`. Allocates. Internal.
#pragma once

#include <ccd/methods/forms.hpp>
#include <ccd/methods/transform.hpp>
#include <cstddef>
#include <errbound/integers/binary_double.hpp>
#include <errbound/integers/integer.hpp>
#include <errbound/roots/real_roots.hpp>

#include "ccd/exact/axis_units.hpp"
#include "ccd/exact/features.hpp"

namespace ccd::detail {

using errbound::integer;

/// Precondition: finite coordinates. Proof: proofs/contact/UnboundedIntegers.v, to_integers_right.
template <template <class> class Query>
Query<integer> to_integers(const Query<double>& query, const integer_units& units) {
    return units.converted(query, [](double x, int unit) {
        if (x == 0) return integer(0);
        const errbound::integers::binary_double d(x);
        return integer(d.odd_part()) << (d.last_bit() - unit);
    });
}
template <template <class> class Query>
Query<integer> to_integers(const Query<double>& query) {
    return to_integers(query, integer_units(query));
}

/// True if W × E = 0 and W·(W − E) <= 0 at some t in [0, 1] (see ccd/exact/reference.cpp). The
/// times are the roots of the three quadratics' common factor. Proof:
/// proofs/contact/UnboundedIntegers.v, integer_contact_right.
inline bool vertex_touches_edge(const vertex_edge<integer>& query) {
    const auto e = difference(query.e1, query.e0);
    const auto w = difference(query.v, query.e0);
    const auto off_line = cross(w, e);
    for (const auto* f : {&off_line.x, &off_line.y, &off_line.z})
        if (errbound::certainly_rootless(*f)) return false;
    // W·(W − E), which is <= 0 between the ends.
    const auto beyond = dot(w, difference(query.v, query.e1));
    const auto on_line_at = [&](std::size_t i) {
        return off_line.x.h[i] == 0 && off_line.y.h[i] == 0 && off_line.z.h[i] == 0;
    };
    if (on_line_at(0) && beyond.h[0] <= 0) return true;
    if (on_line_at(2) && beyond.h[2] <= 0) return true;

    // The common factor of the three, empty if the motion is collinear throughout.
    errbound::roots::integer_form<integer> on_line;
    for (const auto* f : {&off_line.x, &off_line.y, &off_line.z})
        on_line = errbound::roots::common_factor(on_line, errbound::roots::without_end_roots(*f));
    if (on_line.empty()) {
        // W·(W − E) is positive at both ends here, so a value <= 0 inside needs real roots with t/s
        // > 0.
        return beyond.h[1] < 0 && beyond.h[1] * beyond.h[1] >= 4 * beyond.h[0] * beyond.h[2];
    }
    if (on_line.size() < 2) return false;
    errbound::real_roots<integer> roots(on_line);
    for (std::size_t k = 0; k < roots.size(); ++k)
        if (roots.sign_at_root(errbound::roots::without_end_roots(beyond), k) !=
            errbound::sign_type::positive)
            return true;
    return false;
}

/// `original` is the query before its conversion. Proof: proofs/contact/UnboundedIntegers.v,
/// face_border_right, edges_border_right.
template <template <class> class Query>
bool touches_at_border(const Query<integer>& query, const Query<double>& original) {
    const auto edges = vertex_edge_queries(query);
    const auto original_edges = vertex_edge_queries(original);
    for (std::size_t i = 0; i < edges.size(); ++i)
        if (!separated_by_coordinates(original_edges[i]) && vertex_touches_edge(edges[i]))
            return true;
    return false;
}

}  // namespace ccd::detail
