// Tests that the exact decisions share.
#pragma once

#include <array>
#include <bit>
#include <ccd/kind.hpp>
#include <ccd/methods/forms.hpp>
#include <ccd/methods/transform.hpp>
#include <ccd/query.hpp>
#include <ccd/verdict.hpp>
#include <cstddef>
#include <errbound/sign.hpp>

namespace ccd::detail {

/// The extents of some points: x, y, z at the start, then at the end.
struct ends_extents {
    std::array<double, 6> least, most;

    constexpr ends_extents(const std::array<double, 6>* points, std::size_t count)
        : least(points[0]), most(points[0]) {
        for (std::size_t i = 1; i < count; ++i)
            for (std::size_t k = 0; k < 6; ++k) {
                least[k] = points[i][k] < least[k] ? points[i][k] : least[k];
                most[k] = points[i][k] > most[k] ? points[i][k] : most[k];
            }
    }
};

/// True if a coordinate axis separates the features in the same order at t = 0 and t = 1, and so
/// throughout linear motion. Precondition: finite coordinates. Branch-free, because the separating
/// axis is unpredictable. Proof: proofs/bsc/Decisions.v, face_separated, edges_separated;
/// proofs/contact/AxisUnits.v, separated_right.
template <class Query>
constexpr bool separated_by_coordinates(const Query& query) {
    using traits = kind_traits<kind_constant<Query>::value>;
    constexpr std::size_t first = traits::first_vertices, second = traits::second_vertices;
    const auto points = std::bit_cast<std::array<std::array<double, 6>, first + second>>(query);
    const ends_extents p(points.data(), first), q(points.data() + first, second);
    std::array<bool, 6> above{}, below{};
    for (std::size_t k = 0; k < 6; ++k) {
        above[k] = p.least[k] > q.most[k];
        below[k] = p.most[k] < q.least[k];
    }
    bool apart = false;
    for (std::size_t axis = 0; axis < 3; ++axis)
        apart |= (above[axis] & above[axis + 3]) | (below[axis] & below[axis + 3]);
    return apart;
}

/// True if the linear W from w0 to w1 is 0 at some t: w0 and w1 are antiparallel, or one is zero.
/// Proof: proofs/contact/Contact.v, vertex_vertex_contact; proofs/contact/AxisUnits.v,
/// vertices_contact_right.
template <class S>
constexpr bool vertices_touch(const vertex_vertex<S>& query) {
    const auto w = difference(query.v, query.w);
    const vector_form<S, 0> w0{{{w.x[0]}}, {{w.y[0]}}, {{w.z[0]}}};
    const vector_form<S, 0> w1{{{w.x[1]}}, {{w.y[1]}}, {{w.z[1]}}};
    const auto c = cross(w0, w1);
    return c.x[0] == 0 && c.y[0] == 0 && c.z[0] == 0 && dot(w0, w1)[0] <= 0;
}

/// `collides` if all G_i are positive, `separate` if one is negative, else `uncertain`.
template <class Forms>
constexpr outcome decided_by_weights(const Forms& forms) {
    using errbound::sign_of;
    auto found = outcome::collides;
    for (const auto& g : forms.inside()) {
        const auto sign = sign_of(g[0]);
        if (sign == errbound::sign_type::negative) return outcome::separate;
        if (sign != errbound::sign_type::positive) found = outcome::uncertain;
    }
    return found;
}

}  // namespace ccd::detail
