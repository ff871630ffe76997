#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <memory>

#include "tests/bench/harness.hpp"
#include "tests/bench/intersections/peers.hpp"

namespace bench {

std::vector<std::function<void()>> cgal_passes(const ccd::mesh& mesh, face_pairs& pairs) {
    namespace processing = CGAL::Polygon_mesh_processing;
    using kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
    using surface = CGAL::Surface_mesh<kernel::Point_3>;
    std::vector<kernel::Point_3> points;
    for (const auto& p : mesh.vertices) points.emplace_back(p.x, p.y, p.z);
    std::vector<std::array<std::size_t, 3>> faces;
    for (const auto& [a, b, c] : mesh.faces) faces.push_back({a, b, c});
    const auto converted = std::make_shared<surface>();
    processing::polygon_soup_to_polygon_mesh(points, faces, *converted);
    return {[converted, &pairs] {
                std::vector<std::pair<surface::Face_index, surface::Face_index>> found;
                processing::self_intersections(*converted, std::back_inserter(found));
                pairs.clear();
                for (const auto& [f, g] : found)
                    pairs.push_back(std::minmax<std::size_t>(f.idx(), g.idx()));
                std::ranges::sort(pairs);
            },
            [converted] { keep(processing::does_self_intersect(*converted)); }};
}

}  // namespace bench
