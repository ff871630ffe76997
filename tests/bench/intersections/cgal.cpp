#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <limits>

#include "tests/bench/harness.hpp"
#include "tests/bench/intersections/peers.hpp"

namespace bench {

peer_result intersections_by_cgal(const ccd::mesh& mesh, int repeats) {
    namespace processing = CGAL::Polygon_mesh_processing;
    using kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
    using surface = CGAL::Surface_mesh<kernel::Point_3>;
    std::vector<kernel::Point_3> points;
    for (const auto& p : mesh.vertices) points.emplace_back(p.x, p.y, p.z);
    std::vector<std::array<std::size_t, 3>> faces;
    for (const auto& [a, b, c] : mesh.faces) faces.push_back({a, b, c});
    surface converted;
    processing::polygon_soup_to_polygon_mesh(points, faces, converted);

    constexpr double never = std::numeric_limits<double>::infinity();
    peer_result best{never, never, {}};
    for (int i = 0; i < repeats; ++i) {
        std::vector<std::pair<surface::Face_index, surface::Face_index>> found;
        const clock::time_point start = clock::now();
        processing::self_intersections(converted, std::back_inserter(found));
        best.all_seconds = std::min(best.all_seconds, seconds_since(start));
        const clock::time_point again = clock::now();
        keep(processing::does_self_intersect(converted));
        best.any_seconds = std::min(best.any_seconds, seconds_since(again));
        best.pairs.clear();
        for (const auto& [f, g] : found)
            best.pairs.push_back(std::minmax<std::size_t>(f.idx(), g.idx()));
    }
    std::ranges::sort(best.pairs);
    return best;
}

}  // namespace bench
