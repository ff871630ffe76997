// The conditions of contact (listed in ccd/exact/reference.cpp) and of distance for each kind of
// query, over any ring R of polynomials in t. Internal. The conditions of distance are Z <= 0
// for a face, an edge or a vertex of either feature. The nearest points of their planes or lines
// must lie inside them. Z is defined at each function below.
//
// The least distance of two features is attained inside both, on an edge or at a vertex; if N = 0,
// or an edge has no length, on an edge or at a vertex of theirs. So at any time within the
// distance, some condition holds. Conversely, each condition implies that some two points of the
// features are within that distance.
//
// Points may have positive weights. Each polynomial below is then multiplied by powers of them.
#pragma once

#include <array>
#include <ccd/curves.hpp>
#include <ccd/kind.hpp>
#include <ccd/methods/forms.hpp>
#include <cstddef>
#include <type_traits>
#include <vector>

#include "ccd/contact/condition.hpp"

namespace ccd::detail {

/// A point's path times a weight that is positive in [0, 1]. Points of one feature have one weight;
/// none means 1. The weight is not owned.
template <class R>
struct weighted_path {
    path<R> h;
    const R* weight = nullptr;
};

template <kind K, class R>
struct paths;
template <class R>
struct paths<kind::vertex_face, R> {
    weighted_path<R> v, f0, f1, f2;
};
template <class R>
struct paths<kind::edge_edge, R> {
    weighted_path<R> a0, a1, b0, b1;
};
template <class R>
struct paths<kind::vertex_edge, R> {
    weighted_path<R> v, e0, e1;
};
template <class R>
struct paths<kind::vertex_vertex, R> {
    weighted_path<R> v, w;
};

/// Calls path_of(i) for the index of each point.
template <kind K, class R, class PathOf>
paths<K, R> paths_of(const PathOf& path_of) {
    constexpr std::size_t count = kind_traits<K>::first_vertices + kind_traits<K>::second_vertices;
    if constexpr (count == 4)
        return {path_of(0), path_of(1), path_of(2), path_of(3)};
    else if constexpr (count == 3)
        return {path_of(0), path_of(1), path_of(2)};
    else
        return {path_of(0), path_of(1)};
}

template <class R>
using vertex_face_paths = paths<kind::vertex_face, R>;
template <class R>
using edge_edge_paths = paths<kind::edge_edge, R>;
template <class R>
using vertex_edge_paths = paths<kind::vertex_edge, R>;
template <class R>
using vertex_vertex_paths = paths<kind::vertex_vertex, R>;

template <class T, class R>
T times_weight(const T& p, const R* weight) {
    if (!weight) return p;
    if constexpr (std::is_same_v<T, path<R>>)
        return {{{p.x[0] * *weight}}, {{p.y[0] * *weight}}, {{p.z[0] * *weight}}};
    else
        return {{p[0] * *weight}};
}

/// Returns p − q times the weight of their feature, or times the weights of their two features.
template <class R>
path<R> operator-(const weighted_path<R>& p, const weighted_path<R>& q) {
    const auto difference = [](const path<R>& a, const path<R>& b) -> path<R> {
        return {a.x - b.x, a.y - b.y, a.z - b.z};
    };
    if (p.weight == q.weight) return difference(p.h, q.h);
    return difference(times_weight(p.h, q.weight), times_weight(q.h, p.weight));
}

template <class R>
std::vector<R> list(const errbound::bernstein<R, 0>& p) {
    return {p[0]};
}
template <class R>
std::vector<R> list(const path<R>& p) {
    return {p.x[0], p.y[0], p.z[0]};
}
template <class R, std::size_t N>
std::vector<R> list(const std::array<errbound::bernstein<R, 0>, N>& all) {
    std::vector<R> r;
    for (const auto& p : all) r.push_back(p[0]);
    return r;
}

template <class R>
struct weighted_vertex_face_forms : vertex_face_forms<R, 0> {
    const R* vertex_weight;

    auto inside() const {
        return vertex_face_forms<R, 0>::inside(times_weight(this->normal_squared(), vertex_weight));
    }
};
template <class R>
struct weighted_edge_edge_forms : edge_edge_forms<R, 0> {
    const R *a_weight, *b_weight;

    auto inside() const {
        const auto n2 = this->normal_squared();
        return edge_edge_forms<R, 0>::inside(times_weight(n2, b_weight),
                                             times_weight(n2, a_weight));
    }
};
template <class R>
weighted_vertex_face_forms<R> forms_of(const vertex_face_paths<R>& q) {
    return {{q.f1 - q.f0, q.f2 - q.f0, q.v - q.f0}, q.v.weight};
}
template <class R>
weighted_edge_edge_forms<R> forms_of(const edge_edge_paths<R>& q) {
    return {{q.a1 - q.a0, q.b1 - q.b0, q.b0 - q.a0}, q.a0.weight, q.b0.weight};
}

template <class R>
std::array<vertex_edge_paths<R>, 3> edges_of(const vertex_face_paths<R>& q) {
    return {{{q.v, q.f0, q.f1}, {q.v, q.f1, q.f2}, {q.v, q.f2, q.f0}}};
}
template <class R>
std::array<vertex_edge_paths<R>, 4> edges_of(const edge_edge_paths<R>& q) {
    return {{{q.a0, q.b0, q.b1}, {q.a1, q.b0, q.b1}, {q.b0, q.a0, q.a1}, {q.b1, q.a0, q.a1}}};
}
template <class R>
std::array<vertex_vertex_paths<R>, 3> corners_of(const vertex_face_paths<R>& q) {
    return {{{q.v, q.f0}, {q.v, q.f1}, {q.v, q.f2}}};
}
template <class R>
std::array<vertex_vertex_paths<R>, 4> corners_of(const edge_edge_paths<R>& q) {
    return {{{q.a0, q.b0}, {q.a0, q.b1}, {q.a1, q.b0}, {q.a1, q.b1}}};
}
template <class R>
std::array<vertex_vertex_paths<R>, 2> corners_of(const vertex_edge_paths<R>& q) {
    return {{{q.v, q.e0}, {q.v, q.e1}}};
}

template <class R>
condition<R> contact_condition(const vertex_vertex_paths<R>& q) {
    return {list(q.v - q.w), [] { return side_conditions<R>{}; }};
}
/// W × E = 0 and W·(E − W) >= 0. For an edge without length this means W = 0.
template <class R>
condition<R> contact_condition(const vertex_edge_paths<R>& q) {
    return {list(cross(q.v - q.e0, q.e1 - q.e0)), [q] {
                return side_conditions<R>{list(dot(q.v - q.e0, q.e1 - q.v)), {}};
            }};
}
/// Returns G_i >= 0 and N ≠ 0: a contact (or the distance) of the plane or the lines is then one of
/// the features.
template <class Forms>
auto inside_conditions(const Forms& forms) {
    const auto inside = list(forms.inside());
    return side_conditions<typename decltype(inside)::value_type>{inside, list(forms.n)};
}

/// Returns the conditions of contact; for VF and EE, at times at which Y = 0.
template <kind K, class R>
std::vector<condition<R>> contact_conditions(const paths<K, R>& q) {
    if constexpr (K == kind::vertex_vertex || K == kind::vertex_edge) {
        return {contact_condition(q)};
    } else {
        std::vector<condition<R>> all;
        all.push_back({{}, [forms = forms_of(q)] { return inside_conditions(forms); }});
        for (const auto& edge : edges_of(q)) all.push_back(contact_condition(edge));
        return all;
    }
}

template <class R>
condition<R> distance_condition(const vertex_vertex_paths<R>& q, const R& squared) {
    const path<R> w = q.v - q.w;
    return {{dot(w, w)[0] - squared}, [] { return side_conditions<R>{}; }, true};
}
/// Z = |E × W|² − D E·E, where the edge has a length and its nearest point is between its ends.
template <class R>
condition<R> distance_condition(const vertex_edge_paths<R>& q, const R& squared) {
    const path<R> w = q.v - q.e0, e = q.e1 - q.e0, moment = cross(e, w);
    return {{dot(moment, moment)[0] - squared * dot(e, e)[0]},
            [q, w, e] {
                return side_conditions<R>{{dot(w, e)[0], dot(q.e1 - q.v, e)[0]}, list(e)};
            },
            true};
}
/// Z = (N·P)² − D N·N
template <class Forms, class R>
condition<R> distance_condition_inside(const Forms& forms, const R& squared) {
    const R y = forms.y()[0];
    return {{y * y - squared * forms.normal_squared()[0]},
            [forms] { return inside_conditions(forms); },
            true};
}

/// Calls visit(make) for every condition of distance² <= D; make() returns the condition. All axes
/// have one unit. `squared` is D times the squares of both features' weights, as all differences
/// between the features have both weights as factors. Proof: proofs/times/Distance.v,
/// vertex_edge_within, face_within_union, edges_within_union; of first times,
/// proofs/times/FirstConditions.v, vertex_edge_near_candidate, face_near_candidate,
/// edges_near_candidate.
template <kind K, class R, class Visit>
void visit_distance_conditions(const paths<K, R>& q, const R& squared, const Visit& visit) {
    if constexpr (K != kind::vertex_vertex)
        for (const auto& corner : corners_of(q))
            visit([&] { return distance_condition(corner, squared); });
    if constexpr (is_cubic(K)) {
        for (const auto& edge : edges_of(q))
            visit([&] { return distance_condition(edge, squared); });
        visit([&] { return distance_condition_inside(forms_of(q), squared); });
    } else {
        visit([&] { return distance_condition(q, squared); });
    }
}

}  // namespace ccd::detail
