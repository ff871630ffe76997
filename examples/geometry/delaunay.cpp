// Delaunay triangulations of nearly degenerate points, by one algorithm with errbound's predicates
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
using point = std::array<double, 2>;

constexpr std::array<std::size_t, 3> after{1, 2, 0}, before{2, 0, 1};

/// Neighbour i is opposite to vertex i. Beyond each edge of the hull is a triangle with a vertex at
/// infinity, so that all edges have two sides.
struct triangle {
    std::array<std::size_t, 3> vertex, neighbour;

    std::size_t corner_of(std::size_t v) const {  // 3 if v is no corner
        return static_cast<std::size_t>(std::ranges::find(vertex, v) - vertex.begin());
    }
    /// Returns the corner opposite to the edge from a to b; 3 if there is none.
    std::size_t across(std::size_t a, std::size_t b) const {
        const std::size_t i = corner_of(a);
        return i < 3 && vertex[after[i]] == b ? before[i] : 3;
    }
};

/// Incremental algorithm (Bowyer 1981, Watson 1981). Triangles whose circles contain a point are
/// replaced by triangles that join it to their border.
template <bool Exact>
class triangulation {
  public:
    /// Precondition: distinct points. Throws std::runtime_error if signs contradict each other.
    explicit triangulation(const std::vector<point>& points)
        : infinity(points.size()), points_(points), first_(points.size() + 1, none) {
        std::size_t c = 2;
        while (c < points.size() && orient(0, 1, c) == sign_type::zero) ++c;
        if (c == points.size()) throw std::runtime_error("all points are on one line");
        std::size_t a = 0, b = 1;
        if (orient(a, b, c) == sign_type::negative) std::swap(a, b);
        triangles = {{{a, b, c}, {2, 3, 1}},
                     {{b, a, infinity}, {3, 2, 0}},
                     {{c, b, infinity}, {1, 3, 0}},
                     {{a, c, infinity}, {2, 1, 0}}};
        inside_of_.assign(4, none);
        for (std::size_t p = 2; p < points.size(); ++p)
            if (p != c) insert(p);
    }

    const std::size_t infinity;
    std::vector<triangle> triangles;

  private:
    static constexpr std::size_t none = ~std::size_t{0};

    sign_type orient(std::size_t a, std::size_t b, std::size_t c) const {
        return sign_by<Exact>(errbound::orient2d)(points_[a], points_[b], points_[c]);
    }

    /// Returns the triangle that contains p, or one at infinity with p beyond its edge.
    std::size_t locate(std::size_t p) const {
        std::size_t at = triangles.size() - 1;
        const std::size_t ghost = triangles[at].corner_of(infinity);
        if (ghost < 3) at = triangles[at].neighbour[ghost];
        // Walks through a Delaunay triangulation visit no triangle twice (Edelsbrunner 1990).
        for (std::size_t steps = 0; steps <= triangles.size(); ++steps) {
            const triangle& t = triangles[at];
            if (t.corner_of(infinity) < 3) return at;
            std::size_t i = 0;
            while (i < 3 &&
                   orient(t.vertex[after[i]], t.vertex[before[i]], p) != sign_type::negative)
                ++i;
            if (i == 3) return at;
            at = t.neighbour[i];
        }
        throw std::runtime_error("a walk does not end");
    }

    /// True if p is inside the triangle's circle; at infinity, a half-plane with the open edge.
    bool encloses(const triangle& t, std::size_t p) const {
        const auto& v = t.vertex;
        const std::size_t ghost = t.corner_of(infinity);
        if (ghost == 3)
            return sign_by<Exact>(errbound::incircle)(points_[v[0]], points_[v[1]], points_[v[2]],
                                                      points_[p]) == sign_type::positive;
        const sign_type side = orient(v[after[ghost]], v[before[ghost]], p);
        if (side != sign_type::zero) return side == sign_type::positive;
        const triangle& inner = triangles[t.neighbour[ghost]];
        return inner.corner_of(infinity) == 3 && encloses(inner, p);
    }

    void insert(std::size_t p) {
        std::vector<std::size_t> cavity{locate(p)};
        std::vector<triangle> fan;  // on the edges of the cavity's border
        inside_of_[cavity[0]] = p;
        for (std::size_t k = 0; k < cavity.size(); ++k) {
            const triangle& t = triangles[cavity[k]];
            for (std::size_t i = 0; i < 3; ++i) {
                const std::size_t other = t.neighbour[i];
                if (inside_of_[other] == p) continue;
                if (encloses(triangles[other], p)) {
                    inside_of_[other] = p;
                    cavity.push_back(other);
                } else {
                    fan.push_back({{t.vertex[after[i]], t.vertex[before[i]], p}, {0, 0, other}});
                }
            }
        }
        // A border that is one cycle through all vertices has two edges more than triangles inside.
        if (fan.size() != cavity.size() + 2) throw std::runtime_error("a cavity has holes");
        for (; cavity.size() < fan.size(); inside_of_.push_back(none)) {
            cavity.push_back(triangles.size());
            triangles.emplace_back();
        }
        for (std::size_t i = 0; i < fan.size(); ++i) {
            const auto [a, b, unused] = fan[i].vertex;
            triangle& other = triangles[fan[i].neighbour[2]];
            other.neighbour[other.across(b, a)] = cavity[i];
            if (first_[a] != none) throw std::runtime_error("a cavity's border meets itself");
            first_[a] = i;
        }
        for (std::size_t i = 0; i < fan.size(); ++i) {
            const std::size_t following = first_[fan[i].vertex[1]];
            if (following == none) throw std::runtime_error("a cavity's border is not closed");
            fan[i].neighbour[0] = cavity[following];
            fan[following].neighbour[1] = cavity[i];
        }
        for (std::size_t i = 0; i < fan.size(); ++i) {
            first_[fan[i].vertex[0]] = none;
            triangles[cavity[i]] = fan[i];
        }
    }

    const std::vector<point>& points_;
    std::vector<std::size_t> inside_of_;  ///< by triangle: the last point found inside its circle
    std::vector<std::size_t> first_;      ///< by vertex, while a cavity is filled
};

using integer = boost::multiprecision::cpp_int;

std::vector<std::array<integer, 2>> as_integers(const std::vector<point>& points) {
    int unit = 0;
    for (const point& p : points)
        for (const double x : p)
            if (x != 0) unit = std::min(unit, std::ilogb(x) - 52);
    std::vector<std::array<integer, 2>> exact;
    for (const point& p : points)
        exact.push_back({integer(std::ldexp(p[0], -unit)), integer(std::ldexp(p[1], -unit))});
    return exact;
}

class examination {
  public:
    examination(const std::vector<point>& points, const std::vector<triangle>& triangles)
        : triangles_(triangles),
          exact_(as_integers(points)),
          infinity_(points.size()),
          previous_(points.size(), points.size()) {
        for (std::size_t k = 0; k < triangles.size(); ++k) see_triangle(k);
        see_hull();
    }

    /// Returns the flaws; empty for a Delaunay triangulation of the points (four points on a circle
    /// have two). Each point inside is covered once if all triangles turn left, edges match and the
    /// border runs once around a convex polygon. Then Euler's formula counts the vertices.
    std::string flaws() const {
        std::string found;
        const auto add = [&](const char* what, std::size_t count) {
            if (count == 0) return;
            found += (found.empty() ? "" : ", ") + std::to_string(count) + what;
        };
        add(" triangles are not counterclockwise", clockwise_);
        add(" sides do not match", unmatched_);
        add(" right turns of the hull", bends_);
        if (starts_ != 1) add(" times around the hull", starts_);
        const std::size_t used = (triangles_.size() + 2) / 2;
        add(" points are missing", used < infinity_ ? infinity_ - used : used - infinity_);
        add(" edges (seen from both sides) are not Delaunay", not_delaunay_);
        return found;
    }

  private:
    integer area(std::size_t a, std::size_t b, std::size_t c) const {
        const auto &p = exact_[a], &q = exact_[b], &r = exact_[c];
        return (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
    }
    /// Positive if d is inside the circle of t, which turns left.
    integer lifted(const triangle& t, std::size_t d) const {
        integer sum = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            const auto& p = exact_[t.vertex[i]];
            const integer x = p[0] - exact_[d][0], y = p[1] - exact_[d][1];
            sum += (x * x + y * y) * area(d, t.vertex[after[i]], t.vertex[before[i]]);
        }
        return sum;
    }

    void see_triangle(std::size_t k) {
        const triangle& t = triangles_[k];
        const std::size_t ghost = t.corner_of(infinity_);
        inner_ += ghost == 3;
        if (ghost == 3)
            clockwise_ += area(t.vertex[0], t.vertex[1], t.vertex[2]) <= 0;
        else
            previous_[t.vertex[after[ghost]]] = t.vertex[before[ghost]];
        for (std::size_t i = 0; i < 3; ++i) {
            const triangle& other = triangles_[t.neighbour[i]];
            const std::size_t j = other.across(t.vertex[before[i]], t.vertex[after[i]]);
            if (j == 3 || other.neighbour[j] != k)
                ++unmatched_;
            else if (ghost == 3 && other.vertex[j] != infinity_)
                not_delaunay_ += lifted(t, other.vertex[j]) > 0;
        }
    }

    /// The hull must be closed, have no right turn, and run around once: have one lowest vertex.
    void see_hull() {
        const std::size_t border = triangles_.size() - inner_;
        std::vector<std::size_t> hull;
        std::size_t v = 0;
        while (v < infinity_ && previous_[v] == infinity_) ++v;
        for (; v < infinity_ && hull.size() <= border; v = previous_[v]) {
            hull.push_back(v);
            if (previous_[v] == hull[0]) break;
        }
        if (hull.size() != border) ++unmatched_;
        for (std::size_t i = 0; i < hull.size(); ++i) {
            const std::size_t a = hull[i], b = hull[(i + 1) % hull.size()],
                              c = hull[(i + 2) % hull.size()];
            bends_ += area(c, b, a) < 0;
            starts_ += exact_[b] < exact_[a] && exact_[b] < exact_[c];
        }
    }

    const std::vector<triangle>& triangles_;
    std::vector<std::array<integer, 2>> exact_;
    std::size_t infinity_;  ///< the vertex of ghosts, one past the points
    std::vector<std::size_t> previous_;
    std::size_t unmatched_ = 0, clockwise_ = 0, not_delaunay_ = 0, inner_ = 0, bends_ = 0,
                starts_ = 0;
};

using generator = std::mt19937_64;
double uniform(generator& random) {
    return static_cast<double>(random() >> 11) * 0x1p-53;
}
double jittered(generator& random, double x) {
    return x + (static_cast<double>(random() % 5) - 2) * 0x1p-52;
}

std::vector<point> turned_grid(generator&) {
    std::vector<point> points;
    for (int i = 0; i < 50; ++i)
        for (int j = 0; j < 50; ++j)
            points.push_back({(std::cos(0.3) * i - std::sin(0.3) * j) / 50,
                              (std::sin(0.3) * i + std::cos(0.3) * j) / 50});
    return points;
}
std::vector<point> jittered_grid(generator& random) {
    std::vector<point> points;
    for (int i = 0; i < 50; ++i)
        for (int j = 0; j < 50; ++j)
            points.push_back({jittered(random, 1 + i / 50.0), jittered(random, 1 + j / 50.0)});
    return points;
}
std::vector<point> circles(generator& random) {
    std::vector<point> points;
    for (int circle = 0; circle < 3; ++circle) {
        const double x = uniform(random), y = uniform(random), radius = uniform(random) / 4;
        for (int i = 0; i < 1000; ++i) {
            const double angle = 6.28318530717958648 * i / 1000;
            points.push_back({x + radius * std::cos(angle), y + radius * std::sin(angle)});
        }
    }
    return points;
}
/// Points on a line, and a cluster of adjacent doubles around another point of it (Kettner,
/// Mehlhorn, Pion, Schirra, Yap 2008).
std::vector<point> line_and_cluster(generator&) {
    std::vector<point> points;
    for (int i = 0; i < 40; ++i)
        for (int j = 0; j < 40; ++j) points.push_back({0.5 + i * 0x1p-53, 0.5 + j * 0x1p-53});
    for (int i = 12; i < 412; ++i) points.push_back({double(i), double(i)});
    return points;
}

}  // namespace

int main() {
    const bool as_expected =
        compare_families<2>({{"turned grid", turned_grid},
                             {"jittered grid", jittered_grid},
                             {"circles", circles},
                             {"line and cluster", line_and_cluster}},
                            "triangles", []<bool Exact>(const std::vector<point>& points) {
                                const triangulation<Exact> result(points);
                                return std::pair(result.triangles.size(),
                                                 examination(points, result.triangles).flaws());
                            });
    return as_expected ? 0 : 1;
}
