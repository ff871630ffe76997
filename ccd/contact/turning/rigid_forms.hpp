// Y and the G_i of two features of rigid bodies A and B, over any ring. Internal.
//
// A point X of a body is at R X + p. Both matrices have the weights a, b > 0 of
// ccd/contact/rotation.hpp, of degree 2. Scalar products do not change if both vectors
// turn, and R x × R y = R(x × y). So Y and the G_i, divided by all weights that they have in
// common, have the degrees below, instead of 9 and more. Below, d = p_A − p_B.
#pragma once

#include <array>
#include <ccd/kind.hpp>
#include <errbound/bernstein.hpp>

#include "ccd/contact/rotation.hpp"
#include "ccd/contact/time_polynomial.hpp"

namespace ccd::detail {

template <class E>
using triple = std::array<E, 3>;

template <class E, class F>
constexpr auto dot(const triple<E>& p, const triple<F>& q) {
    return p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
}
template <class E, class F>
constexpr auto cross(const triple<E>& p, const triple<F>& q) {
    return triple<decltype(p[0] * q[0])>{p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2],
                                         p[0] * q[1] - p[1] * q[0]};
}
template <class E>
constexpr triple<E> sum(const triple<E>& p, const triple<E>& q) {
    return {p[0] + q[0], p[1] + q[1], p[2] + q[2]};
}
template <class E, class F>
constexpr auto applied(const std::array<triple<E>, 3>& rows, const triple<F>& x) {
    return triple<decltype(rows[0][0] * x[0])>{dot(rows[0], x), dot(rows[1], x), dot(rows[2], x)};
}
template <class E, class F>
constexpr auto times(const E& factor, const triple<F>& x) {
    return triple<decltype(factor * x[0])>{factor * x[0], factor * x[1], factor * x[2]};
}

/// The polynomial in a form of the next degree.
template <class S, int N>
constexpr auto raised(const errbound::bernstein<S, N>& p) {
    return elevated(p);
}
inline const time_polynomial& raised(const time_polynomial& p) {
    return p;
}
template <class E>
constexpr auto raised(const triple<E>& p) {
    return triple<std::decay_t<decltype(raised(p[0]))>>{raised(p[0]), raised(p[1]), raised(p[2])};
}

/// Numbers are constants, and motions linear in t.
template <class Constant, class Linear>
struct rigid_query {
    std::array<std::array<Linear, 4>, 2> q;  ///< quaternions of A and B
    triple<Linear> d;
    triple<Constant> x, y;  ///< a point of A's feature, and of B's, from the centres
    triple<Constant> e, f;  ///< VF: b and c of the face; EE: the edges of A and of B
};

/// A vertex of A and a face of B, or edges of A and B.
template <kind K, class Constant, class Linear>
class rigid_forms {
    static_assert(is_cubic(K));

  public:
    constexpr explicit rigid_forms(const rigid_query<Constant, Linear>& query)
        : query_(query),
          a_(rotation_of(query.q[0])),
          b_(rotation_of(query.q[1])),
          x_(sum(raised(applied(a_.matrix, query.x)), times(a_.weight, query.d))),
          weight_(a_.weight * b_.weight) {}

    /// Y/(ab), of degree 5.
    ///
    /// VF: with n = e × f, Y = R_B n·(R_A x + d) − n·y.
    /// EE: Y = det(R_A e, R_B f, R_B y − R_A x − d)
    ///       = R_A e·R_B(f × y) − R_B f·(R_A(x × e) + d × R_A e).
    constexpr auto y() const {
        if constexpr (K == kind::vertex_face) {
            return above_face(cross(query_.e, query_.f));
        } else {
            const auto e = applied(a_.matrix, query_.e), f = applied(b_.matrix, query_.f);
            const auto moment =
                sum(raised(applied(a_.matrix, cross(query_.x, query_.e))), cross(query_.d, e));
            return raised(dot(e, applied(b_.matrix, cross(query_.f, query_.y)))) - dot(moment, f);
        }
    }

    /// VF: the weights of linear_vertex_face_forms times ab, of degree 5. Let P = V − y for the
    /// vertex V in B's coordinates. They are det(e, P, n) = P·(n × e), det(P, f, n) = P·(f × n) and
    /// n·n minus both.
    ///
    /// EE: the weights of linear_edge_edge_forms times a²b², of degree 9. Let P = R_B y − R_A x −
    /// d, and let e and f be the turned edges. The weights are (P·e)(f·f) − (P·f)(e·f), (P·e)(e·f)
    /// − (P·f)(e·e), and (e·e)(f·f) − (e·f)² minus each.
    constexpr auto inside() const {
        if constexpr (K == kind::vertex_face) {
            const auto n = cross(query_.e, query_.f);
            const auto w2 = above_face(cross(n, query_.e)), w1 = above_face(cross(query_.f, n));
            return std::array{w2, w1, raised(weight_ * dot(n, n)) - w1 - w2};
        } else {
            const auto e = applied(a_.matrix, query_.e), f = applied(b_.matrix, query_.f);
            const auto ee = dot(query_.e, query_.e), ff = dot(query_.f, query_.f);
            const auto ef = dot(e, f);
            const auto pe =
                raised(dot(e, applied(b_.matrix, query_.y)) - weight_ * dot(query_.x, query_.e)) -
                b_.weight * dot(query_.d, e);
            const auto pf = raised(weight_ * dot(query_.y, query_.f)) - dot(x_, f);
            const auto on_a = weight_ * ff * pe - ef * pf, on_b = ef * pe - weight_ * ee * pf,
                       n2 = raised(weight_ * weight_ * (ee * ff) - ef * ef);
            return std::array{on_a, n2 - on_a, on_b, n2 - on_b};
        }
    }

  private:
    /// (V − y)·normal times ab.
    template <class Normal>
    constexpr auto above_face(const triple<Normal>& normal) const {
        return dot(x_, applied(b_.matrix, normal)) - raised(weight_ * dot(normal, query_.y));
    }

    using quadratic = decltype(Linear() * Linear());

    rigid_query<Constant, Linear> query_;
    weighted_rotation<quadratic> a_, b_;
    triple<decltype(quadratic() * Linear())> x_;  ///< R_A x + d times a
    decltype(quadratic() * quadratic()) weight_;  ///< ab
};

}  // namespace ccd::detail
