// The parity of a ray's crossings with the image of the domain's boundary: first over intervals, up
// to an uncertain sign, then over integers. Derivation: docs/other-methods.md, "Root parity".
#include <algorithm>
#include <array>
#include <ccd/methods/forms.hpp>
#include <ccd/methods/root_parity.hpp>
#include <ccd/methods/tracked_query.hpp>
#include <cstddef>
#include <errbound/rules/interval.hpp>
#include <span>

#include "ccd/exact/unbounded_integers.hpp"

namespace ccd {
namespace {

using errbound::sign_of;
using errbound::sign_type;

template <std::size_t Corners>
using corner_indices = std::array<std::size_t, Corners>;

/// F maps t and the parameters of a point of each feature to the difference of the points. Holds F
/// at the corners of its domain, and the boundary's image. Patch i belongs to
/// vertex_edge_queries()[i].
template <class S>
struct boundary_image {
    std::array<vector_form<S, 0>, 8> corners;
    std::span<const corner_indices<3>> triangles;
    std::span<const corner_indices<4>> patches;
};

/// Corners 0 to 2 are the face's vertices at t = 0; three more are at t = 1.
template <class S>
boundary_image<S> image_of(const vertex_face<S>& q) {
    static constexpr corner_indices<3> triangles[] = {{0, 1, 2}, {3, 4, 5}};
    static constexpr corner_indices<4> patches[] = {{0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}};
    boundary_image<S> image{{}, triangles, patches};
    std::size_t k = 0;
    for (const auto* corner : {&q.f0, &q.f1, &q.f2}) {
        const auto motion = difference(q.v, *corner);
        for (const int end : {0, 1})
            image.corners[k + 3 * static_cast<std::size_t>(end)] = coefficient(motion, end);
        ++k;
    }
    return image;
}
/// Corner i + 2j belongs to end i of edge a and end j of edge b at t = 0; four more are at t = 1.
template <class S>
boundary_image<S> image_of(const edge_edge<S>& q) {
    static constexpr corner_indices<3> triangles[] = {{0, 1, 3}, {0, 3, 2}, {4, 5, 7}, {4, 7, 6}};
    static constexpr corner_indices<4> patches[] = {
        {0, 2, 6, 4}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 3, 7, 6}};
    boundary_image<S> image{{}, triangles, patches};
    std::size_t k = 0;
    for (const auto* b : {&q.b0, &q.b1}) {
        for (const auto* a : {&q.a0, &q.a1}) {
            const auto motion = difference(*a, *b);
            for (const int end : {0, 1})
                image.corners[k + 4 * static_cast<std::size_t>(end)] = coefficient(motion, end);
            ++k;
        }
    }
    return image;
}

enum class crossing { none, odd, at_origin, uncertain };

constexpr crossing combined(crossing a, crossing b) {
    if (a == crossing::none || b == crossing::none) return a == crossing::none ? b : a;
    return a == crossing::uncertain || b == crossing::uncertain ? crossing::uncertain
                                                                : crossing::none;
}

template <class Corners, class Axis>
bool all_have(sign_type sign, const Corners& corners, const Axis& axis) {
    return std::ranges::all_of(corners,
                               [&](const auto* c) { return sign_of(((*c).*axis)[0]) == sign; });
}

template <class S, std::size_t Corners>
using part_corners = std::array<const vector_form<S, 0>*, Corners>;

/// True if the ray certainly misses the corners' convex hull.
template <class S, std::size_t Corners>
bool ray_misses(const part_corners<S, Corners>& c) {
    using vector = vector_form<S, 0>;
    return all_have(sign_type::negative, c, &vector::x) ||
           all_have(sign_type::negative, c, &vector::y) ||
           all_have(sign_type::positive, c, &vector::y) ||
           all_have(sign_type::negative, c, &vector::z) ||
           all_have(sign_type::positive, c, &vector::z);
}

/// The sign of q.z − p.z, if the side from p to q, projected along x, passes the ray's origin on
/// the side +y; else zero.
template <class S>
sign_type rise_beside_origin(const vector_form<S, 0>& p, const vector_form<S, 0>& q) {
    const sign_type at_p = sign_of(p.z[0]), at_q = sign_of(q.z[0]);
    if (!certain(at_p) || !certain(at_q)) return sign_type::uncertain;
    if ((at_p == sign_type::negative) == (at_q == sign_type::negative)) return sign_type::zero;
    const sign_type rise = at_p == sign_type::negative ? sign_type::positive : sign_type::negative;
    const sign_type turn = sign_of(p.y[0] * q.z[0] - q.y[0] * p.z[0]);
    if (!certain(turn)) return sign_type::uncertain;
    return turn == -rise ? sign_type::zero : rise;
}

/// `determinant` is the sign of the determinant of the three corners.
template <class S>
crossing at_triangle(const part_corners<S, 3>& c, sign_type determinant) {
    if (ray_misses<S>(c)) return crossing::none;
    bool holds_origin = false;
    sign_type normal_x = sign_type::zero;
    for (std::size_t i = 0; i < 3; ++i) {
        const sign_type rise = rise_beside_origin(*c[i], *c[(i + 1) % 3]);
        if (!certain(rise)) return crossing::uncertain;
        if (rise == sign_type::zero) continue;
        holds_origin = !holds_origin;
        normal_x = rise;
    }
    if (!holds_origin) return crossing::none;
    if (!certain(determinant)) return crossing::uncertain;
    return determinant == normal_x ? crossing::odd : crossing::none;
}

/// The origin is in the triangle if it is in its plane and the corners' cross products do not point
/// opposite ways. (Patches test sides that they share, and triangles without area.)
template <class S>
crossing at_face(const part_corners<S, 3>& c) {
    if (ray_misses<S>(c)) return crossing::none;
    const std::array turns{cross(*c[0], *c[1]), cross(*c[1], *c[2]), cross(*c[2], *c[0])};
    const sign_type determinant = sign_of(dot(turns[0], *c[2])[0]);
    if (!certain(determinant)) return crossing::uncertain;
    if (determinant != sign_type::zero) return at_triangle<S>(c, determinant);
    bool holds_origin = false;
    for (std::size_t i = 0; i < 3; ++i) {
        const sign_type same_way = sign_of(dot(turns[i], turns[(i + 1) % 3])[0]);
        if (!certain(same_way)) return crossing::uncertain;
        if (same_way == sign_type::negative) return crossing::none;
        holds_origin = holds_origin || same_way == sign_type::positive;
    }
    return holds_origin ? crossing::at_origin : crossing::none;
}

/// If the patch's plane contains the origin, `flat_contact()` tests if the patch does.
template <class S, class FlatContact>
crossing at_patch(const part_corners<S, 4>& c, const FlatContact& flat_contact) {
    if (ray_misses<S>(c)) return crossing::none;
    // The origin's barycentric coordinates times the tetrahedron's volume, by Cramer's rule.
    const auto n02 = cross(*c[0], *c[2]), n13 = cross(*c[1], *c[3]);
    const std::array w{S(-dot(n13, *c[2])[0]), S(-dot(n02, *c[3])[0]), dot(n13, *c[0])[0],
                       dot(n02, *c[1])[0]};
    std::array<sign_type, 4> signs;
    std::ranges::transform(w, signs.begin(), [](const S& x) { return sign_of(x); });
    const auto some = [&signs](sign_type s) { return std::ranges::count(signs, s) > 0; };

    bool second_pair = false;
    if (!(some(sign_type::positive) && some(sign_type::negative))) {  // in the tetrahedron
        if (some(sign_type::uncertain)) return crossing::uncertain;
        if (!some(sign_type::positive) && !some(sign_type::negative)) return flat_contact();
        const sign_type beside = sign_of(w[0] * w[2] - w[1] * w[3]);
        if (!certain(beside)) return crossing::uncertain;
        if (beside == sign_type::zero) return crossing::at_origin;
        second_pair = beside == sign_type::positive;
    }
    return second_pair ? combined(at_triangle<S>({c[1], c[2], c[3]}, signs[0]),
                                  at_triangle<S>({c[0], c[1], c[3]}, signs[2]))
                       : combined(at_triangle<S>({c[0], c[1], c[2]}, -signs[3]),
                                  at_triangle<S>({c[0], c[2], c[3]}, -signs[1]));
}

/// flat_contact(i) is the test for patch i.
template <class S, class FlatContact>
crossing at_boundary(const boundary_image<S>& image, const FlatContact& flat_contact) {
    const auto corners_of = [&image]<std::size_t Corners>(const corner_indices<Corners>& indices) {
        part_corners<S, Corners> corners;
        std::ranges::transform(indices, corners.begin(),
                               [&image](std::size_t k) { return &image.corners[k]; });
        return corners;
    };
    crossing all = crossing::none;
    for (const auto& triangle : image.triangles) {
        const crossing one = at_face<S>(corners_of(triangle));
        if (one == crossing::at_origin) return one;
        all = combined(all, one);
    }
    for (std::size_t i = 0; i < image.patches.size(); ++i) {
        const crossing one =
            at_patch<S>(corners_of(image.patches[i]), [&] { return flat_contact(i); });
        if (one == crossing::at_origin) return one;
        all = combined(all, one);
    }
    return all;
}

template <template <class> class Query>
crossing in_integers(const Query<double>& original) {
    const auto query = detail::to_integers(original);
    const auto edges = vertex_edge_queries(query);
    return at_boundary(image_of(query), [&edges](std::size_t i) {
        return detail::vertex_touches_edge(edges[i]) ? crossing::at_origin : crossing::none;
    });
}

}  // namespace

template <cubic_query Query>
verdict decide_root_parity(const Query& query) {
    const auto [tracked, finite] = tracked_query<errbound::interval>(query);
    if (!finite) return {outcome::uncertain, cause::range};
    crossing found =
        at_boundary(image_of(tracked), [](std::size_t) { return crossing::uncertain; });
    if (found == crossing::uncertain) found = in_integers(query);
    return {found == crossing::none ? outcome::separate : outcome::collides, cause::none};
}

template verdict decide_root_parity(const vertex_face<double>&);
template verdict decide_root_parity(const edge_edge<double>&);

}  // namespace ccd
