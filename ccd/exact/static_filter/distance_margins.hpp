// How far Y and the G_i must be from zero for the features to be farther apart than a distance.
//
// |Y|/|N| is the distance of the vertex from the face's plane, or of the two edges' lines. Where
// some G_i is negative, |G_i|/(|N|·L), with L the length of the face's edge i, or of the other
// edge, is how far the vertex, dropped onto the plane, is from the face, or one edge from the line
// of the other. Distances of what is dropped onto a plane are at most those themselves. So where
// Y's size exceeds d·|N|, or that of a negative G_i d·|N|·L, the features are farther apart than d.
// Proof: proofs/DistanceMargins.v, plane_face_apart, plane_edges_apart, outside_face_apart,
// outside_edges_apart.
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
/// The longest of what G_i are measured by.
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

/// Added to the errors of the control values on the whole step, these exclude parts for a distance
/// `d`, and so do they on parts: |N| is at most the longest of its control vectors, a length that
/// of one end. Proof: proofs/DistanceMargins.v, margins_face_apart, margins_edges_apart.
///
/// N's control vectors are off by less than 2^-48 of the extents' products, 6ε of each term's size;
/// what else is lost is less than the part 2^-40 that is added. Underflow: the squares of an N
/// below 2^-516 may lose all, where 2^-48 of the products makes up for it, or these are below
/// 2^-468. But then the product of all three is below 2^-702, and no value of Y exceeds its error,
/// 2^-669 at least; likewise of G_i where lengths are below 2^-516.
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
