// Exact relations of points, edges and triangles at rest, in the plane and in space.
//   const std::array<std::array<double, 3>, 3> a{...}, b{...};
//   if (errbound::relation_of(a, b) != errbound::relation::disjoint) ...
//
// The relation is never wrong: it depends only on signs of orient2d and orient3d and on comparisons
// of coordinates. Precondition: coordinates are finite; otherwise the relation is unspecified.
// Degenerate elements count as the segments or points that they are. No exceptions, no allocation.
// Disjoint triangles cost 10 to 40 ns, those with a common vertex 15 ns, coplanar ones 100 to 200
// ns.
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <errbound/predicates.hpp>
#include <errbound/simplices/types.hpp>
#include <type_traits>

namespace errbound {

namespace simplices {

template <std::size_t D>
using point = std::array<double, D>;

/// A point, segment or triangle: the first `size` points.
template <std::size_t D>
struct simplex {
    std::array<point<D>, 3> vertices{};
    int size = 0;

    constexpr const point<D>& operator[](int i) const {
        return vertices[static_cast<std::size_t>(i)];
    }
    constexpr const point<D>* begin() const { return vertices.data(); }
    constexpr const point<D>* end() const { return vertices.data() + size; }
    constexpr void add(const point<D>& p) { vertices[static_cast<std::size_t>(size++)] = p; }
};

template <std::size_t D>
constexpr simplex<D> simplex_of(const point<D>* p, int size) {
    simplex<D> s;
    for (int i = 0; i < size; ++i) s.add(p[i]);
    return s;
}
template <std::size_t D, std::size_t K>
constexpr simplex<D> simplex_of(const std::array<point<D>, K>& p) {
    return simplex_of(p.data(), int{K});
}
template <std::floating_point T, std::size_t D, std::size_t K>
constexpr std::array<point<D>, K> as_doubles(const std::array<std::array<T, D>, K>& p) {
    std::array<point<D>, K> doubles{};
    for (std::size_t i = 0; i < K; ++i)
        for (std::size_t k = 0; k < D; ++k) doubles[i][k] = static_cast<double>(p[i][k]);
    return doubles;
}

/// The intersection of two simplices: its dimension (−1 if it is empty), and true if their relative
/// interiors meet.
struct intersection {
    int dimension;
    bool of_interiors;
};

/// −1, 0 or 1; unspecified if a coordinate is not finite.
constexpr int as_int(sign_type s) {
    return s == sign_type::positive ? 1 : s == sign_type::negative ? -1 : 0;
}
/// True if a coordinate is the same for all points, or two points are equal: then the determinant
/// is zero. This test is cheaper than exact arithmetic.
template <class... Points>
constexpr bool clearly_degenerate(const Points&... p) {
    const std::array list{&p...};
    for (std::size_t k = 0; k < list[0]->size(); ++k)
        if (std::all_of(list.begin(), list.end(), [&](auto q) { return (*q)[k] == (*list[0])[k]; }))
            return true;
    for (auto q = list.begin(); q != list.end(); ++q)
        for (auto r = list.begin(); r != q; ++r)
            if (**q == **r) return true;
    return false;
}
template <class Predicate, class... Points>
constexpr int sign_after_filter(const Predicate& predicate, const Points&... p) {
    return clearly_degenerate(p...) ? 0 : as_int(predicate(p...));
}
template <class Predicate, class... Points>
constexpr int quick_sign(const Predicate& predicate, const Points&... p) {
    if (!std::is_constant_evaluated()) {
        const sign_type s = filters::conclude(predicate.filtered(p...));
        if (certain(s)) [[likely]]
            return as_int(s);
    }
    return sign_after_filter(predicate, p...);
}
constexpr int sign2d(const point<2>& a, const point<2>& b, const point<2>& c) {
    return quick_sign(orient2d, a, b, c);
}
constexpr int sign3d(const point<3>& a, const point<3>& b, const point<3>& c, const point<3>& d) {
    return quick_sign(orient3d, a, b, c, d);
}

/// The coordinates except `axis`, in cyclic order.
constexpr point<2> projected(const point<3>& p, int axis) {
    return {p[static_cast<std::size_t>((axis + 1) % 3)],
            p[static_cast<std::size_t>((axis + 2) % 3)]};
}
constexpr simplex<2> projected(const simplex<3>& s, int axis) {
    simplex<2> flat;
    for (const point<3>& p : s) flat.add(projected(p, axis));
    return flat;
}

/// The first and the last point in lexicographic order, which is the order along any line.
template <std::size_t D>
struct extent {
    point<D> low, high;
};
template <std::size_t D>
constexpr extent<D> extent_of(const simplex<D>& s) {
    extent<D> e{s[0], s[0]};
    for (const point<D>& p : s) {
        if (p < e.low) e.low = p;
        if (e.high < p) e.high = p;
    }
    return e;
}

constexpr bool are_collinear(const point<2>& a, const point<2>& b, const point<2>& c) {
    return sign2d(a, b, c) == 0;
}
/// The axis along which a triangle's projection is largest, up to rounding.
constexpr int likely_axis(const point<3>& a, const point<3>& b, const point<3>& c) {
    if (std::is_constant_evaluated()) return 0;
    int axis = 0;
    double largest = 0;
    for (int k = 0; k < 3; ++k) {
        const point<2> p = projected(a, k), q = projected(b, k), r = projected(c, k);
        const double area = std::abs((q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]));
        if (area > largest) largest = area, axis = k;
    }
    return axis;
}
constexpr bool are_collinear(const point<3>& a, const point<3>& b, const point<3>& c) {
    const int first = likely_axis(a, b, c);
    for (int k = first; k < first + 3; ++k)
        if (!are_collinear(projected(a, k % 3), projected(b, k % 3), projected(c, k % 3)))
            return false;
    return true;
}

/// Returns the same set without the vertices that the others span.
template <std::size_t D>
constexpr simplex<D> hull_of(const simplex<D>& s) {
    if (s.size == 3 && !are_collinear(s[0], s[1], s[2])) return s;
    const auto [low, high] = extent_of(s);
    simplex<D> hull;
    hull.add(low);
    if (low != high) hull.add(high);
    return hull;
}

/// Precondition: all vertices are on one line.
template <std::size_t D>
constexpr intersection meet_on_line(const simplex<D>& a, const simplex<D>& b) {
    const extent<D> of_a = extent_of(a), of_b = extent_of(b);
    const point<D>& low = (std::max)(of_a.low, of_b.low);
    const point<D>& high = (std::min)(of_a.high, of_b.high);
    if (high < low) return {-1, false};
    if (low < high) return {1, true};
    const bool is_end = low == of_a.low || low == of_a.high;
    const bool is_end_of_b = low == of_b.low || low == of_b.high;
    const bool a_is_point = of_a.low == of_a.high, b_is_point = of_b.low == of_b.high;
    return {0, (a_is_point || !is_end) && (b_is_point || !is_end_of_b)};
}

/// True if the line through an edge of `a` separates a from b, perhaps touching both; then it sets
/// their intersection. Precondition: as for meet_in_plane.
constexpr bool separated_by_edge(const simplex<2>& a, const simplex<2>& b, intersection& found) {
    const int edges = a.size == 3 ? 3 : a.size - 1;
    for (int i = 0; i < edges; ++i) {
        const point<2>&p = a[i], &q = a[(i + 1) % a.size];
        const int inside = a.size == 3 ? sign2d(p, q, a[(i + 2) % 3]) : 0;
        bool left = false, right = false;
        simplex<2> on_edge, on_line;
        for (const point<2>& r : b) {
            const int side = sign2d(p, q, r);
            (side > 0 ? left : right) |= side != 0;
            if (side == 0) on_line.add(r);
        }
        if ((left && right) || (inside > 0 && left) || (inside < 0 && right)) continue;
        on_edge.add(p), on_edge.add(q);
        found = {on_line.size == 0 ? -1 : meet_on_line(on_edge, on_line).dimension, false};
        return true;
    }
    return false;
}
/// Two convex sets whose interiors do not meet are separated by the line through an edge, and meet
/// in that line. Precondition: a and b are results of hull_of, and together span the plane.
constexpr intersection meet_in_plane(const simplex<2>& a, const simplex<2>& b) {
    intersection found{a.size + b.size - 4, true};
    if (!separated_by_edge(a, b, found)) separated_by_edge(b, a, found);
    return found;
}
constexpr bool span_plane(const simplex<2>& a, const simplex<2>& b) {
    if (a.size == 3 && !are_collinear(a[0], a[1], a[2])) return true;
    const extent<2> of_a = extent_of(a), of_b = extent_of(b);
    const point<2>& low = (std::min)(of_a.low, of_b.low);
    const point<2>& high = (std::max)(of_a.high, of_b.high);
    for (const simplex<2>* s : {&a, &b})
        for (const point<2>& p : *s)
            if (p != low && p != high && !are_collinear(low, high, p)) return true;
    return false;
}

/// Preconditions: a and b are results of hull_of; all vertices are in one plane.
constexpr intersection meet_flat(const simplex<2>& a, const simplex<2>& b) {
    return span_plane(a, b) ? meet_in_plane(a, b) : meet_on_line(a, b);
}
constexpr intersection meet_flat(const simplex<3>& a, const simplex<3>& b) {
    const int first = a.size == 3 ? likely_axis(a[0], a[1], a[2]) : 0;
    for (int k = first; k < first + 3; ++k) {
        const simplex<2> flat_a = projected(a, k % 3), flat_b = projected(b, k % 3);
        if (span_plane(flat_a, flat_b)) return meet_in_plane(flat_a, flat_b);
    }
    return meet_on_line(a, b);
}

/// The sides of a triangle's plane on which vertices lie, as signs of orient3d.
using sides = std::array<int, 3>;
/// Computes the sides of the vertices from `first` on. The filter computes the normal once; it has
/// as many roundings as the filter of orient3d.
constexpr sides sides_of(const point<3>* plane, const point<3>* s, int size, int first = 0) {
    sides found{};
    const point<3>&a = plane[0], &b = plane[1], &c = plane[2];
    const auto minus = [](const point<3>& p, const point<3>& q, std::size_t k) {
        return filters::filtered_coordinate<double>{p[k]} -
               filters::filtered_coordinate<double>{q[k]};
    };
    const auto bx = minus(b, a, 0), by = minus(b, a, 1), bz = minus(b, a, 2);
    const auto cx = minus(c, a, 0), cy = minus(c, a, 1), cz = minus(c, a, 2);
    const auto x = by * cz - bz * cy, y = bz * cx - bx * cz, z = bx * cy - by * cx;
    for (int i = first; i < size; ++i) {
        sign_type side = sign_type::uncertain;
        if (!std::is_constant_evaluated())
            side = sign_of(x * minus(a, s[i], 0) + y * minus(a, s[i], 1) + z * minus(a, s[i], 2));
        found[static_cast<std::size_t>(i)] =
            certain(side) ? as_int(side) : sign_after_filter(orient3d, a, b, c, s[i]);
    }
    return found;
}
constexpr bool all_zero(const sides& s) {
    return s[0] == 0 && s[1] == 0 && s[2] == 0;
}
/// True if the vertices from first to size − 1 are strictly on one side. Proof:
/// proofs/contact/Intersections.v, one_side_apart.
constexpr bool on_one_side(const sides& s, int size, int first = 0) {
    for (int i = first; i < size; ++i)
        if (s[static_cast<std::size_t>(i)] == 0 ||
            s[static_cast<std::size_t>(i)] != s[static_cast<std::size_t>(first)])
            return false;
    return true;
}

/// An edge from a vertex with a side >= 0 to one with a side <= 0; not both are 0. It meets the
/// plane once.
struct crossing_edge {
    int from, to;
};
/// The segment in which a triangle meets a plane. Its vertices run counterclockwise as seen from
/// here: those on the positive side are to the right of the way from the low to the high end.
/// Precondition: the sides are neither all zero nor
/// strictly the same.
struct section {
    sides side;
    crossing_edge low{}, high{};
    bool has_interior;  ///< meets the triangle's interior

    constexpr explicit section(const sides& s) : side(s) {
        const auto at = [&](int i) { return s[static_cast<std::size_t>(i % 3)]; };
        has_interior = at(0) * at(1) < 0 || at(1) * at(2) < 0 || at(2) * at(0) < 0;
        // A vertex on a side of the plane on which the two others are not.
        int one = 0, its_side = 0;
        for (int i = 0; i < 3; ++i)
            if (at(i) != 0 && at(i + 1) != at(i) && at(i + 2) != at(i)) one = i, its_side = at(i);
        if (its_side == 0) {  // only a vertex is in the plane
            one = at(0) == 0 ? 0 : at(1) == 0 ? 1 : 2;
            its_side = -at(one + 1);
        }
        const int next = (one + 1) % 3, previous = (one + 2) % 3;
        if (its_side > 0)
            low = {one, previous}, high = {one, next};
        else
            low = {next, one}, high = {previous, one};
    }
};

/// Two triangles in different planes, both with a section by the other's plane. Both sections are
/// on the line in which the planes meet; b's goes from its high to its low end in a's direction.
/// Proof: proofs/contact/Intersections.v, section_ends, sections_right.
struct two_sections {
    const point<3>*a, *b;
    int common;  ///< the number of first vertices that a and b share
    section of_a, of_b;

    /// The order along the line of a point of a's section and one of b's. Let X and Y be the points
    /// of edges pq and rs. (p − q) × (r − s) points along the line, so the sign of
    /// orient3d(p, q, r, s) is that of Y − X.
    constexpr int order(const crossing_edge& x, const crossing_edge& y) const {
        for (const int i : {x.from, x.to})
            if (i < common && (i == y.from || i == y.to)) return 0;
        return -sign3d(a[x.from], a[x.to], b[y.from], b[y.to]);
    }
    constexpr relation relation_of_triangles() const {
        const int after = order(of_a.high, of_b.high);
        if (after < 0) return relation::disjoint;
        const int before = order(of_a.low, of_b.low);
        if (before > 0) return relation::disjoint;
        if (after == 0 || before == 0) return common > 0 ? relation::disjoint : relation::touching;
        return of_a.has_interior && of_b.has_interior ? relation::crossing : relation::touching;
    }
};

/// The intersection of a segment and a triangle. The segment's ends are on these sides of the
/// triangle's plane, not both zero. Proof: proofs/contact/Intersections.v, edge_meets_face,
/// edge_crosses_face.
constexpr intersection meet_edge(const point<3>* edge, const point<3>* face, int side_of_first,
                                 int side_of_last) {
    if (side_of_first == side_of_last) return {-1, false};
    bool left = false, right = false, on_edge = false;
    for (int i = 0; i < 3; ++i) {
        const int s = sign3d(edge[0], edge[1], face[i], face[(i + 1) % 3]);
        (s == 0 ? on_edge : s < 0 ? left : right) = true;
        if (left && right) return {-1, false};
    }
    return {0, !on_edge && side_of_first * side_of_last < 0};
}

/// Preconditions: a and b are results of hull_of. If `flat` is true and a is a triangle, b is in
/// its plane. If both are triangles, `flat` is true.
constexpr intersection meet(const simplex<2>& a, const simplex<2>& b, bool) {
    return meet_flat(a, b);
}
constexpr intersection meet(const simplex<3>& a, const simplex<3>& b, bool flat) {
    if (a.size == 3 && flat) return meet_flat(a, b);
    if (a.size < b.size) return meet(b, a, false);
    if (a.size == 3) {
        const point<3>*face = a.vertices.data(), *edge = b.vertices.data();
        const sides of_b = sides_of(face, edge, b.size);
        if (on_one_side(of_b, b.size)) return {-1, false};
        if (!all_zero(of_b)) return meet_edge(edge, face, of_b[0], of_b[1]);
    }
    if (a.size == 2 && b.size == 2 && sign3d(a[0], a[1], b[0], b[1]) != 0) return {-1, false};
    return meet_flat(a, b);
}

/// The relation of simplices that meet so. Precondition: a and b are results of hull_of.
template <std::size_t D>
constexpr relation relation_from(const intersection& x, const simplex<D>& a, const simplex<D>& b,
                                 const simplex<D>& common) {
    if (x.dimension < 0) return relation::disjoint;
    if (common.size > 0 && x.dimension == 0) return relation::disjoint;
    if (common.size == 2 && x.dimension == 1) {
        // Unless both are segments, they meet in the edge only.
        if (a.size == 3 || b.size == 3) return relation::disjoint;
        const extent<D> of_a = extent_of(a), of_b = extent_of(b), shared = extent_of(common);
        if (!((std::max)(of_a.low, of_b.low) < shared.low) &&
            !(shared.high < (std::min)(of_a.high, of_b.high)))
            return relation::disjoint;
    }
    if (!x.of_interiors) return relation::touching;
    if (x.dimension > 0 && x.dimension == a.size - 1 && x.dimension == b.size - 1)
        return relation::overlapping;
    return a.size + b.size - 2 - x.dimension == int{D} ? relation::crossing : relation::touching;
}

/// Decides all cases, from hull_of(a) and hull_of(b). If `flat` is true and a is a proper triangle,
/// b is in its plane.
template <std::size_t D>
[[gnu::noinline]] constexpr relation any_relation(const simplex<D>& a, const simplex<D>& b,
                                                  int common, bool flat = false) {
    simplex<D> shared;
    for (int i = 0; i < common; ++i) shared.add(a[i]);
    const simplex<D> hull_a = hull_of(a), hull_b = hull_of(b);
    return relation_from(meet(hull_a, hull_b, flat), hull_a, hull_b, shared);
}
[[gnu::noinline]] constexpr relation any_relation(const point<3>* a, int size, const point<3>* b,
                                                  int size_of_b, int common, bool flat) {
    return any_relation(simplex_of(a, size), simplex_of(b, size_of_b), common, flat);
}

constexpr relation relation_of_edges(const point<2>* a, const point<2>* b, int common) {
    const auto side = [](const point<2>* edge, const point<2>& p) {
        return sign2d(edge[0], edge[1], p);
    };
    const int last = side(a, b[1]);
    if (common == 1 && last != 0) return relation::disjoint;
    if (common == 0) {
        const int of_b = side(a, b[0]) * last;
        if (of_b > 0) return relation::disjoint;
        const int of_a = side(b, a[0]) * side(b, a[1]);
        if (of_a > 0) return relation::disjoint;
        if (of_a < 0 && of_b < 0) return relation::crossing;
    }
    return any_relation(simplex_of(a, 2), simplex_of(b, 2), common);
}
constexpr relation relation_of_edges(const point<3>* a, const point<3>* b, int common) {
    if (common == 1 ? !are_collinear(a[0], a[1], b[1]) : sign3d(a[0], a[1], b[0], b[1]) != 0)
        return relation::disjoint;
    return any_relation(a, 2, b, 2, common, false);
}
constexpr relation relation_of_faces(const point<3>* a, const point<3>* b, int common) {
    if (common == 2)
        return sign3d(a[0], a[1], a[2], b[2]) != 0 ? relation::disjoint
                                                   : any_relation(a, 3, b, 3, common, true);
    const sides of_b = sides_of(a, b, 3, common);
    if (on_one_side(of_b, 3, common)) return relation::disjoint;
    if (all_zero(of_b)) return any_relation(a, 3, b, 3, common, true);
    const sides of_a = sides_of(b, a, 3, common);
    if (on_one_side(of_a, 3, common)) return relation::disjoint;
    if (all_zero(of_a)) return any_relation(b, 3, a, 3, common, true);
    return two_sections{a, b, common, section(of_a), section(of_b)}.relation_of_triangles();
}
/// A vertex or an edge, and a face.
constexpr relation relation_with_face(const point<3>* a, int size, const point<3>* face,
                                      int common) {
    const sides s = sides_of(face, a, size, common);
    if (on_one_side(s, size, common)) return relation::disjoint;
    if (all_zero(s)) return any_relation(face, 3, a, size, common, true);
    const intersection x = meet_edge(a, face, s[0], s[1]);
    return x.dimension < 0  ? relation::disjoint
           : x.of_interiors ? relation::crossing
                            : relation::touching;
}

/// The relation of simplices of 1 to 3 vertices. Preconditions: a[i] equals b[i] for i < common,
/// and common is less than both sizes.
template <std::size_t D>
constexpr relation relation_of(const simplex<D>& a, const simplex<D>& b, int common = 0) {
    const point<D>*p = a.begin(), *q = b.begin();
    if (a.size == 2 && b.size == 2) return relation_of_edges(p, q, common);
    if constexpr (D == 3) {
        if (a.size == 3 && b.size == 3) return relation_of_faces(p, q, common);
        if (b.size == 3) return relation_with_face(p, a.size, q, common);
        if (a.size == 3) return relation_with_face(q, b.size, p, common);
    }
    return any_relation(a, b, common);
}

}  // namespace simplices

/// The relation of two simplices of 1 to 3 vertices: vertices, edges and triangles in the plane
/// (D = 2) or in space (D = 3). The first `common` vertices of both are the same: points of the
/// simplex that they span do not count. The result does not depend on the order of the others, nor
/// on that of a and b.
///
/// In space, an edge within the plane of a face touches the face, even if it passes through the
/// face's interior. In the plane, a face crosses an edge or a vertex that meets its interior.
/// Degenerate elements count as the segments or points that they are.
///
/// Preconditions: coordinates are finite; common is less than K and L.
template <std::floating_point T, std::size_t D, std::size_t K, std::size_t L>
constexpr relation relation_of(const std::array<std::array<T, D>, K>& a,
                               const std::array<std::array<T, D>, L>& b, std::size_t common = 0) {
    static_assert(
        (D == 2 || D == 3) && K >= 1 && K <= 3 && L >= 1 && L <= 3 && sizeof(T) <= sizeof(double),
        "errbound: relation_of takes simplices of 1 to 3 points of 2 or 3 coordinates, "
        "float or double");
    assert(
        common < K && common < L && std::equal(a.begin(), a.begin() + common, b.begin()) &&
        "errbound: the first `common` vertices of both simplices are equal, and both have others");
    return simplices::relation_of(simplices::simplex_of(simplices::as_doubles(a)),
                                  simplices::simplex_of(simplices::as_doubles(b)),
                                  static_cast<int>(common));
}

}  // namespace errbound
