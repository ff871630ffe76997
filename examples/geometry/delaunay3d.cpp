// Triangulations of a grid and of points of one sphere (delaunay3d.hpp), checked by integers.
#include "examples/geometry/delaunay3d.hpp"

#include <algorithm>
#include <boost/multiprecision/cpp_int.hpp>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <random>
#include <utility>

namespace {

using namespace delaunay3d;
using integer = boost::multiprecision::int256_t;

/// The determinant of the rows p − o, or (p − o, |p − o|²), by the first row.
integer determinant(const std::vector<std::vector<integer>>& m) {
    if (m.size() == 1) return m[0][0];
    integer sum = 0;
    for (std::size_t k = 0; k < m.size(); ++k) {
        std::vector<std::vector<integer>> rest(m.begin() + 1, m.end());
        for (auto& row : rest) row.erase(row.begin() + static_cast<std::ptrdiff_t>(k));
        sum += (k % 2 == 0 ? m[0][k] : -m[0][k]) * determinant(rest);
    }
    return sum;
}

/// 0 for a Delaunay triangulation of points with whole coordinates. If all volumes are
/// positive, faces match, and the border is a locally convex sphere, each point inside is covered
/// once.
std::size_t count_flaws(const triangulation<true>& result, const std::vector<point>& points) {
    const auto of = [&](const auto& v, std::size_t count) {
        std::vector<std::vector<integer>> rows(count);
        for (std::size_t i = 0; i < count; ++i) {
            integer squared = 0;
            for (std::size_t k = 0; k < 3; ++k) {
                rows[i].emplace_back(points[v[i]][k] - points[v[count]][k]);
                squared += rows[i][k] * rows[i][k];
            }
            if (count == 4) rows[i].push_back(squared);
        }
        return determinant(rows);
    };
    std::size_t flaws = 0, faces = 0;
    std::vector<bool> used(points.size() + 1), on_hull(points.size() + 1);
    for (std::size_t t = 0; t < result.simplices.size(); ++t) {
        const simplex& s = result.simplices[t];
        if (s.vertex[0] == none) continue;
        const std::size_t ghost = s.corner_of(result.infinity);
        faces += ghost < 4;
        flaws += ghost == 4 && of(s.vertex, 3) <= 0;
        for (std::size_t i = 0; i < 4; ++i) {
            used[s.vertex[i]] = true;
            if (ghost < 4) on_hull[s.vertex[i]] = true;
            const simplex& other = result.simplices[s.neighbour[i]];
            const auto j = static_cast<std::size_t>(std::ranges::find(other.neighbour, t) -
                                                    other.neighbour.begin());
            auto mine = s.vertex, its = other.vertex;
            const std::size_t beyond = j < 4 ? std::exchange(its[j], mine[i]) : none;
            if (j == 4 || !std::ranges::is_permutation(mine, its)) {
                ++flaws;
            } else if (ghost == 4 && beyond != result.infinity) {
                const auto& v = s.vertex;
                flaws += of(std::array{v[0], v[1], v[2], v[3], beyond}, 4) > 0;
            } else if (ghost < 4 && i != ghost) {  // two faces of the hull
                auto v = s.vertex;
                v[ghost] = beyond;
                flaws += of(v, 3) > 0;
            }
        }
    }
    const auto hull = std::ranges::count(on_hull, true) - 1;  // without infinity
    return flaws + static_cast<std::size_t>(std::ranges::count(used, false)) +
           (static_cast<std::size_t>(2 * hull - 4) - faces);
}

std::vector<point> grid(int n) {
    std::vector<point> points;
    for (int i = 0; i < n * n * n; ++i)
        points.push_back({1.0 * (i % n), 1.0 * (i / n % n), 1.0 * (i / n / n)});
    return points;
}
/// All points with whole coordinates and this squared radius.
std::vector<point> sphere(int squared) {
    std::vector<point> points;
    const int most = static_cast<int>(std::sqrt(squared)) + 1;
    for (int x = -most; x <= most; ++x)
        for (int y = -most; y <= most; ++y) {
            const double rest = squared - x * x - y * y, z = std::round(std::sqrt(rest));
            if (z * z != rest) continue;  // also if rest < 0
            points.push_back({double(x), double(y), z});
            if (z > 0) points.push_back({double(x), double(y), -z});
        }
    return points;
}

}  // namespace

int main() {
    std::mt19937_64 random(1);
    bool valid = true;
    for (auto points : {grid(20), sphere(1'185'665)}) {
        std::ranges::shuffle(points, random);
        const auto start = std::chrono::steady_clock::now();
        const triangulation<true> result(points);
        const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
        const std::size_t flaws = count_flaws(result, points);
        std::printf("%zu points on common spheres: %.2f s, %zu flaws\n", points.size(),
                    time.count(), flaws);
        valid = valid && flaws == 0;
    }
    return valid ? 0 : 1;
}
