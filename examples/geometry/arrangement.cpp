// Arrangements of segments (arrangement.hpp), checked by rationals.
#include "examples/geometry/arrangement.hpp"

#include <array>
#include <boost/multiprecision/cpp_int.hpp>
#include <chrono>
#include <cstdio>
#include <random>
#include <set>
#include <vector>

namespace {

using namespace arrangements;
// ---- The check: all pairs, in rationals ----

using rational = boost::multiprecision::number<boost::multiprecision::cpp_rational_backend,
                                               boost::multiprecision::et_off>;
using exact_point = std::array<rational, 2>;

exact_point exact(const point& p) {
    return {rational(p[0]), rational(p[1])};
}
rational area(const exact_point& a, const exact_point& b, const exact_point& c) {
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}
bool is_on(const exact_point& p, const exact_point& a, const exact_point& b) {
    return area(a, b, p) == 0 && !(p < a) && !(b < p);  // a < b, lexicographically
}

bool is_right(const arrangement& found, const std::vector<segment>& segments) {
    std::set<exact_point> vertices;
    bool right = true;
    for (std::size_t i = 0; i < segments.size(); ++i) {
        const exact_point a = exact(segments[i].from), b = exact(segments[i].to);
        std::set<exact_point> on{a, b};
        for (const segment& other : segments) {
            const exact_point c = exact(other.from), d = exact(other.to);
            for (const exact_point& p : {c, d})
                if (is_on(p, a, b)) on.insert(p);
            const rational at_c = area(a, b, c), at_d = area(a, b, d);
            if (at_c == at_d) continue;
            const rational t = at_c / (at_c - at_d);
            const exact_point p{c[0] + t * (d[0] - c[0]), c[1] + t * (d[1] - c[1])};
            if (t >= 0 && t <= 1 && is_on(p, a, b)) on.insert(p);
        }
        right = right && found.vertices_on[i] == on.size();
        vertices.merge(on);
    }
    return right && found.vertices == vertices.size();
}

segment segment_of(const point& a, const point& b) {
    return a < b ? segment{a, b} : segment{b, a};
}
template <class Coordinate>
std::vector<segment> random_segments(std::size_t count, const Coordinate& coordinate) {
    std::vector<segment> segments;
    while (segments.size() < count) {
        const point a{coordinate(), coordinate()}, b{coordinate(), coordinate()};
        if (a != b) segments.push_back(segment_of(a, b));
    }
    return segments;
}

bool test(const char* name, const std::vector<segment>& segments) {
    const auto start = std::chrono::steady_clock::now();
    const arrangement found = sweep<true>(segments).run();
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
    const bool right = is_right(found, segments);
    std::printf("%s: %zu segments, %zu vertices, %zu edges, %.3f s, %s\n", name, segments.size(),
                found.vertices, found.edges(), time.count(), right ? "right" : "WRONG");
    return right;
}

}  // namespace

int main() {
    std::mt19937_64 random(1);
    const auto uniform = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
    bool right = test("random", random_segments(150, uniform));
    // Many overlaps, vertical segments and common points.
    right &= test("grid", random_segments(120, [&] { return static_cast<double>(random() % 6); }));
    // Nearly through one point, and nearly parallel.
    std::vector<segment> star;
    for (int i = 0; i < 60; ++i) {
        const double x = uniform(), y = uniform();
        star.push_back(segment_of({0.1 - x, 0.3 - y}, {0.1 + x, 0.3 + y}));
        star.push_back(segment_of({-1, 0.3 + i * 0x1p-54}, {1, 0.3 - i * 0x1p-54}));
    }
    right &= test("star", star);
    return right ? 0 : 1;
}
