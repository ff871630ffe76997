// Numbers and coordinates: of every scale, rounding and regularity.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <utility>

#include "ccd/stress/generators/query_points.hpp"

namespace ccd::stress::generators {

using position = std::array<double, 3>;  // also a displacement

// A position at the start and one at the end of the step.
using ends = std::array<position, 2>;

inline moving_point<double> moving(const ends& e) {
    return {{e[0][0], e[0][1], e[0][2]}, {e[1][0], e[1][1], e[1][2]}};
}

// make(point, end, axis) for all 24 numbers, in one fixed order.
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

// change(value, point, end, axis) of all 24 numbers.
template <class Change>
points map(const points& p, Change change) {
    return fill([&](std::size_t i, std::size_t end, std::size_t axis) {
        const point<double>& at = end == 0 ? p[i].t0 : p[i].t1;
        return change(std::array{at.x, at.y, at.z}[axis], i, end, axis);
    });
}

// The sign of every exponent below is drawn: 2^exponent or 2^-exponent.
inline int either_sign(source& random, int exponent) {
    return random.one_in(2) ? exponent : -exponent;
}

inline points scale(source& random, const points& p, int exponent) {
    const int drawn = either_sign(random, exponent);
    return map(p, [&](double x, auto...) { return std::ldexp(x, drawn); });
}

inline points scale_axis(source& random, const points& p, int exponent) {
    const int drawn = either_sign(random, exponent);
    const auto scaled = static_cast<std::size_t>(random.between(0, 2));
    return map(p, [&](double x, std::size_t, std::size_t, std::size_t axis) {
        return axis == scaled ? std::ldexp(x, drawn) : x;
    });
}

inline points scale_point(source& random, const points& p, int exponent) {
    const int drawn = either_sign(random, exponent);
    const auto scaled = static_cast<std::size_t>(random.between(0, 3));
    return map(p, [&](double x, std::size_t point, auto...) {
        return point == scaled ? std::ldexp(x, drawn) : x;
    });
}

// x moved by at most `most` units in its last place; a zero by units of 2^-53, since its neighbours
// would bring in a second scale (the families of mixed scales do that).
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

// All within 2^-10 of one another, and moving no further.
inline points clustered(source& random) {
    const position centre{random.symmetric(), random.symmetric(), random.symmetric()};
    return fill([&](std::size_t, std::size_t, std::size_t axis) {
        return centre[axis] + std::ldexp(random.symmetric(), -10);
    });
}

inline points grid(source& random, int half) {
    return fill([&](auto...) { return random.between(-half, half); });
}

// Every point is turned a quarter round one axis, one way or the other, as spinning parts are:
// cubics with extrema and an inflection inside.
inline points rotating(source& random) {
    points p = uniform(random);
    for (auto& m : p) {
        const double lift = 0.25 * random.symmetric();
        const double grow = 1 + 0.25 * random.symmetric();
        m.t1 = {-grow * m.t0.y, grow * m.t0.x, m.t0.z + lift};
        if (random.one_in(2)) std::swap(m.t0, m.t1);
    }
    return p;
}

// Multiples of the least positive double.
inline points subnormal(source& random) {
    const int size = random.between(1, 16);
    return fill(
        [&](auto...) { return std::ldexp(random.between(-(1 << size), 1 << size), -1074); });
}

// Any finite doubles.
inline points any_bits(source& random) {
    return fill([&](auto...) {
        for (;;) {
            const auto x = std::bit_cast<double>(random.bits());
            if (std::isfinite(x)) return x;
        }
    });
}

// Powers of two of every size, so that one query holds many scales.
inline points mixed_scales(source& random, int range) {
    return fill([&](auto...) {
        const int factor = random.between(-2, 2);
        return std::ldexp(factor, random.between(-range, range));
    });
}

// As from files and programs in single precision.
inline points rounded_to_float(const points& p) {
    return map(p, [](double x, auto...) { return static_cast<float>(x); });
}

// As from text with three digits after the point.
inline points rounded_to_digits(const points& p) {
    return map(p, [](double x, auto...) { return std::round(1000 * x) / 1000; });
}

// Each axis has three values: exact degeneracies of coordinates that fill their 53 bits.
inline points few_values(source& random) {
    std::array<position, 3> values;
    for (auto& axis : values) axis = {random.symmetric(), random.symmetric(), random.symmetric()};
    return fill([&](std::size_t, std::size_t, std::size_t axis) {
        return values[axis][static_cast<std::size_t>(random.between(0, 2))];
    });
}

}  // namespace ccd::stress::generators
