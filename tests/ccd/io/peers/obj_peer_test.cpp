// Our OBJ reader compared with tinyobjloader's.
#include <gtest/gtest.h>
#include <tiny_obj_loader.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "tests/ccd/io/peers/peer.hpp"

namespace {

using ccd::mesh;
using ccd::vertex_index;

/// The mesh that tinyobjloader reads, if it consists of triangles and edges.
std::optional<mesh> read_by_tinyobjloader(const std::string& text) {
    tinyobj::attrib_t attributes;
    std::vector<tinyobj::shape_t> shapes;
    std::vector<tinyobj::material_t> materials;
    std::string warning, error;
    std::istringstream stream(text);
    if (!tinyobj::LoadObj(&attributes, &shapes, &materials, &warning, &error, &stream, nullptr,
                          false))
        return std::nullopt;
    mesh m;
    const std::vector<double>& v = attributes.vertices;
    for (std::size_t i = 0; i < v.size(); i += 3) m.vertices.push_back({v[i], v[i + 1], v[i + 2]});
    const auto index = [](const tinyobj::index_t& i) {
        return static_cast<vertex_index>(i.vertex_index);
    };
    for (const tinyobj::shape_t& shape : shapes) {
        if (std::ranges::any_of(shape.mesh.num_face_vertices, [](int n) { return n != 3; }) ||
            std::ranges::any_of(shape.lines.num_line_vertices, [](int n) { return n != 2; }))
            return std::nullopt;
        const std::vector<tinyobj::index_t>&corners = shape.mesh.indices,
              &ends = shape.lines.indices;
        for (std::size_t i = 0; i < corners.size(); i += 3)
            m.faces.push_back({index(corners[i]), index(corners[i + 1]), index(corners[i + 2])});
        for (std::size_t i = 0; i < ends.size(); i += 2)
            m.edges.push_back({index(ends[i]), index(ends[i + 1])});
    }
    return m;
}

/// True if tinyobjloader may have read `x` as `peers`: it adds up digits in doubles.
bool is_near(double x, double peers) {
    return std::signbit(x) == std::signbit(peers) &&
           std::abs(x - peers) <= 0x1p-44 * std::abs(x) + 0x1p-1074;
}

TEST(Obj, IsReadAsByTinyobjloader) {
    peers::expect_same(ccd::fuzz::spelled_obj, ccd::io::parse_mesh_obj, read_by_tinyobjloader,
                       [](const mesh& ours, const mesh& theirs) {
                           return ours.faces == theirs.faces && ours.edges == theirs.edges &&
                                  std::ranges::equal(
                                      ours.vertices, theirs.vertices,
                                      [](const ccd::point<double>& p, const ccd::point<double>& q) {
                                          return is_near(p.x, q.x) && is_near(p.y, q.y) &&
                                                 is_near(p.z, q.z);
                                      });
                       });
}

}  // namespace
