// Signs that show how two simplices meet, for batches and reports (errbound/predicate.hpp). Single
// pairs are decided faster by relation_of (errbound/simplices/relation.hpp).
#pragma once

#include <array>
#include <errbound/predicates.hpp>
#include <errbound/simplices/relation.hpp>

namespace errbound {

namespace forms {

/// Positive if two triangles cross, zero if they touch or overlap, negative if they are disjoint.
constexpr sign_type triangles_intersect(const auto& a, const auto& b, const auto& c, const auto& p,
                                        const auto& q, const auto& r) {
    const auto sides_of = [](const auto& x, const auto& y, const auto& z, const auto&... s) {
        return std::array{sign_of(volume(x, y, z, s))...};
    };
    const std::array of_b = sides_of(a, b, c, p, q, r);
    for (const sign_type s : of_b)
        if (!certain(s)) return s;
    if (of_b[0] != sign_type::zero && of_b[0] == of_b[1] && of_b[0] == of_b[2])
        return sign_type::negative;
    const std::array of_a = sides_of(p, q, r, a, b, c);
    for (const sign_type s : of_a)
        if (!certain(s)) return s;
    if (of_a[0] != sign_type::zero && of_a[0] == of_a[1] && of_a[0] == of_a[2])
        return sign_type::negative;
    using simplices::as_int;
    const simplices::sides sides_of_a{as_int(of_a[0]), as_int(of_a[1]), as_int(of_a[2])};
    const simplices::sides sides_of_b{as_int(of_b[0]), as_int(of_b[1]), as_int(of_b[2])};
    if (simplices::all_zero(sides_of_a) || simplices::all_zero(sides_of_b)) {
        // Coplanar, or one is a segment: some edge meets the other triangle.
        sign_type greatest = sign_type::negative;
        const auto decided = [&](const auto&... edge_and_triangle) {
            const sign_type s = segment_triangle(edge_and_triangle...);
            if (s != sign_type::negative) greatest = s;
            return s == sign_type::positive || !certain(s);
        };
        (void)(decided(a, b, p, q, r) || decided(b, c, p, q, r) || decided(c, a, p, q, r) ||
               decided(p, q, a, b, c) || decided(q, r, a, b, c) || decided(r, p, a, b, c));
        return greatest;
    }
    const auto with_edge = [](const simplices::crossing_edge& e, const auto& x, const auto& y,
                              const auto& z, const auto& f) {
        const bool forward = e.to == (e.from + 1) % 3;
        const int first = forward ? e.from : e.to;
        const sign_type s = first == 0 ? f(x, y) : first == 1 ? f(y, z) : f(z, x);
        return forward ? s : -s;
    };
    const auto order = [&](const simplices::crossing_edge& x, const simplices::crossing_edge& y) {
        return -with_edge(x, a, b, c, [&](const auto& x0, const auto& x1) {
            return with_edge(y, p, q, r, [&](const auto& y0, const auto& y1) {
                return sign_of(volume(x0, x1, y0, y1));
            });
        });
    };
    const simplices::section x(sides_of_a), y(sides_of_b);
    const sign_type after = order(x.high, y.high), before = -order(x.low, y.low);
    for (const sign_type s : {after, before})
        if (s == sign_type::negative || !certain(s)) return s;
    return x.has_interior && y.has_interior ? after * before : sign_type::zero;
}

}  // namespace forms

/// For closed triangles abc and pqr: positive if they cross, zero if they touch or overlap,
/// negative if they are disjoint (see relation). Degenerate ones count as segments or points.
inline constexpr auto triangle_intersects_triangle =
    predicate<points<3, 3, 3, 3, 3, 3>, homogeneous_options>(
        [](const auto& a, const auto& b, const auto& c, const auto& p, const auto& q,
           const auto& r) { return forms::triangles_intersect(a, b, c, p, q, r); });

}  // namespace errbound
