#include <CGAL/Arr_segment_traits_2.h>
#include <CGAL/Arrangement_2.h>
#include <CGAL/Boolean_set_operations_2.h>
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/intersections.h>

#include <iterator>

#include "tests/bench/predicates/peers.hpp"

namespace bench {
namespace {

using kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using lazy_kernel = CGAL::Exact_predicates_exact_constructions_kernel;

template <class K>
auto point_of(const std::array<double, 2>& p) {
    return typename K::Point_2(p[0], p[1]);
}
template <class K>
auto point_of(const std::array<double, 3>& p) {
    return typename K::Point_3(p[0], p[1], p[2]);
}
/// Calls `decide` with the common point of two objects; 0 if there is none.
template <class Point>
int at_crossing(const auto& crossing, const auto& decide) {
    if (!crossing) return 0;
    const Point* const p = boost::get<Point>(&*crossing);
    return p == nullptr ? 0 : static_cast<int>(decide(*p));
}
int at_crossing_of(const auto& a, const auto& b, const auto& c, const auto& d, const auto& decide) {
    using K = lazy_kernel;
    return at_crossing<K::Point_2>(CGAL::intersection(K::Line_2(a, b), K::Line_2(c, d)), decide);
}

/// A pass over points that were converted before. `decide` returns a sign, or true for signs that
/// are not negative.
template <class K, std::size_t D, std::size_t N, class Decide>
cgal_pass pass_over(const input_set<D, N>& set, const Decide& decide) {
    using point = decltype(point_of<K>(set.points[0][0]));
    std::array<std::vector<point>, N> converted;
    for (std::size_t k = 0; k < N; ++k)
        for (const auto& p : set.points[k]) converted[k].push_back(point_of<K>(p));
    const auto call = [decide, converted](std::size_t i) {
        return [&]<std::size_t... I>(std::index_sequence<I...>) {
            return decide(converted[I][i]...);
        }
        (std::make_index_sequence<N>());
    };
    constexpr bool is_bool = std::is_same_v<decltype(call(0)), bool>;
    return {[call](std::size_t count, signs& out) {
                for (std::size_t i = 0; i < count; ++i) {
                    const int sign = is_bool ? (call(i) ? 1 : -1) : static_cast<int>(call(i));
                    out[i] = static_cast<errbound::sign_type>(1 + sign);
                }
            },
            is_bool};
}

/// The pass of the predicate with this name, after all have been added.
template <class K, std::size_t D, std::size_t N>
struct pass_of {
    std::string_view name;
    const input_set<D, N>& set;
    cgal_pass found = {};

    void add(std::string_view added, const auto& decide) {
        if (name == added) found = pass_over<K>(set, decide);
    }
};
template <class K, std::size_t D, std::size_t N>
void add_all(pass_of<K, D, N>&) {}
template <class K, std::size_t D>
void add_all(pass_of<K, D, 3>& pass) {
    pass.add(D == 2 ? "compare_distances2d" : "compare_distances3d",
             [](auto&... p) { return CGAL::compare_distance_to_point(p...); });
    if constexpr (D == 2) pass.add("orient2d", [](auto&... p) { return CGAL::orientation(p...); });
}
template <class K>
void add_all(pass_of<K, 2, 4>& pass) {
    using segment = typename K::Segment_2;
    pass.add("incircle", [](auto&... p) { return CGAL::side_of_oriented_circle(p...); });
    pass.add("compare_lengths2d", typename K::Compare_distance_2());
    pass.add("compare_slopes", [](auto& a, auto& b, auto& c, auto& d) {
        return CGAL::compare_slope(segment(a, b), segment(c, d));
    });
    pass.add("segments_intersect2d", [](auto& a, auto& b, auto& c, auto& d) {
        return CGAL::do_intersect(segment(a, b), segment(c, d));
    });
    pass.add("point_in_triangle2d", [](auto& p, auto& a, auto& b, auto& c) {
        return typename K::Triangle_2(a, b, c).bounded_side(p);
    });
    pass.add("segment_intersects_box2d", [](auto& p, auto& q, auto& a, auto& b) {
        return CGAL::do_intersect(segment(p, q), typename K::Iso_rectangle_2(a, b));
    });
    if constexpr (std::is_same_v<K, lazy_kernel>)
        pass.add("compare_directions", [](auto& a, auto& b, auto& c, auto& d) {
            return typename K::Compare_angle_with_x_axis_2()(typename K::Direction_2(b - a),
                                                             typename K::Direction_2(d - c));
        });
}
template <class K>
void add_all(pass_of<K, 3, 4>& pass) {
    using segment = typename K::Segment_3;
    // The opposite sign: errbound/predicates.hpp.
    pass.add("orient3d", [](auto&... p) { return -CGAL::orientation(p...); });
    pass.add("compare_lengths3d", typename K::Compare_distance_3());
    pass.add("segments_intersect3d", [](auto& a, auto& b, auto& c, auto& d) {
        return CGAL::do_intersect(segment(a, b), segment(c, d));
    });
    pass.add("segment_intersects_box3d", [](auto& p, auto& q, auto& a, auto& b) {
        return CGAL::do_intersect(segment(p, q), typename K::Iso_cuboid_3(a, b));
    });
}
template <class K>
void add_all(pass_of<K, 3, 5>& pass) {
    pass.add("insphere", [](auto&... p) { return -CGAL::side_of_oriented_sphere(p...); });
    pass.add("segment_intersects_triangle", [](auto& p, auto& q, auto&... corner) {
        return CGAL::do_intersect(typename K::Segment_3(p, q), typename K::Triangle_3(corner...));
    });
    pass.add("point_in_tetrahedron", [](auto& p, auto&... corner) {
        return typename K::Tetrahedron_3(corner...).bounded_side(p);
    });
}
template <class K>
void add_all(pass_of<K, 3, 6>& pass) {
    using triangle = typename K::Triangle_3;
    pass.add("triangle_intersects_triangle",
             [](auto& a, auto& b, auto& c, auto& d, auto& e, auto& f) {
                 return CGAL::do_intersect(triangle(a, b, c), triangle(d, e, f));
             });
}

// Constructed points: only the lazy kernel has them exactly.
void add_all(pass_of<lazy_kernel, 2, 6>& pass) {
    const auto turn = [](auto& a, auto& b, auto& c, auto& d, auto& q, auto& r) {
        return at_crossing_of(a, b, c, d, [&](auto& p) { return CGAL::orientation(p, q, r); });
    };
    pass.add("orient2d_line_line", turn);
    pass.add("orient2d of a crossing", turn);
}
void add_all(pass_of<lazy_kernel, 2, 7>& pass) {
    pass.add("incircle of a crossing",
             [](auto& p, auto& q, auto& r, auto& a, auto& b, auto& c, auto& d) {
                 return at_crossing_of(a, b, c, d, [&](auto& i) {
                     return CGAL::side_of_oriented_circle(p, q, r, i);
                 });
             });
}
void add_all(pass_of<lazy_kernel, 2, 8>& pass) {
    pass.add("compare_x_line_line", [](auto& a, auto& b, auto& c, auto& d, auto& e, auto& f,
                                       auto& g, auto& h) {
        return at_crossing_of(a, b, c, d, [&](auto& p) {
            return at_crossing_of(e, f, g, h, [&](auto& q) { return CGAL::compare_x(p, q); });
        });
    });
}
void add_all(pass_of<lazy_kernel, 2, 9>& pass) {
    pass.add("distances of two crossings",
             [](auto& a, auto& b, auto& c, auto& d, auto& e, auto& f, auto& g, auto& h, auto& p) {
                 return at_crossing_of(a, b, c, d, [&](auto& i) {
                     return at_crossing_of(e, f, g, h, [&](auto& j) {
                         return CGAL::compare_distance_to_point(i, j, p);
                     });
                 });
             });
}
void add_all(pass_of<lazy_kernel, 3, 8>& pass) {
    using K = lazy_kernel;
    const auto turn = [](auto& a, auto& b, auto& p, auto& q, auto& r, auto& s, auto& t, auto& u) {
        return at_crossing<K::Point_3>(CGAL::intersection(K::Line_3(a, b), K::Plane_3(p, q, r)),
                                       [&](auto& i) { return -CGAL::orientation(i, s, t, u); });
    };
    pass.add("orient3d_line_plane", turn);
    pass.add("orient3d of a crossing", turn);
}

template <class K, std::size_t D, std::size_t N>
cgal_pass pass_by(std::string_view name, const input_set<D, N>& set) {
    pass_of<K, D, N> pass{name, set};
    add_all(pass);
    return pass.found;
}

}  // namespace

template <std::size_t D, std::size_t N>
std::array<cgal_pass, 2> cgal_passes(std::string_view name, const input_set<D, N>& set) {
    return {pass_by<kernel>(name, set), pass_by<lazy_kernel>(name, set)};
}
#define ERRBOUND_CGAL_PASSES(D, N) \
    template std::array<cgal_pass, 2> cgal_passes<D, N>(std::string_view, const input_set<D, N>&);
ERRBOUND_CGAL_PASSES(2, 3)
ERRBOUND_CGAL_PASSES(2, 4)
ERRBOUND_CGAL_PASSES(2, 6)
ERRBOUND_CGAL_PASSES(2, 7)
ERRBOUND_CGAL_PASSES(2, 8)
ERRBOUND_CGAL_PASSES(2, 9)
ERRBOUND_CGAL_PASSES(3, 3)
ERRBOUND_CGAL_PASSES(3, 4)
ERRBOUND_CGAL_PASSES(3, 5)
ERRBOUND_CGAL_PASSES(3, 6)
ERRBOUND_CGAL_PASSES(3, 8)
#undef ERRBOUND_CGAL_PASSES

namespace {

CGAL::Polygon_2<lazy_kernel> polygon_of(const plane_points& points) {
    CGAL::Polygon_2<lazy_kernel> polygon;
    for (const auto& p : points) polygon.push_back({p[0], p[1]});
    return polygon;
}

}  // namespace

std::size_t cgal_delaunay3d(const space_points& points) {
    std::vector<kernel::Point_3> converted;
    for (const auto& p : points) converted.emplace_back(p[0], p[1], p[2]);
    const CGAL::Delaunay_triangulation_3<kernel> result(converted.begin(), converted.end());
    return result.number_of_finite_cells();
}
std::size_t cgal_arrangement(const plane_points& ends) {
    std::vector<lazy_kernel::Segment_2> segments;
    for (std::size_t i = 0; i + 1 < ends.size(); i += 2)
        segments.emplace_back(lazy_kernel::Point_2(ends[i][0], ends[i][1]),
                              lazy_kernel::Point_2(ends[i + 1][0], ends[i + 1][1]));
    CGAL::Arrangement_2<CGAL::Arr_segment_traits_2<lazy_kernel>> result;
    CGAL::insert(result, segments.begin(), segments.end());
    return result.number_of_vertices();
}
std::size_t cgal_intersection(const plane_points& first, const plane_points& second) {
    std::vector<CGAL::Polygon_with_holes_2<lazy_kernel>> result;
    CGAL::intersection(polygon_of(first), polygon_of(second), std::back_inserter(result));
    return result.size();
}

}  // namespace bench
