// Convex hulls in space of nearly degenerate points, by one algorithm with errbound's orientation
// and with plain doubles. Checked by integers: the former must all be valid, the latter all wrong.
#include <algorithm>
#include <array>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <errbound/predicates.hpp>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "examples/geometry/signs.hpp"

namespace {

using errbound::sign_type;
using point = std::array<double, 3>;

using face = std::array<std::size_t, 3>;
using edge = std::array<std::size_t, 2>;

/// Returns all edges of faces, sorted. On a closed surface each has one opposite edge.
std::vector<edge> sorted_edges(const std::vector<face>& faces) {
    std::vector<edge> edges;
    for (const auto& [a, b, c] : faces) edges.insert(edges.end(), {{a, b}, {b, c}, {c, a}});
    std::ranges::sort(edges);
    return edges;
}

/// Incremental algorithm: faces that see a point are replaced by faces that join it to their
/// border. Empty if all points are coplanar. Throws std::runtime_error if signs contradict each
/// other. Cost: points times faces.
template <bool Exact>
std::vector<face> convex_hull(const std::vector<point>& points) {
    const auto orient = [&](const face& f, std::size_t p) {
        return sign_by<Exact>(errbound::orient3d)(points[f[0]], points[f[1]], points[f[2]],
                                                  points[p]);
    };
    std::size_t c = 2, d = 3;
    while (d < points.size() && orient({0, 1, c}, d) == sign_type::zero)
        if (++c == d) c = 2, ++d;
    if (d >= points.size()) return {};
    // The last point of a tetrahedron is inside if it is below the first three.
    const bool below = orient({0, 1, c}, d) == sign_type::positive;
    const std::size_t a = below ? 0 : 1, b = 1 - a;
    std::vector<face> faces{{a, b, c}, {b, a, d}, {c, b, d}, {a, c, d}};

    for (std::size_t p = 2; p < points.size(); ++p) {
        const auto rest = std::stable_partition(faces.begin(), faces.end(), [&](const face& f) {
            return orient(f, p) != sign_type::negative;
        });
        const std::vector<edge> seen = sorted_edges({rest, faces.end()});
        faces.erase(rest, faces.end());
        for (const auto& [from, to] : seen)
            if (!std::ranges::binary_search(seen, edge{to, from})) faces.push_back({from, to, p});
        if (faces.size() > 2 * points.size()) throw std::runtime_error("too many faces for a hull");
    }
    return faces;
}

// Coordinates of the points below are multiples of 2^-70, less than 2^10.

using integer = boost::multiprecision::int512_t;
using vector = std::array<integer, 3>;

vector exactly(const point& p) {
    vector v;
    for (std::size_t k = 0; k < 3; ++k) {
        const double x = std::ldexp(p[k], 70);
        if (x != std::trunc(x) || std::abs(x) >= 0x1p80)
            throw std::logic_error("a coordinate that the check is not made for");
        v[k] = integer(x);
    }
    return v;
}
vector operator-(const vector& a, const vector& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
vector cross(const vector& a, const vector& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
integer dot(const vector& a, const vector& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Returns the flaws of a hull; empty if it is valid. If all points are on or behind the planes of
/// all faces, these are parts of the hull's boundary. If they are closed and face outwards, they
/// cover it everywhere equally often. The last check is that some point is covered once.
std::string flaws(const std::vector<point>& points, const std::vector<face>& faces) {
    if (faces.empty()) return "no faces";
    std::vector<vector> exact;
    for (const point& p : points) exact.push_back(exactly(p));

    const std::vector<edge> edges = sorted_edges(faces);
    std::size_t unmatched = 0, flat = 0, outside = 0, layers = 0;
    const auto count = [&](const edge& e) {
        const auto [first, last] = std::equal_range(edges.begin(), edges.end(), e);
        return last - first;
    };
    for (const auto& [from, to] : edges)
        unmatched += count({from, to}) != 1 || count({to, from}) != 1;
    const auto sum = [&](const face& f, std::size_t k) -> integer {
        return exact[f[0]][k] + exact[f[1]][k] + exact[f[2]][k];
    };
    const vector centre{sum(faces[0], 0), sum(faces[0], 1), sum(faces[0], 2)};  // three times that
    for (const auto& [a, b, c] : faces) {
        const vector normal = cross(exact[b] - exact[a], exact[c] - exact[a]);
        const integer height = dot(normal, exact[a]);
        flat += dot(normal, normal) == 0;
        for (const vector& p : exact) outside += dot(normal, p) > height;
        bool inside = dot(normal, centre) == 3 * height;
        for (const auto& [from, to] : {edge{a, b}, edge{b, c}, edge{c, a}}) {
            const vector& start = exact[from];
            const vector thrice{3 * start[0], 3 * start[1], 3 * start[2]};
            inside = inside && dot(normal, cross(exact[to] - start, centre - thrice)) >= 0;
        }
        layers += inside;
    }
    std::string found;
    const auto add = [&](const char* what, std::size_t count) {
        if (count == 0) return;
        found += (found.empty() ? "" : ", ") + std::to_string(count) + what;
    };
    add(" edges without one twin", unmatched);
    add(" flat faces", flat);
    add(" times a point is outside of a face", outside);
    if (layers != 1) found += (found.empty() ? "" : ", ") + std::to_string(layers) + " layers";
    return found;
}

using generator = std::mt19937_64;

double rounded(double x) {
    return std::ldexp(std::rint(std::ldexp(x, 60)), -60);
}
point turned(const point& p) {
    const double x = std::cos(0.3) * p[0] - std::sin(0.3) * p[1],
                 y = std::sin(0.3) * p[0] + std::cos(0.3) * p[1];
    return {rounded(x), rounded(std::cos(0.7) * y - std::sin(0.7) * p[2]),
            rounded(std::sin(0.7) * y + std::cos(0.7) * p[2])};
}

/// A grid on the surface of a cube, with points moved by `move`.
template <class Move>
std::vector<point> cube(const Move& move) {
    std::vector<point> points;
    for (int i = 0; i <= 20; ++i)
        for (int j = 0; j <= 20; ++j)
            for (const double side : {-0.5, 0.5}) {
                const double u = i / 20.0 - 0.5, v = j / 20.0 - 0.5;
                for (const point& p : {point{side, u, v}, point{u, side, v}, point{u, v, side}})
                    points.push_back(move(p));
            }
    return points;
}
std::vector<point> turned_cube(generator&) {
    return cube(turned);
}
std::vector<point> jittered_cube(generator& random) {
    return cube([&](point p) {
        for (double& x : p) x = rounded(x) + (static_cast<double>(random() % 5) - 2) * 0x1p-53;
        return p;
    });
}
std::vector<point> cylinder(generator&) {
    std::vector<point> points;
    for (int height = 0; height < 20; ++height)
        for (int i = 0; i < 100; ++i) {
            const double angle = 6.28318530717958648 * i / 100;
            points.push_back(turned({std::cos(angle), std::sin(angle), height / 10.0}));
        }
    return points;
}
/// Points on a plane, a cluster of adjacent doubles around one of it, and two more points.
std::vector<point> plane_and_cluster(generator& random) {
    std::vector<point> points{{0, 0, 1}, {1, 0, 0}};
    for (int i = 0; i < 10; ++i)
        for (int j = 0; j < 10; ++j)
            for (int k = 0; k < 10; ++k)
                points.push_back({0.5 + i * 0x1p-53, 0.5 + j * 0x1p-53, 0.5 + k * 0x1p-53});
    for (int i = 0; i < 1000; ++i) {
        const double x = double(random() % 400), y = double(random() % 400);
        points.push_back({x, y, y});
    }
    return points;
}

}  // namespace

int main() {
    const bool as_expected =
        compare_families<3>({{"turned cube", turned_cube},
                             {"jittered cube", jittered_cube},
                             {"cylinder", cylinder},
                             {"plane and cluster", plane_and_cluster}},
                            "faces", []<bool Exact>(const std::vector<point>& points) {
                                const std::vector<face> faces = convex_hull<Exact>(points);
                                return std::pair(faces.size(), flaws(points, faces));
                            });
    return as_expected ? 0 : 1;
}
