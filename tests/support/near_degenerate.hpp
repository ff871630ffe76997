// Queries that are degenerate, exactly or except for one last place of one coordinate.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "ccd/lab/generators.hpp"

namespace query_families::detail {

using ccd::kind;
using ccd::moving_point;
using ccd::point;
using namespace ccd::lab;
using namespace ccd::lab::generators;

/// One of the 24 numbers moved to an adjacent double; jitter moves zeros.
inline points nudged(source& random, const points& p) {
    const int moved = random.between(0, 23);
    int k = 0;
    return map(p, [&](double x, auto...) {
        if (k++ != moved) return x;
        const int side = random.one_in(2) ? 1 : -1;
        return x == 0 ? std::ldexp(side, -53)
                      : std::nextafter(x, side * std::numeric_limits<double>::max());
    });
}

/// Whole multiples of `directions` whole vectors, on a moving base: in one plane of any slope, or
/// on one line, throughout the step.
inline points in_skew_span(source& random, std::size_t directions) {
    std::array<position, 2> along{};
    for (std::size_t d = 0; d < directions; ++d)
        for (double& c : along[d]) c = random.between(-3, 3);
    ends base;
    for (auto& e : base)
        for (double& c : e) c = random.between(-4, 4);
    points out;
    for (auto& m : out) {
        ends at = base;
        for (auto& e : at) {
            for (const position& v : along) {
                const int times = random.between(-3, 3);
                for (std::size_t axis = 0; axis < 3; ++axis) e[axis] += times * v[axis];
            }
        }
        m = moving(at);
    }
    return out;
}

/// A contact without any rounding: positions of 40 bits, weights in eighths, at a quarter of the
/// step or a multiple of it.
inline points exact_contact(source& random, kind which) {
    const auto number = [&random] { return std::ldexp(random.between(-(1 << 28), 1 << 28), -26); };
    std::array<position, 4> at, velocity;
    for (auto& p : at)
        for (double& c : p) c = number();
    for (auto& v : velocity)
        for (double& c : v) c = number();
    const auto eighths = [&random](std::size_t corners) {
        position w{};
        int rest = 8;
        for (std::size_t i = 0; i + 1 < corners; ++i) {
            const int part = random.between(0, rest);
            w[i] = part / 8.0;
            rest -= part;
        }
        w[corners - 1] = rest / 8.0;
        return w;
    };
    const position a = eighths(2), b = eighths(2), c = eighths(3);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (which == kind::edge_edge) {
            const double gap =
                a[0] * at[0][axis] + a[1] * at[1][axis] - b[0] * at[2][axis] - b[1] * at[3][axis];
            at[2][axis] += gap;
            at[3][axis] += gap;
        } else if (which == kind::vertex_vertex) {
            at[0][axis] = at[1][axis];
        } else {
            const position& w = which == kind::vertex_edge ? a : c;
            at[0][axis] = w[0] * at[1][axis] + w[1] * at[2][axis] + w[2] * at[3][axis];
        }
    }
    const double t = random.between(0, 4) / 4.0;
    return fill([&](std::size_t i, std::size_t end, std::size_t axis) {
        return at[i][axis] + velocity[i][axis] * (end == 0 ? -t : 1 - t);
    });
}

/// Two points swap places, or one passes through another, in the middle of the step or later.
inline points crossing(source& random, points p) {
    const int first = random.between(0, 3), turn = random.between(1, 3),
              ratio = random.between(1, 3);
    moving_point<double>& m = p[static_cast<std::size_t>(first)];
    const moving_point<double>& other = p[static_cast<std::size_t>((first + turn) % 4)];
    const auto beyond = [ratio](double from, double at_start, double at_end) {
        return at_end - ratio * (from - at_start);
    };
    m.t1 = {beyond(m.t0.x, other.t0.x, other.t1.x), beyond(m.t0.y, other.t0.y, other.t1.y),
            beyond(m.t0.z, other.t0.z, other.t1.z)};
    return p;
}

/// The last two points mirror the first two in a coordinate plane, at one end or at both.
inline points mirrored(source& random, const points& p) {
    const auto normal = static_cast<std::size_t>(random.between(0, 2));
    const int when = random.between(0, 2);
    points out = p;
    const auto image = [&](const point<double>& at) {
        std::array<double, 3> c{at.x, at.y, at.z};
        c[normal] = -c[normal];
        return point<double>{c[0], c[1], c[2]};
    };
    for (std::size_t i = 0; i < 2; ++i) {
        if (when != 1) out[i + 2].t0 = image(p[i].t0);
        if (when != 0) out[i + 2].t1 = image(p[i].t1);
    }
    return out;
}

/// Small whole numbers next to one large one for each axis, as far from the origin as they remain
/// exact.
inline points far_grid(source& random) {
    position offset;
    for (double& c : offset) c = std::ldexp(1, random.between(20, 51));
    return map(grid(random, 2), [&](double x, std::size_t, std::size_t, std::size_t axis) {
        return x + offset[axis];
    });
}

}  // namespace query_families::detail
