// Boolean operations on polygons (polygons.hpp), checked by areas and by points, in rationals.
#include "examples/geometry/polygons.hpp"

#include <algorithm>
#include <array>
#include <boost/multiprecision/cpp_int.hpp>
#include <cstddef>
#include <cstdio>
#include <random>
#include <vector>

namespace {

using namespace polygons;
using rational = boost::multiprecision::number<boost::multiprecision::cpp_rational_backend,
                                               boost::multiprecision::et_off>;
using exact_point = std::array<rational, 2>;

/// Twice the area.
rational area(const std::vector<std::vector<exact_point>>& loops) {
    rational sum = 0;
    for (const auto& loop : loops)
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const exact_point &p = loop[i], &q = loop[(i + 1) % loop.size()];
            sum += p[0] * q[1] - p[1] * q[0];
        }
    return sum;
}
/// How many times the borders go around p, which is on none.
int winding(const std::vector<std::vector<exact_point>>& loops, const exact_point& p) {
    int sum = 0;
    for (const auto& loop : loops)
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const exact_point &a = loop[i], &b = loop[(i + 1) % loop.size()];
            if ((a[1] > p[1]) == (b[1] > p[1])) continue;
            const rational s = (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
            if ((s > 0) == (b[1] > a[1])) sum += b[1] > a[1] ? 1 : -1;
        }
    return sum;
}

/// A star-shaped polygon of points of a small grid.
std::vector<point> random_polygon(std::mt19937_64& random, const point& center, int size) {
    const auto compare = [&](const point& p, const point& q) {
        return errbound::compare_directions(center, p, center, q);
    };
    for (;;) {
        std::vector<point> polygon;
        for (int i = 0; i < size; ++i) {
            const point p{center[0] + double(random() % 9) - 4,
                          center[1] + double(random() % 9) - 4};
            if (p != center) polygon.push_back(p);
        }
        std::ranges::sort(polygon, [&](const point& p, const point& q) {
            return compare(p, q) == sign_type::negative;
        });
        const auto end = std::unique(
            polygon.begin(), polygon.end(),
            [&](const point& p, const point& q) { return compare(p, q) == sign_type::zero; });
        polygon.erase(end, polygon.end());
        bool around = polygon.size() > 2;
        for (std::size_t i = 0; i < polygon.size(); ++i)
            around = around && errbound::orient2d(polygon[i], polygon[(i + 1) % polygon.size()],
                                                  center) == sign_type::positive;
        if (around) return polygon;
    }
}

}  // namespace

int main() {
    std::mt19937_64 random(1);
    int wrong = 0, count = 0;
    for (; count < 300; ++count) {
        const auto a = random_polygon(random, {0, 0}, 12);
        const auto b = random_polygon(random, {double(random() % 3), double(random() % 2)}, 12);
        const overlay<true, rational> both(a, b);
        const auto common = both.border(operation::intersection),
                   either = both.border(operation::union_),
                   rest = both.border(operation::difference);
        const auto alone =
            overlay<true, rational>(a, {{90, 0}, {91, 0}, {90, 1}}).border(operation::difference);
        const auto other =
            overlay<true, rational>(b, {{90, 0}, {91, 0}, {90, 1}}).border(operation::difference);
        bool right = area(common) + area(either) == area(alone) + area(other) &&
                     area(common) + area(rest) == area(alone);
        for (int i = 0; i < 20; ++i) {
            const auto draw = [&] { return rational(std::size_t(random() % 997), 83) - 5; };
            const exact_point p{draw() + rational(1, 1009), draw() + rational(1, 1013)};
            const int in_a = winding(alone, p), in_b = winding(other, p);
            right = right && winding(common, p) == in_a * in_b &&
                    winding(either, p) == std::max(in_a, in_b) &&
                    winding(rest, p) == in_a * (1 - in_b);
        }
        wrong += !right;
    }
    std::printf("%d pairs of polygons, %d wrong\n", count, wrong);
    return wrong == 0 ? 0 : 1;
}
