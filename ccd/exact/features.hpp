// What the exact decisions share: a cheap rejection of vertex/edge queries, and the contact of two
// vertices over any exact scalar.
#pragma once

#include <ccd/methods/forms.hpp>
#include <ccd/methods/transform.hpp>
#include <ccd/query.hpp>

namespace ccd::detail {

/// True if some coordinate axis separates v from the edge the same way at t = 0 and at t = 1, and
/// therefore, the motion being linear, throughout. Proof: proofs/AxisUnits.v, separated_right.
constexpr bool separated_by_coordinates(const vertex_edge<double>& q) {
    bool apart = false;
    for (const auto axis : {&point<double>::x, &point<double>::y, &point<double>::z}) {
        const double v0 = q.v.t0.*axis, v1 = q.v.t1.*axis;
        const double a0 = q.e0.t0.*axis, a1 = q.e0.t1.*axis;
        const double b0 = q.e1.t0.*axis, b1 = q.e1.t1.*axis;
        // Without branches: which axis separates them, if any, is as good as random.
        const bool above = (v0 > a0) & (v1 > a1) & (v0 > b0) & (v1 > b1);
        const bool below = (v0 < a0) & (v1 < a1) & (v0 < b0) & (v1 < b1);
        apart |= above | below;
    }
    return apart;
}

/// W(t) = 0 for the linear W from w0 to w1: they are antiparallel, or one of them is zero.
/// Proof: proofs/Contact.v, vertex_vertex_contact; proofs/AxisUnits.v, vertices_contact_right.
template <class S>
constexpr bool vertices_touch(const vertex_vertex<S>& query) {
    const auto w = difference(query.v, query.w);
    const vector_form<S, 0> w0{{{w.x[0]}}, {{w.y[0]}}, {{w.z[0]}}};
    const vector_form<S, 0> w1{{{w.x[1]}}, {{w.y[1]}}, {{w.z[1]}}};
    const auto c = cross(w0, w1);
    return c.x[0] == 0 && c.y[0] == 0 && c.z[0] == 0 && dot(w0, w1)[0] <= 0;
}

}  // namespace ccd::detail
