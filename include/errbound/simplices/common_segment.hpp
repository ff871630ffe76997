// The segment that two crossing triangles have in common.
//   if (errbound::relation_of(a, b) == errbound::relation::crossing) {
//       const auto [from, to] = errbound::common_segment(a, b);  // from.position, from.error
//   }
//
// Each end is computed in floating point with a certified error, and with integers if that error is
// not small. No exceptions, except if memory runs out: the integers allocate.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <errbound/integers/dyadic.hpp>
#include <errbound/integers/integer.hpp>
#include <errbound/simplices/relation.hpp>
#include <errbound/simplices/types.hpp>
#include <errbound/tracked.hpp>
#include <limits>
#include <utility>

namespace errbound {

namespace simplices {

/// The offset from line[0] at which a line meets a plane (D = 3) or another line (D = 2), as
/// numerators and their divisor.
template <class Number, std::size_t D>
struct meeting_point {
    std::array<Number, D> offset;
    Number divisor;

    meeting_point(const std::array<point<D>, 2>& line, const std::array<point<D>, D>& flat) {
        const auto lifted = [](const point<D>& p) {
            std::array<Number, D> x;
            for (std::size_t i = 0; i < D; ++i) x[i] = number_from(p[i]);
            return x;
        };
        const auto a = lifted(line[0]), b = lifted(line[1]), p = lifted(flat[0]),
                   q = lifted(flat[1]);
        if constexpr (D == 2) {
            const auto at = forms::line_line(a, b, p, q);
            offset = {at.x, at.y}, divisor = at.w;
        } else {
            const auto r = lifted(flat[2]);
            const auto at = forms::line_plane(a, b, p, q, r);
            offset = {at.x, at.y, at.z}, divisor = at.w;
        }
    }
    static Number number_from(double x) {
        if constexpr (is_tracked<Number>)
            return x;
        else
            return Number::from(x);
    }
};
/// The point at which a segment meets a plane (D = 3) or another segment (D = 2). Evaluated exactly
/// if the error of floating point exceeds 2^-44 times the segment's largest coordinate.
template <std::size_t D>
located_point<D> located(const std::array<point<D>, 2>& line, const std::array<point<D>, D>& flat) {
    located_point<D> found{{}, 0};
    double largest = 0;
    for (const point<D>& p : line)
        for (const double x : p) largest = (std::max)(largest, std::abs(x));
    const meeting_point<tracked<double>, D> fast(line, flat);
    bool is_accurate = true;
    for (std::size_t i = 0; i < D; ++i) {
        const auto x = line[0][i] + fast.offset[i] / fast.divisor;
        is_accurate = is_accurate && x.error() <= 0x1p-44 * largest;
        found.position[i] = x.value();
        found.error = (std::max)(found.error, x.error());
    }
    if (is_accurate) return found;
    using number = dyadic<integer>;
    const meeting_point<number, D> exact(line, flat);
    found.error = 0;
    for (std::size_t i = 0; i < D; ++i) {
        const number numerator = number::from(line[0][i]) * exact.divisor + exact.offset[i];
        double& x = found.position[i] = 0;
        if (numerator.is_zero()) continue;
        // The quotient has 64 bits. Its conversion is off by at most one ulp, or two if subnormal.
        x = quotient(numerator, exact.divisor, 64).to_double();
        found.error = (std::max)(
            found.error, 0x1p-50 * std::abs(x) + 4 * std::numeric_limits<double>::denorm_min());
    }
    return found;
}

/// Where an edge of one triangle meets the other.
inline located_point<3> located(const simplex<3>& edge_of, const section& s,
                                const crossing_edge& edge, const simplex<3>& plane) {
    for (const int i : {edge.from, edge.to})
        if (s.side[static_cast<std::size_t>(i)] == 0) return {edge_of[i], 0};
    return located<3>({edge_of[edge.from], edge_of[edge.to]}, plane.vertices);
}
/// Preconditions: a and b cross, and are results of hull_of.
inline std::array<located_point<3>, 2> common_segment_of(const simplex<3>& a, const simplex<3>& b) {
    if (a.size < b.size) return common_segment_of(b, a);
    if (b.size < 3) {
        const located_point<3> p = located<3>({b[0], b[1]}, a.vertices);
        return {p, p};
    }
    const point<3>*p = a.vertices.data(), *q = b.vertices.data();
    const two_sections s{p, q, 0, section(sides_of(q, p, 3)), section(sides_of(p, q, 3))};
    const auto of_a = [&](const crossing_edge& edge) { return located(a, s.of_a, edge, b); };
    const auto of_b = [&](const crossing_edge& edge) { return located(b, s.of_b, edge, a); };
    return {s.order(s.of_a.low, s.of_b.high) >= 0 ? of_a(s.of_a.low) : of_b(s.of_b.high),
            s.order(s.of_a.high, s.of_b.low) <= 0 ? of_a(s.of_a.high) : of_b(s.of_b.low)};
}
inline std::array<located_point<2>, 2> common_segment_of(const simplex<2>& a, const simplex<2>& b) {
    const located_point<2> p = located<2>({a[0], a[1]}, {b[0], b[1]});
    return {p, p};
}

/// The ends in lexicographic order. Precondition: a and b cross.
template <std::size_t D>
std::array<located_point<D>, 2> common_segment(const simplex<D>& a, const simplex<D>& b) {
    auto ends = common_segment_of(hull_of(a), hull_of(b));
    if (ends[1].position < ends[0].position) std::swap(ends[0], ends[1]);
    return ends;
}

}  // namespace simplices

/// The ends of the segment that two crossing simplices have in common, in lexicographic order; the
/// same point twice if they meet in one. An end is a vertex, with error 0, or the intersection of
/// an edge and a plane. The error is at most 2^-44 times the edge's largest coordinate, or a few
/// ulps of the point's. Allocates if floating point does not suffice.
/// Precondition: relation_of(a, b) is crossing. In the plane: edges only.
template <std::floating_point T, std::size_t D, std::size_t K, std::size_t L>
std::array<located_point<D>, 2> common_segment(const std::array<std::array<T, D>, K>& a,
                                               const std::array<std::array<T, D>, L>& b) {
    static_assert(D == 3 || (D == 2 && K == 2 && L == 2),
                  "errbound: common_segment takes edges of the plane, or elements of space");
    return simplices::common_segment(simplices::simplex_of(simplices::as_doubles(a)),
                                     simplices::simplex_of(simplices::as_doubles(b)));
}

}  // namespace errbound
