// Margins of Y and the G_i that prove that the features are farther apart than a distance d.
//
// |Y|/|N| is the distance of the vertex from the face's plane, or of the two edges' lines. After
// projection along N, |G_i|/(|N|·l) is a distance too if G_i < 0: of the vertex from the line of
// the face's edge i, or of one edge from the other's line; l is the length of edge i or the other
// edge. Projection does not increase distances. So |Y| > d·|N|, or a negative G_i with |G_i| >
// d·|N|·l, proves a distance above d. Proof: proofs/filters/DistanceMargins.v, plane_face_apart,
// plane_edges_apart, outside_face_apart, outside_edges_apart.
#pragma once

#include <algorithm>
#include <ccd/methods/forms.hpp>
#include <cmath>
#include <errbound/roots/control_values.hpp>

#include "ccd/exact/static_filter/difference_extents.hpp"
#include "ccd/exact/static_filter/whole_step.hpp"

namespace ccd::static_filter {

namespace detail {

template <class S>
constexpr S longer(const S& length, const vector_form<S, 1>& v) {
    using std::max, std::sqrt;
    S squared(0.0);
    for (const int end : {0, 1})
        squared = max(squared, S(v.x[end] * v.x[end] + v.y[end] * v.y[end] + v.z[end] * v.z[end]));
    return max(length, S(sqrt(squared)));
}
template <class S>
constexpr S longest(const vertex_face_forms<S>& f) {
    const vector_form<S, 1> third{f.c.x - f.b.x, f.c.y - f.b.y, f.c.z - f.b.z};
    return longer(longer(longer(S(0.0), f.b), f.c), third);
}
template <class S>
constexpr S longest(const edge_edge_forms<S>& f) {
    return longer(longer(S(0.0), f.b), f.c);
}

}  // namespace detail

/// Margins for the distance d. The features are farther apart than d throughout an interval if all
/// control values of Y there exceed error + margin in size, with one sign. The same holds if all of
/// a G_i are below −(error + margin). Reason: |N| is at most its longest control vector over the
/// step, and a length is at most the longer of those at the ends. Proof:
/// proofs/filters/DistanceMargins.v, margins_face_apart, margins_edges_apart.
///
/// Errors: N's control vectors have an error of less than 2^-48 times the extents' products (6ε of
/// each term's size); the factor 1 + 2^-40 covers the rest. Squares of an N below 2^-516 may
/// underflow. Then 2^-48 of the products suffices, or the products are below 2^-468. If they are,
/// the product of all three extents is below 2^-702, and no value of Y exceeds its error, at least
/// 2^-669. The same holds for G_i if lengths are below 2^-516.
template <class S, class Forms>
constexpr form_errors<S> distance_margins(const Forms& f, const difference_extents<S>& m,
                                          double d) {
    using std::max, std::sqrt;
    S squared(0.0);
    for (int i = 0; i <= 2; ++i) {
        const S x = f.n.x[i], y = f.n.y[i], z = f.n.z[i];
        const S of_control_values(i == 1 ? 0.25 : 1.0);
        squared = max(squared, S((x * x + y * y + z * z) * of_control_values));
    }
    const S normal = sqrt(squared) + (m.x * m.y + m.y * m.z + m.z * m.x) * S(0x1p-48);
    const S least = normal * S(d * (1 + 0x1p-40));
    using errbound::roots::multiple;
    return {least * S(double(multiple(3)) * (1 + 0x1p-40)),
            least * (detail::longest(f) * S(double(multiple(4)) * (1 + 0x1p-40)))};
}

}  // namespace ccd::static_filter
