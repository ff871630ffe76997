// A project with a copy of include/errbound only. Without CMake:
//
//   g++ -std=c++20 -O2 -I PATH/TO/errbound/include main.cpp
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <errbound/predicates.hpp>
#include <vector>

using errbound::sign_type;
using point = std::array<double, 2>;

/// Positive inside a simple polygon, zero on its border, negative outside. Counts the edges that a
/// ray to the right crosses.
sign_type side_of(const std::vector<point>& polygon, const point& p) {
    bool inside = false;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const point& a = polygon[i];
        const point& b = polygon[(i + 1) % polygon.size()];
        const sign_type s = errbound::orient2d(a, b, p);
        const auto [left, right] = std::minmax(a[0], b[0]);
        const auto [low, high] = std::minmax(a[1], b[1]);
        if (s == sign_type::zero && left <= p[0] && p[0] <= right && low <= p[1] && p[1] <= high)
            return sign_type::zero;
        const bool up = a[1] <= p[1] && p[1] < b[1], down = b[1] <= p[1] && p[1] < a[1];
        if ((up && s == sign_type::positive) || (down && s == sign_type::negative))
            inside = !inside;
    }
    return inside ? sign_type::positive : sign_type::negative;
}

int main() {
    const std::vector<point> square{{0.1, 0.1}, {0.7, 0.1}, {0.7, 0.7}, {0.1, 0.7}};
    const std::vector<point> triangle{{0, 0}, {3, 1}, {0, 1}};
    const double third = 1.0 / 3;  // rounded down
    const bool right = side_of(square, {0.3, 0.7}) == sign_type::zero &&
                       side_of(square, {0.3, std::nextafter(0.7, 0)}) == sign_type::positive &&
                       side_of(square, {0.3, std::nextafter(0.7, 1)}) == sign_type::negative &&
                       side_of(triangle, {1, third}) == sign_type::negative &&
                       side_of(triangle, {1, std::nextafter(third, 1)}) == sign_type::positive;
    std::puts(right ? "all points are where they are" : "a point is not where it is");
    return right ? 0 : 1;
}
