// Random queries: of every scale, rounding and regularity; degenerate; near contact; with chosen
// roots.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <limits>

#include "ccd/lab/queries.hpp"

namespace ccd::lab::generators {

// ---- Numbers and coordinates ----

using position = std::array<double, 3>;  // also a displacement

using ends = std::array<position, 2>;

inline moving_point<double> moving(const ends& e) {
    return {{e[0][0], e[0][1], e[0][2]}, {e[1][0], e[1][1], e[1][2]}};
}

// Calls make(point, end, axis) for all 24 numbers, in a fixed order.
template <class Make>
points fill(Make make) {
    points out;
    for (std::size_t i = 0; i < 4; ++i) {
        ends e;
        for (std::size_t end = 0; end < 2; ++end) {
            for (std::size_t axis = 0; axis < 3; ++axis) e[end][axis] = make(i, end, axis);
        }
        out[i] = moving(e);
    }
    return out;
}

// Calls change(value, point, end, axis) for all 24 numbers.
template <class Change>
points map(const points& p, Change change) {
    return fill([&](std::size_t i, std::size_t end, std::size_t axis) {
        const point<double>& at = end == 0 ? p[i].t0 : p[i].t1;
        return change(std::array{at.x, at.y, at.z}[axis], i, end, axis);
    });
}

// Moves x by up to `max_units` units in its last place; zero by units of 2^-53, since its
// neighbours would add a second scale.
inline double jitter(source& random, double x, int max_units) {
    const int units = random.between(-max_units, max_units);
    if (x == 0) return std::ldexp(units, -53);
    for (int n = std::abs(units); n > 0; --n) {
        x = std::nextafter(x, units * std::numeric_limits<double>::infinity());
    }
    return x;
}

inline points jitter(source& random, const points& p, int max_units) {
    return map(p, [&](double x, auto...) { return jitter(random, x, max_units); });
}

inline points uniform(source& random) {
    return fill([&](auto...) { return random.symmetric(); });
}

inline points grid(source& random, int half) {
    return fill([&](auto...) { return random.between(-half, half); });
}

// ---- Queries in contact, or near one ----

inline std::size_t first_feature_size(kind which) {
    return which == kind::edge_edge ? 2 : 1;
}

// Weights of a point of a segment or triangle; `corners` of them, often on its border.
inline position weights(source& random, std::size_t corners) {
    position w{};
    double rest = 1;
    for (std::size_t i = 0; i + 1 < corners; ++i) {
        const int pick = random.between(0, 5);
        const double part = pick == 0 ? 0 : pick == 1 ? 1 : pick == 2 ? 0.5 : random.unit();
        w[i] = rest * part;
        rest -= w[i];
    }
    w[corners - 1] = rest;
    return w;
}

inline std::array<position, 4> positions(source& random) {
    std::array<position, 4> at;
    for (auto& p : at) p = {random.symmetric(), random.symmetric(), random.symmetric()};
    return at;
}

// A contact at one instant, as near as rounding allows: moves the first feature of `at` (EE: the
// second) to the other one, then gives each point a random velocity, times `speed`. pick(random,
// corners) draws the weights.
template <class Pick>
points contact_at(source& random, kind which, double speed, std::array<position, 4> at, Pick pick) {
    if (which == kind::edge_edge) {
        const position a = pick(random, 2);
        const position b = pick(random, 2);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double gap =
                a[0] * at[0][axis] + a[1] * at[1][axis] - b[0] * at[2][axis] - b[1] * at[3][axis];
            at[2][axis] += gap;
            at[3][axis] += gap;
        }
    } else {
        const std::size_t corners = which == kind::vertex_face   ? 3
                                    : which == kind::vertex_edge ? 2
                                                                 : 1;
        const position w = pick(random, corners);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            at[0][axis] = w[0] * at[1][axis] + w[1] * at[2][axis] + w[2] * at[3][axis];
        }
    }
    const int when = random.between(0, 3);
    const double t = when == 0 ? 0 : when == 1 ? 1 : when == 2 ? 0.5 : random.unit();
    const std::array<position, 4> velocity = positions(random);
    return fill([&](std::size_t i, std::size_t end, std::size_t axis) {
        return at[i][axis] + speed * velocity[i][axis] * (end == 0 ? -t : 1 - t);
    });
}

inline points near_contact(source& random, kind which, double speed) {
    return contact_at(random, which, speed, positions(random), weights);
}

// Weights within 2^-30 to 2^-58 of a border, inside or outside.
inline position border_weights(source& random, std::size_t corners) {
    const int exponent = -random.between(30, 58);
    const double beyond = std::ldexp(random.one_in(2) ? 1 : -1, exponent);
    if (corners == 1) return {1, 0, 0};
    if (corners == 2) {
        return random.one_in(2) ? position{beyond, 1 - beyond, 0} : position{1 - beyond, beyond, 0};
    }
    const double second = (1 - beyond) * random.unit();
    const std::array<double, 3> w{beyond, second, 1 - beyond - second};
    const auto turn = static_cast<std::size_t>(random.between(0, 2));
    return {w[turn], w[(turn + 1) % 3], w[(turn + 2) % 3]};
}

inline points border_contact(source& random, kind which) {
    return contact_at(random, which, 1, positions(random), border_weights);
}

// Moves the first feature by at most 2^exponent on each axis.
inline points shifted(source& random, kind which, const points& p, int exponent) {
    const position shift{random.symmetric(), random.symmetric(), random.symmetric()};
    return map(p, [&](double x, std::size_t i, std::size_t, std::size_t axis) {
        return i < first_feature_size(which) ? x + std::ldexp(shift[axis], exponent) : x;
    });
}

// Everything moves by one vector: features in contact stay so, except for rounding.
inline points drifting(source& random, const points& p) {
    const position drift{random.symmetric(), random.symmetric(), random.symmetric()};
    return map(p, [&](double x, std::size_t, std::size_t end, std::size_t axis) {
        return end == 0 ? x : x + drift[axis];
    });
}

inline points resting(source& random, kind which) {
    return drifting(random, near_contact(random, which, 0));
}

// A contact of edges that are parallel up to 2^exponent, or with a triangle that is as flat. They
// are so at the contact only, or throughout if the motion is as small.
inline points sliver(source& random, kind which, int exponent) {
    std::array<position, 4> at = positions(random);
    const bool face = which == kind::vertex_face;
    const std::size_t base = face ? 1 : 2, from = face ? 1 : 0;
    const double along = 2 * random.symmetric();
    for (std::size_t axis = 0; axis < 3; ++axis) {
        at[3][axis] = at[base][axis] + along * (at[from + 1][axis] - at[from][axis]) +
                      std::ldexp(random.symmetric(), exponent);
    }
    const double speed = random.one_in(2) ? 1 : std::ldexp(1, exponent);
    return contact_at(random, which, speed, at, weights);
}

// A contact with one edge of length 2^exponent.
inline points needle(source& random, kind which, int exponent) {
    std::array<position, 4> at = positions(random);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        at[3][axis] = at[2][axis] + std::ldexp(random.symmetric(), exponent);
    }
    const double speed = random.one_in(2) ? 1 : std::ldexp(1, exponent);
    return contact_at(random, which, speed, at, weights);
}

// ---- Contacts at chosen roots ----

using matrix = std::array<position, 3>;  // rows

inline matrix product(const matrix& a, const matrix& b) {
    matrix c{};
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
            for (std::size_t k = 0; k < 3; ++k) c[i][j] += a[i][k] * b[k][j];
        }
    }
    return c;
}

struct fraction {
    int numerator = 0, denominator = 1;
};

// Exact contacts at chosen roots of Y, multiplicities included.
//
// The columns of M(t) = U T(t) V are the query's three differences. T is upper triangular, and its
// diagonal vanishes at the chosen roots r0, r1 and r2 of det M. At r0 the first unit vector is in
// T's kernel. With V = n A^-1, where A has the first column (x, y, n), (x, y, n) is in the kernel
// of M. So x/n and y/n are the weights of the contact. All numbers are small integers, so nothing
// rounds.
inline points chosen_roots(source& random, kind which, const std::array<fraction, 3>& roots) {
    const bool face = which == kind::vertex_face;
    const int n = random.between(1, 4);
    const int i = random.between(0, n);
    const int j = random.between(0, face ? n - i : n);
    // VF: p - f0 = (i (f1 - f0) + j (f2 - f0)) / n. EE: a0 + (i/n) a = b0 + (j/n) b.
    const double x = face ? -i : i;
    const double y = -j;
    const double w = face ? n : -n;
    const matrix v{{{0, 0, 1}, {w, 0, -x}, {0, w, -y}}};
    const matrix u{{{1, static_cast<double>(random.between(-1, 1)), 0},
                    {0, 1, static_cast<double>(random.between(-1, 1))},
                    {static_cast<double>(random.between(-1, 1)), 0, 1}}};
    std::array<matrix, 2> m;
    const std::array<double, 3> above{static_cast<double>(random.between(-2, 2)),
                                      static_cast<double>(random.between(-2, 2)),
                                      static_cast<double>(random.between(-2, 2))};
    const std::array<double, 3> slope{static_cast<double>(random.between(-2, 2)),
                                      static_cast<double>(random.between(-2, 2)),
                                      static_cast<double>(random.between(-2, 2))};
    for (std::size_t end = 0; end < 2; ++end) {
        const auto t = static_cast<double>(end);
        const auto vanishing = [t](const fraction& root) {
            return root.denominator * t - root.numerator;
        };
        const matrix upper{{{vanishing(roots[0]), above[0] + t * slope[0], above[1] + t * slope[1]},
                            {0, vanishing(roots[1]), above[2] + t * slope[2]},
                            {0, 0, vanishing(roots[2])}}};
        m[end] = product(product(u, upper), v);
    }
    ends base;
    for (auto& e : base) {
        for (double& c : e) c = random.between(-2, 2);
    }
    const auto offset = [&](std::size_t column, std::size_t end, std::size_t axis) {
        return base[end][axis] + m[end][axis][column];
    };
    return fill([&](std::size_t point, std::size_t end, std::size_t axis) {
        if (face) {
            if (point == 1) return base[end][axis];
            return offset(point == 0 ? 2 : point - 2, end, axis);
        }
        if (point == 0) return base[end][axis];
        if (point == 1) return offset(0, end, axis);
        const double b0 = offset(2, end, axis);
        return point == 2 ? b0 : b0 + m[end][axis][1];
    });
}

inline std::array<fraction, 3> root_triple(source& random, int multiplicity) {
    std::array<fraction, 3> r;
    for (fraction& root : r) {
        root.denominator = random.between(1, 8);
        root.numerator = random.between(0, root.denominator);
    }
    if (multiplicity > 1) r[1] = r[0];
    if (multiplicity > 2) r[2] = r[0];
    return r;
}

// ---- Neighbouring elements of two curved sheets ----

// Two curved sheets of one grid, as in a folded cloth, drift and bend, and one moves towards or
// through the other. At times both elements are of one sheet.
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

}  // namespace ccd::lab::generators
