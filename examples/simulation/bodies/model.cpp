#include "examples/simulation/bodies/model.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace simulation {
namespace {

vec3 row(const rows& x, std::size_t v) {
    return x.row(static_cast<Eigen::Index>(v)).transpose();
}

/// Returns the term of F = (x1 − x0, ...)·rest⁻¹, whose singular values are stretches.
template <int Columns>
elastic_term stretch_term(const std::array<vertex_index, 4>& vertex,
                          const Eigen::Matrix<double, Columns, Columns>& rest, double weight,
                          double low, double high) {
    elastic_term term{
        elastic_term::target::singular_values, Columns, Columns + 1, vertex, {}, weight, low, high};
    const Eigen::Matrix<double, Columns, Columns> inverse = rest.inverse();
    for (int c = 0; c < Columns; ++c)
        for (int i = 0; i < Columns; ++i) {
            term.gradients[std::size_t(i) + 1][std::size_t(c)] = inverse(i, c);
            term.gradients[0][std::size_t(c)] -= inverse(i, c);
        }
    return term;
}

Eigen::Matrix2d in_plane(const vec3& e1, const vec3& e2) {
    const vec3 x = e1.normalized();
    const vec3 y = (e2 - e2.dot(x) * x).normalized();
    return Eigen::Matrix2d{{e1.dot(x), e2.dot(x)}, {0, e2.dot(y)}};
}

double cotangent(const vec3& a, const vec3& b) {
    return a.dot(b) / a.cross(b).norm();
}

std::vector<ccd::face> boundary(const std::vector<std::array<vertex_index, 4>>& tetrahedra) {
    std::map<ccd::face, std::pair<ccd::face, int>> seen;
    for (const auto& [a, b, c, d] : tetrahedra)
        for (const ccd::face& f : {ccd::face{a, c, b}, {a, b, d}, {a, d, c}, {b, c, d}}) {
            ccd::face key = f;
            std::ranges::sort(key);
            auto& [face, count] = seen[key];
            face = f;
            ++count;
        }
    std::vector<ccd::face> found;
    for (const auto& [key, entry] : seen)
        if (entry.second == 1) found.push_back(entry.first);
    return found;
}

}  // namespace

vertex_index model::append(const rows& shape) {
    const auto first = static_cast<vertex_index>(vertices());
    start.conservativeResize(start.rows() + shape.rows(), 3);
    start.bottomRows(shape.rows()) = shape;
    const int number = body.empty() ? 0 : body.back() + 1;
    mass.resize(mass.size() + static_cast<std::size_t>(shape.rows()), 0.0);
    body.resize(mass.size(), number);
    return first;
}

vertex_index model::add_obstacle(const rows& shape, const std::vector<ccd::face>& triangles) {
    const vertex_index first = append(shape);
    for (const auto& [a, b, c] : triangles) faces.push_back({first + a, first + b, first + c});
    return first;
}

vertex_index model::add_cloth(const rows& shape, const std::vector<ccd::face>& triangles,
                              const cloth_material& material) {
    const vertex_index first = add_obstacle(shape, triangles);
    for (const ccd::face& f : triangles) {
        const vec3 e1 = row(shape, f[1]) - row(shape, f[0]),
                   e2 = row(shape, f[2]) - row(shape, f[0]);
        const double area = e1.cross(e2).norm() / 2;
        for (const vertex_index v : f) mass[first + v] += material.density * area / 3;
        const std::array<vertex_index, 4> at{first + f[0], first + f[1], first + f[2], 0};
        const Eigen::Matrix2d rest = in_plane(e1, e2);
        terms.push_back(stretch_term<2>(at, rest, material.membrane * area, 1, 1));
        terms.push_back(stretch_term<2>(at, rest, material.limit_stiffness * area,
                                        1 - material.strain_limit, 1 + material.strain_limit));
    }
    add_bending(triangles, first, material.bending);
    return first;
}

/// Keeps the length of the discrete mean curvature vector at each inner edge (isometric bending).
/// Sources: Bergou and others, A Quadratic Bending Model for Inextensible Surfaces, 2006; for the
/// rest shape's curvature, Bouaziz and others, Projective Dynamics, 2014.
void model::add_bending(const std::vector<ccd::face>& triangles, vertex_index first,
                        double stiffness) {
    std::map<ccd::edge, std::vector<vertex_index>> opposite;
    for (const ccd::face& f : triangles)
        for (std::size_t i = 0; i < 3; ++i) {
            const vertex_index a = f[i], b = f[(i + 1) % 3];
            opposite[{std::min(a, b), std::max(a, b)}].push_back(f[(i + 2) % 3]);
        }
    for (const auto& [edge, others] : opposite) {
        if (others.size() != 2) continue;
        const std::array<vertex_index, 4> at{first + edge[0], first + edge[1], first + others[0],
                                             first + others[1]};
        std::array<vec3, 4> x;
        for (std::size_t i = 0; i < 4; ++i) x[i] = row(start, at[i]);
        const double c03 = cotangent(x[1] - x[0], x[2] - x[0]),
                     c04 = cotangent(x[1] - x[0], x[3] - x[0]);
        const double c13 = cotangent(x[0] - x[1], x[2] - x[1]),
                     c14 = cotangent(x[0] - x[1], x[3] - x[1]);
        const std::array<double, 4> factors{c13 + c14, c03 + c04, -c03 - c13, -c04 - c14};
        const double area =
            ((x[1] - x[0]).cross(x[2] - x[0]).norm() + (x[1] - x[0]).cross(x[3] - x[0]).norm()) / 2;
        elastic_term term{elastic_term::target::length, 1, 4, at, {}, 3 * stiffness / area, 0, 0};
        vec3 rest = vec3::Zero();
        for (std::size_t i = 0; i < 4; ++i) {
            term.gradients[i][0] = factors[i];
            rest += factors[i] * x[i];
        }
        // For a flat rest shape the curvature is a rounding error without a meaningful direction.
        const double scale = (x[1] - x[0]).norm();
        if (rest.norm() > 1e-9 * scale) term.low = term.high = rest.norm();
        terms.push_back(term);
    }
}

vertex_index model::add_solid(const rows& shape,
                              const std::vector<std::array<vertex_index, 4>>& tetrahedra,
                              const solid_material& material) {
    const vertex_index first = add_obstacle(shape, boundary(tetrahedra));
    for (const auto& t : tetrahedra) {
        Eigen::Matrix3d rest;
        for (int i = 0; i < 3; ++i)
            rest.col(i) = row(shape, t[std::size_t(i) + 1]) - row(shape, t[0]);
        const double volume = std::abs(rest.determinant()) / 6;
        std::array<vertex_index, 4> at = t;
        for (vertex_index& v : at) {
            v += first;
            mass[v] += material.density * volume / 4;
        }
        terms.push_back(stretch_term<3>(at, rest, material.stiffness * volume, 1, 1));
    }
    return first;
}

vertex_index model::add_rod(const rows& points, const rod_material& material) {
    const vertex_index first = append(points);
    const auto count = static_cast<vertex_index>(points.rows());
    for (vertex_index i = 0; i + 1 < count; ++i) {
        edges.push_back({first + i, first + i + 1});
        const double length = (row(points, i + 1) - row(points, i)).norm();
        for (const vertex_index v : {i, i + 1}) mass[first + v] += material.density * length / 2;
        terms.push_back({elastic_term::target::length,
                         1,
                         2,
                         {first + i, first + i + 1},
                         {{{-1}, {1}}},
                         material.stretching / length,
                         length,
                         length});
        if (i == 0) continue;
        // The length of the second difference is the curvature times the squared length.
        const double curvature =
            (row(points, i + 1) - 2 * row(points, i) + row(points, i - 1)).norm();
        terms.push_back({elastic_term::target::length,
                         1,
                         3,
                         {first + i - 1, first + i, first + i + 1},
                         {{{1}, {-2}, {1}}},
                         material.bending / (length * length * length),
                         curvature,
                         curvature});
    }
    return first;
}

ccd::mesh model::surface(const rows& positions) const {
    ccd::mesh mesh{{}, faces, edges};
    mesh.vertices.reserve(vertices());
    for (Eigen::Index v = 0; v < positions.rows(); ++v)
        mesh.vertices.push_back({positions(v, 0), positions(v, 1), positions(v, 2)});
    return mesh;
}

}  // namespace simulation
