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
    std::vector<vec3> points{{-1, g, 0}, {1, g, 0}, {-1, -g, 0}, {1, -g, 0}, {0, -1, g}, {0, 1, g},
                             {0, -1, -g}, {0, 1, -g}, {g, 0, -1}, {g, 0, 1}, {-g, 0, -1}, {-g, 0, 1}};
    std::vector<ccd::face> faces{
        {0, 11, 5}, {0, 5, 1}, {0, 1, 7}, {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
        {11, 10, 2}, {10, 7, 6}, {7, 1, 8}, {3, 9, 4}, {3, 4, 2}, {3, 2, 6}, {3, 6, 8},
        {3, 8, 9}, {4, 9, 5}, {2, 4, 11}, {6, 2, 10}, {8, 6, 7}, {9, 8, 1}};
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
        shape.points.row(Eigen::Index(v)) =
            (centre + radius * points[v].normalized()).transpose();
    return shape;
}

surface_shape revolved(const std::vector<std::array<double, 2>>& profile, int segments) {
    const int rings = int(profile.size()) - 1;
    return grid(segments, rings, [&](double u, double v) {
        const auto& [radius, z] = profile[std::size_t(std::lround(v * rings))];
        const double angle = 2 * std::numbers::pi * u;
        return vec3(radius * std::cos(angle), radius * std::sin(angle), z);
    }, true);
}

solid_shape block(const std::array<int, 3>& cells, const vec3& from, const vec3& to) {
    const auto [nx, ny, nz] = cells;
    solid_shape shape{rows((nx + 1) * (ny + 1) * (nz + 1), 3), {}};
    const auto index = [nx, ny](int i, int j, int k) {
        return vertex_index((k * (ny + 1) + j) * (nx + 1) + i);
    };
    for (int k = 0; k <= nz; ++k)
        for (int j = 0; j <= ny; ++j)
            for (int i = 0; i <= nx; ++i)
                shape.points.row(index(i, j, k))
                    << std::lerp(from.x(), to.x(), double(i) / nx),
                    std::lerp(from.y(), to.y(), double(j) / ny),
                    std::lerp(from.z(), to.z(), double(k) / nz);
    for (int k = 0; k < nz; ++k)
        for (int j = 0; j < ny; ++j)
            for (int i = 0; i < nx; ++i) {
                // Corners by their three bits; mirrored in every other cell.
                const int mirror = (i + j + k) % 2;
                const auto corner = [&](int x, int y, int z) {
                    return index(i + (mirror ? 1 - x : x), j + y, k + z);
                };
                const auto add = [&](vertex_index a, vertex_index b, vertex_index c, vertex_index d) {
                    shape.tetrahedra.push_back(mirror ? std::array{a, c, b, d}
                                                      : std::array{a, b, c, d});
                };
                const auto c000 = corner(0, 0, 0), c100 = corner(1, 0, 0), c010 = corner(0, 1, 0),
                           c110 = corner(1, 1, 0), c001 = corner(0, 0, 1), c101 = corner(1, 0, 1),
                           c011 = corner(0, 1, 1), c111 = corner(1, 1, 1);
                add(c000, c100, c010, c001);
                add(c110, c010, c100, c111);
                add(c101, c001, c111, c100);
                add(c011, c001, c010, c111);
                add(c100, c010, c001, c111);
            }
    return shape;
}

void translate(rows& points, const vec3& by) { points.rowwise() += by.transpose(); }

}  // namespace simulation
