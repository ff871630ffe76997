// Weights (G_i/N·N, or W·E/E·E on an edge), velocity and normal of features that meet inside.
// Internal.
#pragma once

#include <array>
#include <ccd/kind.hpp>
#include <ccd/methods/forms.hpp>
#include <cstddef>

#include "ccd/contact/data/moment.hpp"

namespace ccd::detail {

/// Weights are in the order of the kind's points.
struct contact_state {
    std::array<enclosure, 4> weights;
    relative_motion motion;  ///< of the first feature's contact point relative to the second's
    /// N, or the edge of a vertex/edge pair, scaled by some power of two.
    enclosed_vector across;
};

template <template <class, int> class Forms>
Forms<enclosure, 0> moderate_forms(const relative_motion& b, const relative_motion& c,
                                   const relative_motion& p) {
    const int e = excess_exponent(std::max(size(b.position), size(c.position)), 64);
    return {scaled(b.position, -e), scaled(c.position, -e), scaled(p.position, -e)};
}

/// Returns the points of a face, rotated so that its longest edge is between the last two. The
/// cross product of the other edges has the smallest error, above all if two points nearly
/// coincide.
inline std::array<std::size_t, 3> with_longest_edge_last(const contact_moment& at,
                                                         const point_numbers& i) {
    const double opposite[] = {at.squared_distance(i[2], i[3]), at.squared_distance(i[3], i[1]),
                               at.squared_distance(i[1], i[2])};
    if (opposite[0] >= opposite[1] && opposite[0] >= opposite[2]) return {1, 2, 3};
    if (opposite[1] >= opposite[2]) return {2, 3, 1};
    return {3, 1, 2};
}

template <kind K>
contact_state state_inside(const contact_moment& at, const point_numbers& i) {
    const enclosure one(1.0);
    if constexpr (K == kind::vertex_face) {
        const auto [f0, f1, f2] = with_longest_edge_last(at, i);
        const auto b = at.relative(i[f1], i[f0]), c = at.relative(i[f2], i[f0]);
        const auto p = at.relative(i[0], i[f0]);
        const auto forms = moderate_forms<vertex_face_forms>(b, c, p);
        const enclosure n2 = forms.normal_squared()[0];
        const enclosure w2 = dot(cross(forms.b, forms.p), forms.n)[0] / n2;
        const enclosure w1 = dot(cross(forms.p, forms.c), forms.n)[0] / n2;
        std::array<enclosure, 4> weights{one};
        weights[f0] = one - w1 - w2;
        weights[f1] = w1;
        weights[f2] = w2;
        return {weights, p - w1 * b - w2 * c, forms.n};
    } else if constexpr (K == kind::edge_edge) {
        const auto b = at.relative(i[1], i[0]), c = at.relative(i[3], i[2]);
        const auto p = at.relative(i[2], i[0]);
        const auto forms = moderate_forms<edge_edge_forms>(b, c, p);
        const enclosure n2 = forms.normal_squared()[0];
        const enclosure on_a = dot(cross(forms.p, forms.c), forms.n)[0] / n2;
        const enclosure on_b = dot(cross(forms.p, forms.b), forms.n)[0] / n2;
        return {{one - on_a, on_a, one - on_b, on_b}, on_a * b - on_b * c - p, forms.n};
    } else if constexpr (K == kind::vertex_edge) {
        const auto w = at.relative(i[0], i[1]), e = at.relative(i[2], i[1]);
        const int excess = excess_exponent(size(e.position), 64);
        const enclosed_vector edge = scaled(e.position, -excess);
        const enclosure on_edge = dot(scaled(w.position, -excess), edge)[0] / dot(edge, edge)[0];
        return {{one, one - on_edge, on_edge, enclosure()}, w - on_edge * e, edge};
    } else {
        return {{one, one, enclosure(), enclosure()}, at.relative(i[0], i[1]), {}};
    }
}

}  // namespace ccd::detail
