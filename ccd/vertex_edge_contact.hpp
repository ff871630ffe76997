// Vertex/edge contact in closed form, in integers of fixed width.
//
// With E = e1 − e0, W = v − e0, X = v − e1, contact at t means that the three quadratics of W × E
// vanish there and that the quadratic W·X is not positive (see ccd/reference.cpp). The quadratics'
// common roots need no search:
//  * Two that are not proportional have at most one root in common, and it is rational: there
//    (s², st, t²) is orthogonal to both coefficient vectors, hence parallel to their cross product
//    m, and a vector m is of that form exactly if m1² = m0·m2.
//  * If all are proportional to f, W·X modulo f is a linear form times s (or t), whose sign at f's
//    roots follows from the sign of f at the linear form's own root.
//
// Widths, for coordinates of W words whose differences stay below D = 2^(64W − 3): f in 2W words
// (|f0|, |f2| <= 2D², |f1| <= 4D²), b = W·X in 2W words (3D², 6D²), m in 4W (16D⁴), m·b in 6W
// (144D⁶), the remainder l in 4W (12D⁴, 24D⁴), f at l's root in 10W (2592·D^10 < 2^(11.4 + 640W −
// 30)), m1² in 8W (2^8·D^8).
#pragma once

#include <array>
#include <ccd/forms.hpp>
#include <errbound/bernstein.hpp>
#include <errbound/fixed_integer.hpp>

#include "ccd/features.hpp"

namespace ccd {

template <int Words>
using linear_form = errbound::bernstein<errbound::fixed_integer<Words>, 1>;
template <int Words>
using quadratic_form = errbound::bernstein<errbound::fixed_integer<Words>, 2>;

template <int Words>
constexpr errbound::fixed_integer<Words> magnitude(const errbound::fixed_integer<Words>& x) {
    return x.negative() ? -x : x;
}

/// The cross product of two coefficient vectors: parallel to (s², st, t²) at a common root.
template <int Words>
constexpr quadratic_form<2 * Words> minors(const quadratic_form<Words>& f,
                                           const quadratic_form<Words>& g) {
    return {{f[1] * g[2] - f[2] * g[1], f[2] * g[0] - f[0] * g[2], f[0] * g[1] - f[1] * g[0]}};
}

/// f at the point whose (s², st, t²) is m.
template <int A, int B>
constexpr errbound::fixed_integer<A + B> value_at_squares(const quadratic_form<A>& f,
                                                          const quadratic_form<B>& m) {
    return f[0] * m[0] + f[1] * m[1] + f[2] * m[2];
}

/// Whether b <= 0 at some root of f in (0, 1), for an f whose coefficients have both signs.
template <int Words>
bool nonpositive_at_a_root(const quadratic_form<Words>& f, const quadratic_form<Words>& b) {
    using errbound::sign_of;
    using errbound::sign_type;
    using errbound::value_at;
    const auto first = sign_of(f[0]), last = sign_of(f[2]);
    // A root at an end leaves a linear form, whose root is rational.
    if (first == sign_type::zero) return value_at(b, magnitude(f[2]), magnitude(f[1])) <= 0;
    if (last == sign_type::zero) return value_at(b, magnitude(f[1]), magnitude(f[0])) <= 0;

    const bool two_roots = first == last;  // else one, where f changes its sign
    if (two_roots) {
        const auto discriminant = sign_of(f[1] * f[1] - ((f[0] * f[2]) << 2));
        if (discriminant == sign_type::negative) return false;
        if (discriminant == sign_type::zero)
            return value_at(b, magnitude(f[2]) << 1, magnitude(f[1])) <= 0;
    }
    // f2·b − b2·f = s·l, so at f's roots b has the sign of f2·l.
    const linear_form<2 * Words> l{{f[2] * b[0] - b[2] * f[0], f[2] * b[1] - b[2] * f[1]}};
    const auto nonpositive = [last](sign_type of_l) {
        return errbound::certainly_nonpositive(last * of_l);
    };
    const auto everywhere = sign_inside(l);
    if (certain(everywhere)) return nonpositive(everywhere);
    const auto s = magnitude(l[1]), t = magnitude(l[0]);  // l's root
    const auto there = sign_of(value_at(f, s, t));
    // A root of both, or one of f's roots on either side of l's, where l has either sign.
    if (there == sign_type::zero || (two_roots && there != first)) return true;
    bool roots_are_later = there == first;
    if (two_roots) {  // both on one side of l's root: f still moves towards them, or away
        const linear_form<Words> slope{{f[1] - (f[0] << 1), (f[2] << 1) - f[1]}};
        roots_are_later = sign_of(value_at(slope, s, t)) != first;
    }
    return nonpositive(sign_of(roots_are_later ? l[1] : l[0]));
}

/// Whether the vertex touches the edge. Differences of coordinates at one end of the step must be
/// below 2^(64·Words − 3). Cost: some 40 products of words, and up to a few hundred if W × E has a
/// root in [0, 1] in all three components.
template <int Words>
bool contact(const vertex_edge<errbound::fixed_integer<Words>>& query) {
    using errbound::sign_of;
    using errbound::sign_type;
    const auto e = difference(query.e1, query.e0);
    const auto w = difference(query.v, query.e0);
    const auto off_line = cross(w, e);
    const std::array<quadratic_form<2 * Words>, 3> f{off_line.x, off_line.y, off_line.z};
    for (const auto& component : f)
        if (certainly_rootless(component)) return false;
    const auto b = dot(w, difference(query.v, query.e1));
    if (sign_throughout(b) == sign_type::positive) return false;

    const auto touches_at_end = [&](int i) {
        return f[0][i] == 0 && f[1][i] == 0 && f[2][i] == 0 && b[i] <= 0;
    };
    if (touches_at_end(0) || touches_at_end(2)) return true;

    // The others, inside the step, where b must not be positive and every f must have a root.
    if (sign_inside(b) == sign_type::positive) return false;
    std::array<const quadratic_form<2 * Words>*, 3> moving{};  // those not identically zero
    std::size_t count = 0;
    for (const auto& component : f) {
        const auto hull = sign_inside(component);
        if (hull == sign_type::zero) continue;
        if (certain(hull)) return false;
        moving[count++] = &component;
    }
    // Collinear throughout: b is positive at both ends by now, so it has a value <= 0 inside
    // exactly if it has real roots t/s > 0.
    if (count == 0) return b[1] < 0 && b[1] * b[1] >= (b[0] * b[2]) << 2;

    for (std::size_t i = 1; i < count; ++i) {
        const auto m = minors(*moving[0], *moving[i]);
        const auto sign = sign_of(m[0]);
        if (sign == sign_type::zero && sign_of(m[1]) == sign && sign_of(m[2]) == sign) continue;
        if (sign == sign_type::zero || sign_of(m[1]) != sign || sign_of(m[2]) != sign) return false;
        for (std::size_t k = 1; k < count; ++k)
            if (k != i && !(value_at_squares(*moving[k], m) == 0)) return false;
        if (!(m[1] * m[1] == m[0] * m[2])) return false;
        return errbound::certainly_nonpositive(sign_of(value_at_squares(b, m)) * sign);
    }
    return nonpositive_at_a_root(*moving[0], b);
}

}  // namespace ccd
