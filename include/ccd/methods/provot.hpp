// `provot`: roots of the coplanarity cubic in floating point, and an inside test at each of them
// (Provot 1997), as in textbooks.
//
// Computes the cubic in powers of t from differences to one vertex, and its roots in [0, 1] in
// number type T, without error bounds. At each root it compares barycentric weights (VF) or edge
// parameters (EE) from the normal equations, without tolerance. Rounding therefore loses and
// invents collisions. Contacts of degenerate features are lost, since the test fails if the normal
// vanishes and there is no vertex/edge test. Contacts of coplanar motion are lost, except at t = 0
// and t = 1. Coordinates are not scaled: tiny ones underflow. Overflow gives `uncertain` with cause
// `range`.
#pragma once

#include <ccd/methods/forms.hpp>
#include <ccd/methods/transform.hpp>
#include <ccd/verdict.hpp>
#include <cstddef>
#include <errbound/number_traits.hpp>
#include <errbound/roots/floating_roots.hpp>

namespace ccd {
namespace provot {

/// The motion as x(0) and x(1) − x(0). Products of forms are convolutions, so they work for powers
/// too.
template <class T>
constexpr vector_form<T, 1> in_powers(const vector_form<T, 1>& v) {
    return {{{v.x[0], v.x[1] - v.x[0]}}, {{v.y[0], v.y[1] - v.y[0]}}, {{v.z[0], v.z[1] - v.z[0]}}};
}
template <template <class, int> class Forms, class T>
constexpr Forms<T, 1> in_powers(const Forms<T, 1>& f) {
    return {in_powers(f.b), in_powers(f.c), in_powers(f.p)};
}

/// The weights of b and c in the point of their plane nearest to p, times `whole` = |N|².
template <class T>
struct weights {
    T of_b, of_c, whole;

    template <int Degree>
    requires(Degree == 0) constexpr explicit weights(const coplanarity_forms<T, Degree>& f) {
        const T bb = dot(f.b, f.b)[0], bc = dot(f.b, f.c)[0], cc = dot(f.c, f.c)[0];
        const T bp = dot(f.b, f.p)[0], cp = dot(f.c, f.p)[0];
        whole = bb * cc - bc * bc;
        of_b = cc * bp - bc * cp;
        of_c = bb * cp - bc * bp;
    }
    constexpr bool finite() const {
        using traits = errbound::number_traits<T>;
        return traits::is_finite(of_b) && traits::is_finite(of_c) && traits::is_finite(whole);
    }
};

/// True if v is in the triangle, at a time when the four points are coplanar.
template <class T>
constexpr bool inside(const vertex_face_forms<T, 0>&, const weights<T>& w) {
    return w.whole > 0 && w.of_b >= 0 && w.of_c >= 0 && w.of_b + w.of_c <= w.whole;
}
/// True if the edges cross: a0 + x·b = b0 + y·c is p = x·b − y·c.
template <class T>
constexpr bool inside(const edge_edge_forms<T, 0>&, const weights<T>& w) {
    return w.whole > 0 && w.of_b >= 0 && w.of_b <= w.whole && w.of_c <= 0 && -w.of_c <= w.whole;
}

}  // namespace provot

/// Decides a vertex_face or edge_edge query, without any guarantee. No allocation, never throws.
template <class T, template <class> class Query>
verdict decide_provot(const Query<T>& query) {
    using traits = errbound::number_traits<T>;
    const auto motion = provot::in_powers(forms_of(query));
    const errbound::bernstein<T, 3> y = motion.y();
    // Bounds all values computed from the cubic. NaN and infinities fail the test.
    const T size = traits::abs(y[0]) + traits::abs(y[1]) + traits::abs(y[2]) + traits::abs(y[3]);
    if (!traits::is_finite(16 * size)) return {outcome::uncertain, cause::range};

    bool in_range = true;
    const auto inside_at = [&](const T& t) {
        const auto there = forms_at(motion, T(1), t);
        const provot::weights<T> weights(there);
        in_range = in_range && weights.finite();
        return weights.finite() && provot::inside(there, weights);
    };
    bool found = false;
    const auto pieces = errbound::roots::monotone_pieces(y);
    T before = 0;
    for (std::size_t i = 0; i < pieces.count && !found; ++i) {
        const T at_end = value_at(y, T(1), pieces.at[i]);
        if (i > 0 && ((before < 0 && at_end > 0) || (before > 0 && at_end < 0)))
            found = inside_at(errbound::roots::guarded_newton(y, pieces.at[i - 1], pieces.at[i]));
        if (at_end == 0 && !found) found = inside_at(pieces.at[i]);
        before = at_end;
    }
    if (found) return {outcome::collides, cause::none};
    if (!in_range) return {outcome::uncertain, cause::range};
    return {outcome::separate, cause::none};
}

}  // namespace ccd
