// The polynomials of a query, over any scalar: coplanarity cubic Y and inside quartics G_i.
//
// A VF contact has a t in [0, 1] with Y(t) = N·P = 0 and the three barycentric weights times |N|²
// >= 0 (TightCCD, Section 3). An EE contact has the two edge parameters times |N|² within [0,
// |N|²]. If the normal N vanishes, the conditions can hold without contact. All forms are in scaled
// Bernstein coefficients (docs/notation.md).
#pragma once

#include <array>
#include <ccd/kind.hpp>
#include <ccd/query.hpp>
#include <errbound/bernstein.hpp>
#include <type_traits>
#include <utility>

namespace ccd {

/// A vector of polynomials of degree N in t.
template <class S, int N>
struct vector_form {
    errbound::bernstein<S, N> x, y, z;
};

/// The linear motion of q − p.
template <class S>
constexpr vector_form<S, 1> difference(const moving_point<S>& q, const moving_point<S>& p) {
    return {{{q.t0.x - p.t0.x, q.t1.x - p.t1.x}},
            {{q.t0.y - p.t0.y, q.t1.y - p.t1.y}},
            {{q.t0.z - p.t0.z, q.t1.z - p.t1.z}}};
}

template <class S, class T, int A, int B>
constexpr auto cross(const vector_form<S, A>& p, const vector_form<T, B>& q) {
    using product = decltype(p.x[0] * q.x[0]);
    return vector_form<product, A + B>{p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z,
                                       p.x * q.y - p.y * q.x};
}

template <class S, class T, int A, int B>
constexpr auto dot(const vector_form<S, A>& p, const vector_form<T, B>& q) {
    return p.x * q.x + p.y * q.y + p.z * q.z;
}

/// p at (s, t), as a form of degree 0; coefficients 0 and N are the values at t = 0 and 1.
template <class S, int N, class T>
constexpr auto value_at(const vector_form<S, N>& p, const T& s, const T& t) {
    using value = decltype(value_at(p.x, s, t));
    return vector_form<value, 0>{
        {{value_at(p.x, s, t)}}, {{value_at(p.y, s, t)}}, {{value_at(p.z, s, t)}}};
}
template <class S, int N>
constexpr vector_form<S, 0> coefficient(const vector_form<S, N>& p, int i) {
    return {{{p.x[i]}}, {{p.y[i]}}, {{p.z[i]}}};
}

/// b, c, p and n = b × c of docs/notation.md, linear in t; with Degree 0 the values at one time.
/// Over integers of W words, n has coefficients of 2W words, y of 3W and the others of 4W; products
/// of other scalars keep their type.
template <class S, int Degree = 1>
struct coplanarity_forms {
    using product = decltype(std::declval<S>() * std::declval<S>());
    vector_form<S, Degree> b, c, p;
    vector_form<product, 2 * Degree> n;

    constexpr coplanarity_forms(const vector_form<S, Degree>& b_, const vector_form<S, Degree>& c_,
                                const vector_form<S, Degree>& p_)
        : b(b_), c(c_), p(p_), n(cross(b, c)) {}

    /// Y = det(b, c, p), a cubic. Proof: proofs/bsc/Decisions.v, forms_y.
    constexpr auto y() const { return dot(n, p); }
    constexpr auto normal_squared() const { return dot(n, n); }
};

/// Vertex/face: b = f1 − f0, c = f2 − f0, p = v − f0.
template <class S, int Degree = 1>
struct vertex_face_forms : coplanarity_forms<S, Degree> {
    using coplanarity_forms<S, Degree>::coplanarity_forms;
    constexpr explicit vertex_face_forms(const vertex_face<S>& q)
        : coplanarity_forms<S>(difference(q.f1, q.f0), difference(q.f2, q.f0),
                               difference(q.v, q.f0)) {}
    /// The barycentric weights of f2, f1, f0, times |N|². Proof: proofs/bsc/Decisions.v,
    /// forms_weights.
    constexpr auto inside() const { return inside(this->normal_squared()); }
    /// The same if p was multiplied by a positive number; then `n2` is |N|² times that number.
    template <class T>
    constexpr auto inside(const T& n2) const {
        const auto w2 = dot(cross(this->b, this->p), this->n);
        const auto w1 = dot(cross(this->p, this->c), this->n);
        return std::array{w2, w1, n2 - w1 - w2};
    }
};

/// Edge/edge: b = a1 − a0, c = b1 − b0, p = b0 − a0.
template <class S, int Degree = 1>
struct edge_edge_forms : coplanarity_forms<S, Degree> {
    using coplanarity_forms<S, Degree>::coplanarity_forms;
    constexpr explicit edge_edge_forms(const edge_edge<S>& q)
        : coplanarity_forms<S>(difference(q.a1, q.a0), difference(q.b1, q.b0),
                               difference(q.b0, q.a0)) {}
    /// The parameters on edges a and b and 1 minus each, times |N|². Proof: proofs/bsc/Decisions.v,
    /// forms_weights.
    constexpr auto inside() const {
        const auto n2 = this->normal_squared();
        return inside(n2, n2);
    }
    /// The same if b, c and p were multiplied by positive numbers β, γ and βγ; then `on_a_n2` is
    /// γ|N|² and `on_b_n2` is β|N|².
    template <class T>
    constexpr auto inside(const T& on_a_n2, const T& on_b_n2) const {
        const auto on_a = dot(cross(this->p, this->c), this->n);
        const auto on_b = dot(cross(this->p, this->b), this->n);
        return std::array{on_a, on_a_n2 - on_a, on_b, on_b_n2 - on_b};
    }
};

template <template <class, int> class Forms, class S, class T>
constexpr auto forms_at(const Forms<S, 1>& f, const T& s, const T& t) {
    const auto b = value_at(f.b, s, t);
    return Forms<std::remove_cvref_t<decltype(b.x[0])>, 0>(b, value_at(f.c, s, t),
                                                           value_at(f.p, s, t));
}
template <template <class, int> class Forms, class S>
constexpr Forms<S, 0> forms_at_end(const Forms<S, 1>& f, int end) {
    return {coefficient(f.b, end), coefficient(f.c, end), coefficient(f.p, end)};
}

template <class S>
using linear_vertex_face_forms = vertex_face_forms<S>;
template <class S>
using linear_edge_edge_forms = edge_edge_forms<S>;

namespace detail {

template <kind K>
struct forms_of_kind;
template <>
struct forms_of_kind<kind::vertex_face> {
    template <class S>
    using type = linear_vertex_face_forms<S>;
};
template <>
struct forms_of_kind<kind::edge_edge> {
    template <class S>
    using type = linear_edge_edge_forms<S>;
};

}  // namespace detail

template <kind K, class S>
using linear_forms = typename detail::forms_of_kind<K>::template type<S>;

template <template <class> class Query, class S>
requires(is_cubic(kind_of<Query<S>>)) constexpr auto forms_of(const Query<S>& q) {
    return linear_forms<kind_of<Query<S>>, S>(q);
}

}  // namespace ccd
