#include "examples/simulation/bodies/shapes.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace simulation {

surface_shape grid(int columns, int rows_, const std::function<vec3(double, double)>& place,
                   bool closed) {
    const int across = closed ? columns : columns + 1;
    surface_shape shape{rows(across * (rows_ + 1), 3), {}};
    for (int j = 0; j <= rows_; ++j)
        for (int i = 0; i < across; ++i)
            shape.points.row(j * across + i) =
                place(double(i) / columns, double(j) / rows_).transpose();
    for (int j = 0; j < rows_; ++j)
        for (int i = 0; i < columns; ++i) {
            const auto at = [&](int di, int dj) {
                return vertex_index((j + dj) * across + (i + di) % across);
            };
            const vertex_index a = at(0, 0), b = at(1, 0), c = at(1, 1), d = at(0, 1);
            if ((i + j) % 2 == 0) {
                shape.faces.push_back({a, b, c});
                shape.faces.push_back({a, c, d});
            } else {
                shape.faces.push_back({a, b, d});
                shape.faces.push_back({b, c, d});
            }
        }
    return shape;
}

surface_shape square(int cells, double side, double height) {
    return grid(cells, cells, [=](double u, double v) {
        return vec3((u - 0.5) * side, (v - 0.5) * side, height);
    });
}

surface_shape sphere(int refinements, double radius, const vec3& centre) {
    const double g = std::numbers::phi;
    std::vector<vec3> points{{-1, g, 0}, {1, g, 0}, {-1, -g, 0}, {1, -g, 0},
                             {0, -1, g}, {0, 1, g}, {0, -1, -g}, {0, 1, -g},
                             {g, 0, -1}, {g, 0, 1}, {-g, 0, -1}, {-g, 0, 1}};
    std::vector<ccd::face> faces{{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                 {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                 {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                 {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
    for (int k = 0; k < refinements; ++k) {
        std::map<ccd::edge, vertex_index> middles;
        const auto middle = [&](vertex_index a, vertex_index b) {
            const auto [entry, is_new] = middles.try_emplace(
                {std::min(a, b), std::max(a, b)}, static_cast<vertex_index>(points.size()));
            if (is_new) points.push_back((points[a].normalized() + points[b].normalized()) / 2);
            return entry->second;
        };
        std::vector<ccd::face> finer;
        for (const auto& [a, b, c] : faces) {
            const vertex_index ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
            finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
        }
        faces = finer;
    }
    surface_shape shape{rows(Eigen::Index(points.size()), 3), faces};
    for (std::size_t v = 0; v < points.size(); ++v)
        shape.points.row(Eigen::Index(v)) = (centre + radius * points[v].normalized()).transpose();
    return shape;
}

surface_shape revolved(const std::vector<std::array<double, 2>>& profile, int segments) {
    const int rings = int(profile.size()) - 1;
    return grid(
        segments, rings,
        [&](double u, double v) {
            const auto& [radius, z] = profile[std::size_t(std::lround(v * rings))];
            const double angle = 2 * std::numbers::pi * u;
            return vec3(radius * std::cos(angle), radius * std::sin(angle), z);
        },
        true);
}

surface_shape capsule(int refinements, double radius, const vec3& from, const vec3& to) {
    surface_shape shape = sphere(refinements, radius, vec3::Zero());
    const double length = (to - from).norm();
    const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(vec3::UnitZ(), to - from);
    for (Eigen::Index v = 0; v < shape.points.rows(); ++v) {
        vec3 x = shape.points.row(v).transpose();
        if (x.z() >= 0) x.z() += length;
        shape.points.row(v) = (from + turn * x).transpose();
    }
    return shape;
}

namespace {

/// Adds five tetrahedra. The three bits of a corner's index are its coordinates in the cell.
void add_cell(const std::array<vertex_index, 8>& c, bool mirrored,
              std::vector<std::array<vertex_index, 4>>& tetrahedra) {
    constexpr std::array<std::array<std::size_t, 4>, 5> parts{
        {{0, 1, 2, 4}, {3, 2, 1, 7}, {5, 4, 7, 1}, {6, 4, 2, 7}, {1, 2, 4, 7}}};
    for (const auto& [p, q, r, s] : parts)
        tetrahedra.push_back(mirrored ? std::array{c[p], c[r], c[q], c[s]}
                                      : std::array{c[p], c[q], c[r], c[s]});
}

}  // namespace

solid_shape block(const std::array<int, 3>& cells, const vec3& from, const vec3& to,
                  const std::function<bool(int, int, int)>& keep) {
    std::vector<vec3> points;
    std::map<std::array<int, 3>, vertex_index> number;
    const auto vertex_at = [&](int i, int j, int k) {
        const auto [entry, is_new] =
            number.try_emplace({i, j, k}, static_cast<vertex_index>(points.size()));
        if (is_new)
            points.emplace_back(std::lerp(from.x(), to.x(), double(i) / cells[0]),
                                std::lerp(from.y(), to.y(), double(j) / cells[1]),
                                std::lerp(from.z(), to.z(), double(k) / cells[2]));
        return entry->second;
    };
    solid_shape shape;
    for (int k = 0; k < cells[2]; ++k)
        for (int j = 0; j < cells[1]; ++j)
            for (int i = 0; i < cells[0]; ++i) {
                if (keep && !keep(i, j, k)) continue;
                const bool mirrored = (i + j + k) % 2 != 0;
                std::array<vertex_index, 8> corners;
                for (int bits = 0; bits < 8; ++bits) {
                    const int x = bits & 1, y = bits >> 1 & 1, z = bits >> 2;
                    corners[std::size_t(bits)] =
                        vertex_at(i + (mirrored ? 1 - x : x), j + y, k + z);
                }
                add_cell(corners, mirrored, shape.tetrahedra);
            }
    shape.points.resize(Eigen::Index(points.size()), 3);
    for (std::size_t v = 0; v < points.size(); ++v)
        shape.points.row(Eigen::Index(v)) = points[v].transpose();
    return shape;
}

surface_shape spike(int sides, double radius, const vec3& base, const vec3& apex) {
    surface_shape shape{rows(sides + 2, 3), {}};
    const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(vec3::UnitZ(), apex - base);
    const auto last = static_cast<vertex_index>(sides);
    for (vertex_index i = 0; i < last; ++i) {
        const double angle = 2 * std::numbers::pi * i / sides;
        shape.points.row(i) =
            (base + turn * vec3(radius * std::cos(angle), radius * std::sin(angle), 0)).transpose();
        const vertex_index next = (i + 1) % last;
        shape.faces.push_back({i, next, last});
        shape.faces.push_back({next, i, last + 1});
    }
    shape.points.row(sides) = apex.transpose();
    shape.points.row(sides + 1) = base.transpose();
    return shape;
}

rows line(int edges, const vec3& from, const vec3& to) {
    rows points(edges + 1, 3);
    for (int i = 0; i <= edges; ++i)
        points.row(i) = (from + double(i) / edges * (to - from)).transpose();
    return points;
}

void translate(rows& points, const vec3& by) {
    points.rowwise() += by.transpose();
}

}  // namespace simulation
