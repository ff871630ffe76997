// The first contact of a vertex with an edge, and of two vertices, in integers of fixed width.
//
// Algebra and widths: ccd/exact/vertex_edge_contact.hpp. A contact begins at t = 0, at a rational
// time, or at the root of a quadratic. These times are visited in their order.
#pragma once

#include <array>
#include <ccd/methods/forms.hpp>
#include <ccd/verdict.hpp>
#include <errbound/bernstein.hpp>
#include <errbound/integers/fixed_integer.hpp>
#include <optional>

#include "ccd/contact/time_bracket.hpp"
#include "ccd/exact/common_roots.hpp"
#include "ccd/exact/features.hpp"
#include "ccd/exact/vertex_edge_contact.hpp"

namespace ccd::detail {

/// `time` is the first time if `outcome` is `collides`. `uncertain`: fixed widths cannot determine
/// it.
struct found_time {
    ccd::outcome outcome = ccd::outcome::separate;
    time_bracket time{};

    constexpr found_time() = default;
    constexpr found_time(ccd::outcome o) : outcome(o) {}
    constexpr found_time(const time_bracket& t) : outcome(ccd::outcome::collides), time(t) {}
    constexpr found_time(const std::optional<time_bracket>& t)
        : outcome(t ? ccd::outcome::collides : ccd::outcome::uncertain),
          time(t.value_or(time_bracket{})) {}
};

/// Returns the first root of f in (0, 1) where b <= 0. Precondition: f's coefficients have both
/// signs, and contact requires f = 0. Proof: proofs/times/VertexEdgeTime.v, first_root_right; of
/// the widths, proofs/times/TimeSearch.v, first_root_widths.
template <int Words>
constexpr found_time first_root_nonpositive(const quadratic_form<Words>& f,
                                            const quadratic_form<Words>& b) {
    using errbound::sign_of;
    using errbound::sign_type;
    using errbound::value_at;
    // The root of c0·s + c1·t, whose coefficients have opposite signs.
    const auto at_rational = [&b](const auto& c0, const auto& c1) -> found_time {
        if (!(value_at(b, magnitude(c1), magnitude(c0)) <= 0)) return outcome::separate;
        return bracket_of_linear_root(linear_form<Words>{{c0, c1}});
    };
    const auto first = sign_of(f[0]), last = sign_of(f[2]);
    if (first == sign_type::zero) return at_rational(f[1], f[2]);
    if (last == sign_type::zero) return at_rational(f[0], f[1]);

    const bool two_roots = first == last;
    if (two_roots) {
        const auto discriminant = sign_of(f[1] * f[1] - ((f[0] * f[2]) << 2));
        if (discriminant == sign_type::negative) return outcome::separate;
        if (discriminant == sign_type::zero) return at_rational(f[1], f[2] << 1);
    }
    const auto root = [&f](quadratic_root which) -> found_time {
        return bracket_of_quadratic_root(f, which);
    };
    // At the roots of f, b has the sign of f2·l: see nonpositive_at_a_root.
    const linear_form<2 * Words> l{{f[2] * b[0] - b[2] * f[0], f[2] * b[1] - b[2] * f[1]}};
    const auto nonpositive = [last](sign_type of_l) {
        return errbound::certainly_nonpositive(last * of_l);
    };
    const auto first_root = two_roots ? quadratic_root::first : quadratic_root::only;
    const auto everywhere = sign_inside(l);
    if (certain(everywhere)) return nonpositive(everywhere) ? root(first_root) : outcome::separate;
    // l changes sign at t = |l0|, s = |l1|.
    const auto s = magnitude(l[1]), t = magnitude(l[0]);
    const auto there = sign_of(value_at(f, s, t));
    if (!two_roots) {
        if (there == sign_type::zero) return root(first_root);
        return nonpositive(sign_of(there == first ? l[1] : l[0])) ? root(first_root)
                                                                  : outcome::separate;
    }
    if (there == -first)  // one root on each side
        return root(nonpositive(sign_of(l[0])) ? quadratic_root::first : quadratic_root::second);
    const linear_form<Words> slope{{f[1] - (f[0] << 1), (f[2] << 1) - f[1]}};
    const bool before_both = sign_of(value_at(slope, s, t)) == -first;
    if (there == sign_type::zero) {  // the root of l is one of them, and b = 0 there
        if (before_both) return root(quadratic_root::first);
        return root(nonpositive(sign_of(l[0])) ? quadratic_root::first : quadratic_root::second);
    }
    return nonpositive(sign_of(before_both ? l[1] : l[0])) ? root(quadratic_root::first)
                                                           : outcome::separate;
}

/// Same widths as vertex_touches_edge. Proof: proofs/times/VertexEdgeTime.v, first_contact_right,
/// first_bracket_right.
template <int Words>
constexpr found_time first_vertex_edge_contact(
    const vertex_edge<errbound::integers::fixed_integer<Words>>& query) {
    using errbound::sign_of;
    using errbound::sign_type;
    const auto e = difference(query.e1, query.e0);
    const auto w = difference(query.v, query.e0);
    std::array<quadratic_form<2 * Words>, 3> f;  // W × E
    f[0] = w.y * e.z - w.z * e.y;
    if (certainly_rootless(f[0])) return outcome::separate;
    f[1] = w.z * e.x - w.x * e.z;
    if (certainly_rootless(f[1])) return outcome::separate;
    f[2] = w.x * e.y - w.y * e.x;
    if (certainly_rootless(f[2])) return outcome::separate;
    const auto b = dot(w, difference(query.v, query.e1));
    if (sign_throughout(b) == sign_type::positive) return outcome::separate;

    const auto touches_at_end = [&](int i) {
        return f[0][i] == 0 && f[1][i] == 0 && f[2][i] == 0 && b[i] <= 0;
    };
    if (touches_at_end(0)) return time_bracket{0, 0};
    const auto at_end = [&]() -> found_time {
        return touches_at_end(2) ? found_time(time_bracket{1, 1}) : outcome::separate;
    };
    if (sign_inside(b) == sign_type::positive) return at_end();

    const common_roots roots(f);
    using kind = typename decltype(roots)::kind_type;
    found_time inside;
    switch (roots.kind) {
        case kind::none:
            break;
        case kind::one:
            if (value_at_squares(b, roots.squares) <= 0)
                inside = bracket_of_linear_root(
                    linear_form<4 * Words>{{-roots.squares[1], roots.squares[0]}});
            break;
        case kind::of_quadratic:
            inside = first_root_nonpositive(*roots.quadratic, b);
            break;
        case kind::everywhere:
            // The motion is collinear throughout, and b > 0 at t = 0, so contact begins at the
            // first root of b, which may be t = 1.
            if (b[2] <= 0 || (b[1] < 0 && b[1] * b[1] >= (b[0] * b[2]) << 2))
                return first_root_nonpositive(b, b);
            break;
    }
    return inside.outcome == outcome::separate ? at_end() : inside;
}

/// Proof: proofs/times/VertexEdgeTime.v, vertices_time_right.
template <int Words>
constexpr found_time first_vertex_vertex_contact(
    const vertex_vertex<errbound::integers::fixed_integer<Words>>& query) {
    if (!vertices_touch(query)) return outcome::separate;
    const auto w = difference(query.v, query.w);
    for (const auto* component : {&w.x, &w.y, &w.z})
        if (!((*component)[0] == 0)) return bracket_of_linear_root(*component);
    return time_bracket{0, 0};
}

}  // namespace ccd::detail
