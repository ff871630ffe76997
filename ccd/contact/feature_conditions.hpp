// The conditions of contact and of distance, for each kind of query: those of the head of
// ccd/exact/reference.cpp, and for distance Z <= 0 between features of each dimension, where the
// nearest points are inside both. Internal.
//
// The least distance of two features is attained inside both, or on an edge, or at a vertex; where
// N = 0, or an edge has no length, in a lower dimension. So the union is complete; and each
// condition says that some two points of the features are that near, so that it is not too large.
#pragma once

#include <array>
#include <ccd/kind.hpp>
#include <ccd/methods/forms.hpp>
#include <cstddef>
#include <utility>
#include <vector>

#include "ccd/contact/condition.hpp"
#include "ccd/contact/time_polynomial.hpp"

namespace ccd::detail {

/// The moving points of a query.
template <kind K>
struct paths;
template <>
struct paths<kind::vertex_face> {
    path v, f0, f1, f2;
};
template <>
struct paths<kind::edge_edge> {
    path a0, a1, b0, b1;
};
template <>
struct paths<kind::vertex_edge> {
    path v, e0, e1;
};
template <>
struct paths<kind::vertex_vertex> {
    path v, w;
};

inline staged_polynomial staged(const errbound::bernstein<time_polynomial, 0>& p) {
    return staged_polynomial(p[0].coefficients());
}
inline std::vector<staged_polynomial> staged(const path& p) {
    return {staged(p.x), staged(p.y), staged(p.z)};
}
template <std::size_t N>
std::vector<staged_polynomial> staged(
    const std::array<errbound::bernstein<time_polynomial, 0>, N>& all) {
    std::vector<staged_polynomial> r;
    for (const auto& p : all) r.push_back(staged(p));
    return r;
}

inline auto forms_of(const paths<kind::vertex_face>& q) {
    const auto& [v, f0, f1, f2] = q;
    return vertex_face_forms<time_polynomial, 0>(f1 - f0, f2 - f0, v - f0);
}
inline auto forms_of(const paths<kind::edge_edge>& q) {
    const auto& [a0, a1, b0, b1] = q;
    return edge_edge_forms<time_polynomial, 0>(a1 - a0, b1 - b0, b0 - a0);
}

/// The vertex/edge pairs at the border of both features, the first of each the vertex.
inline std::array<paths<kind::vertex_edge>, 3> edges_of(const paths<kind::vertex_face>& q) {
    const auto& [v, f0, f1, f2] = q;
    return {{{v, f0, f1}, {v, f1, f2}, {v, f2, f0}}};
}
inline std::array<paths<kind::vertex_edge>, 4> edges_of(const paths<kind::edge_edge>& q) {
    const auto& [a0, a1, b0, b1] = q;
    return {{{a0, b0, b1}, {a1, b0, b1}, {b0, a0, a1}, {b1, a0, a1}}};
}
/// The vertex/vertex pairs.
inline std::array<paths<kind::vertex_vertex>, 3> corners_of(const paths<kind::vertex_face>& q) {
    const auto& [v, f0, f1, f2] = q;
    return {{{v, f0}, {v, f1}, {v, f2}}};
}
inline std::array<paths<kind::vertex_vertex>, 4> corners_of(const paths<kind::edge_edge>& q) {
    const auto& [a0, a1, b0, b1] = q;
    return {{{a0, b0}, {a0, b1}, {a1, b0}, {a1, b1}}};
}
inline std::array<paths<kind::vertex_vertex>, 2> corners_of(const paths<kind::vertex_edge>& q) {
    const auto& [v, e0, e1] = q;
    return {{{v, e0}, {v, e1}}};
}

/// W = 0.
inline condition contact_condition(const paths<kind::vertex_vertex>& q) {
    return {staged(q.v - q.w), {}, {}};
}
/// W × E = 0 and W·(E − W) >= 0: of an edge without length it asks W = 0.
inline condition contact_condition(const paths<kind::vertex_edge>& q) {
    const auto& [v, e0, e1] = q;
    const path w = v - e0;
    return {staged(cross(w, e1 - e0)), {staged(dot(w, e1 - v))}, {}};
}

/// Of VF and EE at times at which Y = 0.
template <kind K>
std::vector<condition> contact_conditions(const paths<K>& q) {
    if constexpr (K == kind::vertex_vertex || K == kind::vertex_edge) {
        return {contact_condition(q)};
    } else {
        const auto forms = forms_of(q);
        std::vector<condition> all{{{}, staged(forms.inside()), staged(forms.n)}};
        for (const auto& edge : edges_of(q)) all.push_back(contact_condition(edge));
        return all;
    }
}

/// |W|² − D
inline condition distance_condition(const paths<kind::vertex_vertex>& q,
                                    const time_polynomial& squared) {
    const path w = q.v - q.w;
    return {{staged(dot(w, w) - errbound::bernstein<time_polynomial, 0>{{squared}})}, {}, {}, true};
}
/// |E × W|² − D E·E, on an edge that has a length, with the nearest point between its ends.
inline condition distance_condition(const paths<kind::vertex_edge>& q,
                                    const time_polynomial& squared) {
    const auto& [v, e0, e1] = q;
    const path w = v - e0, e = e1 - e0, moment = cross(e, w);
    const errbound::bernstein<time_polynomial, 0> d{{squared}};
    return {{staged(dot(moment, moment) - d * dot(e, e))},
            {staged(dot(w, e)), staged(dot(e1 - v, e))},
            staged(e),
            true};
}
/// (N·P)² − D N·N, where the plane or the pair of lines is one, and the nearest points inside.
template <class Forms>
condition distance_condition_inside(const Forms& forms, const time_polynomial& squared) {
    const errbound::bernstein<time_polynomial, 0> d{{squared}};
    const auto y = forms.y();
    return {{staged(y * y - d * forms.normal_squared())},
            staged(forms.inside()),
            staged(forms.n),
            true};
}

/// Distance² <= D, all axes in one unit.
/// Proof: proofs/Distance.v, vertex_edge_within, face_within_union, edges_within_union.
template <kind K>
std::vector<condition> distance_conditions(const paths<K>& q, const time_polynomial& squared) {
    if constexpr (K == kind::vertex_vertex) {
        return {distance_condition(q, squared)};
    } else {
        std::vector<condition> all;
        for (const auto& corner : corners_of(q)) all.push_back(distance_condition(corner, squared));
        if constexpr (K == kind::vertex_edge) {
            all.push_back(distance_condition(q, squared));
        } else {
            for (const auto& edge : edges_of(q)) all.push_back(distance_condition(edge, squared));
            all.push_back(distance_condition_inside(forms_of(q), squared));
        }
        return all;
    }
}

}  // namespace ccd::detail
