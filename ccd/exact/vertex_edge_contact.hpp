// Vertex/edge contact in closed form, in integers of fixed width.
//
// Let E = e1 − e0, W = v − e0, X = v − e1. Contact at t means that all three quadratics of W × E
// are 0 and that the quadratic W·X is <= 0. If the three have a rational root in common, W·X is
// evaluated there. If all are proportional to some f, W·X modulo f is a linear form l times s. The
// sign of l at the roots of f follows from the sign of f at the root of l.
//
// Widths, for coordinates of W words with differences below D = 2^(64W − 3): f in 2W words (|f0|,
// |f2| <= 2D², |f1| <= 4D²). b = W·X takes 2W words (3D², 6D²), and 6W at a rational root (144D⁶).
// The remainder l takes 4W (12D⁴, 24D⁴), and f at l's root 10W (2592·D^10).
#pragma once

#include <array>
#include <ccd/methods/forms.hpp>
#include <errbound/bernstein.hpp>
#include <errbound/integers/fixed_integer.hpp>

#include "ccd/exact/common_roots.hpp"

namespace ccd::detail {

template <int Words>
constexpr errbound::integers::fixed_integer<Words> magnitude(
    const errbound::integers::fixed_integer<Words>& x) {
    return x.negative() ? -x : x;
}

/// True if b <= 0 at some root of f in (0, 1). Precondition: f's coefficients have both signs.
/// Proof: proofs/contact/VertexEdge.v, nonpositive_at_a_root_right.
template <int Words>
constexpr bool nonpositive_at_a_root(const quadratic_form<Words>& f,
                                     const quadratic_form<Words>& b) {
    using errbound::sign_of;
    using errbound::sign_type;
    using errbound::value_at;
    const auto first = sign_of(f[0]), last = sign_of(f[2]);
    // If an end is a root, a linear form remains, whose root is rational.
    if (first == sign_type::zero) return value_at(b, magnitude(f[2]), magnitude(f[1])) <= 0;
    if (last == sign_type::zero) return value_at(b, magnitude(f[1]), magnitude(f[0])) <= 0;

    const bool two_roots = first == last;  // else one root, where f changes sign
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
    // A common root, or roots of f on either side of l's root, where l has both signs.
    if (there == sign_type::zero || (two_roots && there != first)) return true;
    bool roots_are_later = there == first;
    if (two_roots) {  // both roots of f on one side of l's: the slope of f shows which
        const linear_form<Words> slope{{f[1] - (f[0] << 1), (f[2] << 1) - f[1]}};
        roots_are_later = sign_of(value_at(slope, s, t)) != first;
    }
    return nonpositive(sign_of(roots_are_later ? l[1] : l[0]));
}

/// Precondition: differences of coordinates at one end of the step are below 2^(64·Words − 3).
/// Cost: some 40 products of words, and up to a few hundred if all three components of W × E have a
/// root in [0, 1]. Proof: proofs/contact/VertexEdge.v, contact_right.
template <int Words>
constexpr bool vertex_touches_edge(
    const vertex_edge<errbound::integers::fixed_integer<Words>>& query) {
    using errbound::sign_of;
    using errbound::sign_type;
    const auto e = difference(query.e1, query.e0);
    const auto w = difference(query.v, query.e0);
    std::array<quadratic_form<2 * Words>, 3> f;  // W × E
    f[0] = w.y * e.z - w.z * e.y;
    if (certainly_rootless(f[0])) return false;
    f[1] = w.z * e.x - w.x * e.z;
    if (certainly_rootless(f[1])) return false;
    f[2] = w.x * e.y - w.y * e.x;
    if (certainly_rootless(f[2])) return false;
    const auto b = dot(w, difference(query.v, query.e1));
    if (sign_throughout(b) == sign_type::positive) return false;

    const auto touches_at_end = [&](int i) {
        return f[0][i] == 0 && f[1][i] == 0 && f[2][i] == 0 && b[i] <= 0;
    };
    if (touches_at_end(0) || touches_at_end(2)) return true;

    // Other contacts are inside the step and need b <= 0 at some t.
    if (sign_inside(b) == sign_type::positive) return false;
    const common_roots roots(f);
    using kind = typename decltype(roots)::kind_type;
    switch (roots.kind) {
        case kind::none:
            return false;
        case kind::one:
            return value_at_squares(b, roots.squares) <= 0;
        case kind::of_quadratic:
            return nonpositive_at_a_root(*roots.quadratic, b);
        case kind::everywhere:
            break;
    }
    // Collinear throughout. b is positive at both ends here, so it has a value <= 0 inside exactly
    // if it has real roots t/s > 0.
    return b[1] < 0 && b[1] * b[1] >= (b[0] * b[2]) << 2;
}

}  // namespace ccd::detail
