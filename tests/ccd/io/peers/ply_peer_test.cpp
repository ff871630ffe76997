// Our PLY reader compared with CGAL's.
#undef NDEBUG  // CGAL's assertions keep it from reading properties of other types than it expects
#include <CGAL/IO/PLY.h>
#include <CGAL/Simple_cartesian.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <sstream>

#include "tests/ccd/io/meshes.hpp"
#include "tests/ccd/io/peers/peer.hpp"

namespace {

using ccd::mesh;

/// The mesh that CGAL reads, without edges, if it consists of triangles and the whole text was
/// read.
std::optional<mesh> read_by_cgal(const std::string& text) {
    std::vector<CGAL::Simple_cartesian<double>::Point_3> points;
    std::vector<std::vector<std::size_t>> polygons;
    std::istringstream stream(text);
    if (!CGAL::IO::read_PLY(stream, points, polygons, CGAL::parameters::verbose(false)))
        return std::nullopt;
    stream.clear();
    const std::string rest(std::istreambuf_iterator<char>(stream), {});
    if (rest.find_first_not_of(" \t\r\n") != rest.npos) return std::nullopt;
    mesh m;
    for (const auto& p : points) m.vertices.push_back({p.x(), p.y(), p.z()});
    for (const std::vector<std::size_t>& polygon : polygons) {
        if (polygon.size() != 3) return std::nullopt;
        ccd::face& corners = m.faces.emplace_back();
        std::ranges::transform(polygon, corners.begin(),
                               [](std::size_t i) { return static_cast<ccd::vertex_index>(i); });
    }
    return m;
}

TEST(Ply, IsReadAsByCgal) {
    peers::expect_same(ccd::fuzz::spelled_ply, ccd::io::parse_mesh_ply, read_by_cgal,
                       [](mesh ours, const mesh& theirs) {
                           ours.edges.clear();
                           return test_meshes::same_mesh(ours, theirs);
                       });
}

}  // namespace
