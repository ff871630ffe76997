// Neighbouring elements of two curved sheets.
#pragma once

#include <array>
#include <cmath>

#include "ccd/stress/generators/coordinates.hpp"

namespace ccd::stress::generators {

// Neighbouring elements of two curved sheets of one grid, as a folded cloth has them: they drift,
// bend, and one passes towards or through the other. Now and then both are of one sheet.
inline points sheets(source& random, kind which) {
    constexpr double cell = 0.0625;
    const int exponent = -random.between(4, 12);
    const double gap = std::ldexp(random.unit(), exponent);
    const double advance = 2 * random.unit() * gap;
    const bool same_sheet = random.one_in(4);
    const position curve{random.symmetric(), random.symmetric(), random.symmetric()};
    const position bend{cell * random.symmetric(), cell * random.symmetric(),
                        cell * random.symmetric()};
    const position drift{random.symmetric(), random.symmetric(), random.symmetric()};
    const position slide{cell * random.symmetric(), cell * random.symmetric(), 0};
    const auto height = [](const position& c, double x, double y) {
        return c[0] * x * x + c[1] * x * y + c[2] * y * y;
    };
    const auto at = [&](int i, int j, bool upper) {
        const double x = cell * i, y = cell * j;
        const position start{x + (upper ? slide[0] : 0), y + (upper ? slide[1] : 0),
                             height(curve, x, y) + (upper ? gap : 0)};
        const position end{start[0] + drift[0], start[1] + drift[1],
                           start[2] + drift[2] + height(bend, x, y) - (upper ? advance : 0)};
        return moving({start, end});
    };
    const bool upper = !same_sheet;
    const int i = random.between(0, 2), j = random.between(0, 2);
    const int k = random.between(0, 2), l = random.between(0, 2);
    if (which == kind::edge_edge) {
        // Along the grid or a diagonal.
        const auto step = [&random] {
            constexpr std::array<std::array<int, 2>, 3> steps{{{1, 0}, {0, 1}, {1, 1}}};
            return steps[static_cast<std::size_t>(random.between(0, 2))];
        };
        const auto a = step(), b = step();
        return {at(i, j, upper), at(i + a[0], j + a[1], upper), at(k, l, false),
                at(k + b[0], l + b[1], false)};
    }
    const int right = random.between(0, 1);  // which half of the cell
    return {at(i, j, upper), at(k, l, false), at(k + 1, l + 1 - right, false),
            at(k + right, l + 1, false)};
}

}  // namespace ccd::stress::generators
