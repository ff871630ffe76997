#include <CGAL/Arr_segment_traits_2.h>
#include <CGAL/Arrangement_2.h>
#include <CGAL/Boolean_set_operations_2.h>
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <iterator>

#include "tests/bench/predicates/constructions.hpp"

namespace bench {
namespace {

using kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using lazy_kernel = CGAL::Exact_predicates_exact_constructions_kernel;

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
