// Inputs of predicates: random, nearly degenerate, exactly degenerate, and of every size.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <random>
#include <string>
#include <string_view>
#include <type_traits>

namespace predicate_inputs {

/// The surface that makes points degenerate.
enum class surface : std::uint8_t {
    flat,        ///< they lie on a line or plane
    round,       ///< on a circle or sphere
    weighted,    ///< as round, with a last coordinate that is a weight
    centred,     ///< as round, except that the first is the centre
    concurrent,  ///< on lines, or a line and planes, that meet in one point
};

template <class T, std::size_t Dimension, std::size_t Count>
using points = std::array<std::array<T, Dimension>, Count>;

/// The coordinates as hexadecimal floats.
template <class T, std::size_t D, std::size_t N>
std::string text_of(const points<T, D, N>& p) {
    std::string text;
    char number[40];
    for (const auto& point : p)
        for (const T x : point) {
            std::snprintf(number, sizeof number, " %a", static_cast<double>(x));
            text += number;
        }
    return text;
}

using generator = std::mt19937_64;

template <std::floating_point T>
T uniform(generator& random, T low = -1, T high = 1) {
    return std::uniform_real_distribution<T>(low, high)(random);
}
inline int between(generator& random, int low, int high) {
    return std::uniform_int_distribution<int>(low, high)(random);
}
/// x moved by up to `most` units in the last place.
template <std::floating_point T>
T jittered(generator& random, T x, int most) {
    for (int steps = between(random, -most, most); steps != 0; steps += steps < 0 ? 1 : -1)
        x = std::nextafter(x, steps < 0 ? -std::numeric_limits<T>::infinity()
                                        : std::numeric_limits<T>::infinity());
    return x;
}

/// Coordinates in [−1, 1].
template <std::floating_point T, std::size_t D, std::size_t N>
points<T, D, N> any_uniform(generator& random, surface) {
    points<T, D, N> p;
    for (auto& point : p)
        for (T& x : point) x = uniform<T>(random);
    return p;
}

/// Draws each point until it differs from all before it.
template <class Points, class Draw>
void fill_distinct(Points& p, const Draw& draw) {
    for (auto q = p.begin(); q != p.end(); ++q) do
            *q = draw(static_cast<std::size_t>(q - p.begin()));
        while (std::find(p.begin(), q, *q) != q);
}

/// Flat and concurrent points: an origin and multiples of steps. `times` returns as many factors as
/// there can be steps.
template <class T, std::size_t D, std::size_t N, class Step, class Times>
points<T, D, N> on_flats(surface s, const std::array<T, D>& origin, const Step& step,
                         const Times& times) {
    // Each group of points spans a line or, if the number of points permits, a plane.
    constexpr std::size_t plane = D < 3 ? 1 : D - 1;
    const std::size_t later = (N - 2) % D == 0 ? plane : 1;
    std::array<std::array<T, D>, D> steps;
    std::size_t dimension = 0, group_end = 0;
    points<T, D, N> p;
    fill_distinct(p, [&](std::size_t i) {
        if (i >= group_end) {
            dimension = s == surface::flat ? plane : i == 0 ? 1 : later;
            group_end = s == surface::flat ? N : i + dimension + 1;
            for (std::size_t k = 0; k < dimension; ++k) steps[k] = step();
        }
        std::array<T, D> point = origin;
        const std::array<T, D> factors = times();
        for (std::size_t k = 0; k < dimension; ++k)
            for (std::size_t j = 0; j < D; ++j) point[j] += factors[k] * steps[k][j];
        return point;
    });
    return p;
}

/// The last coordinates become a multiple of another: up to a plane, their height over the
/// paraboloid is constant.
template <class T, std::size_t D, std::size_t N>
void add_weights(generator& random, points<T, D, N>& p) {
    const auto axis = static_cast<std::size_t>(between(random, 0, int(D) - 2));
    const int factor = between(random, 0, 3);
    for (auto& point : p) point[D - 1] = std::ldexp(point[axis], factor);
}
/// The number of coordinates that are not weights.
template <std::size_t D>
std::size_t space(surface s) {
    return s == surface::weighted ? D - 1 : D;
}
constexpr bool is_flat(surface s) {
    return s == surface::flat || s == surface::concurrent;
}

/// Points on the surface in [−1, 1], rounded and jittered by up to two units in the last place.
template <std::floating_point T, std::size_t D, std::size_t N>
points<T, D, N> near(generator& random, surface s) {
    const auto vector = [&](T most) {
        std::array<T, D> v;
        for (T& x : v) x = uniform<T>(random, -most, most);
        return v;
    };
    points<T, D, N> p;
    if (is_flat(s)) {
        p = on_flats<T, D, N>(
            s, vector(T(0.25)), [&] { return vector(T(0.75) / T(D < 3 ? 1 : D - 1)); },
            [&] { return vector(1); });
    } else {
        const auto center = vector(T(0.25));
        const T radius = uniform<T>(random, T(0.25), T(0.75));
        std::normal_distribution<T> normal;
        for (auto& point : p) {
            T length;
            do {  // floats can all be zero
                length = 0;
                for (std::size_t k = 0; k < space<D>(s); ++k)
                    point[k] = normal(random), length += point[k] * point[k];
                length = std::sqrt(length);
            } while (length == 0);
            for (std::size_t k = 0; k < space<D>(s); ++k)
                point[k] = center[k] + radius * point[k] / length;
        }
        if (s == surface::weighted) add_weights<T, D, N>(random, p);
        if (s == surface::centred) p[0] = center;
    }
    for (auto& point : p)
        for (T& x : point) x = jittered(random, x, 2);
    return p;
}

/// Different points with small integers as coordinates, for which the predicate is exactly zero.
template <std::floating_point T, std::size_t D, std::size_t N>
points<T, D, N> grid(generator& random, surface s) {
    const auto vector = [&](int low, int high) {
        std::array<T, D> v;
        for (T& x : v) x = static_cast<T>(between(random, low, high));
        return v;
    };
    if (is_flat(s))
        return on_flats<T, D, N>(
            s, vector(-7, 7),
            [&] {
                std::array<T, D> step;
                do step = vector(-7, 7);
                while (step == std::array<T, D>{});
                return step;
            },
            [&] { return vector(-7, 7); });
    // The corners of a box, and its mirror images in the diagonals.
    const auto size = vector(1, 20), center = vector(-20, 20);
    points<T, D, N> p;
    fill_distinct(p, [&](std::size_t) {
        std::array<T, D> point{};
        const auto turn = random();
        for (std::size_t k = 0; k < space<D>(s); ++k) {
            const T x = size[(k + turn) % space<D>(s)];
            point[k] = center[k] + (random() % 2 == 0 ? x : -x);
        }
        return point;
    });
    if (s == surface::weighted) add_weights<T, D, N>(random, p);
    if (s == surface::centred) p[0] = center;
    return p;
}

/// The same with coordinate differences that do not fit the number type.
template <std::floating_point T, std::size_t D, std::size_t N>
points<T, D, N> deep(generator& random, surface s) {
    constexpr int digits = std::numeric_limits<T>::digits;
    // Small whole steps from zero; factors of so few bits that all coordinates are exact, on one
    // exponent for each point.
    if (is_flat(s))
        return on_flats<T, D, N>(
            s, {},
            [&] {
                std::array<T, D> step;
                for (T& x : step)
                    x = static_cast<T>(between(random, 1, 7) * (random() % 2 ? 1 : -1));
                return step;
            },
            [&] {
                const int exponent = between(random, -12, 0);
                std::array<T, D> factors;
                for (T& x : factors)
                    x = std::ldexp(std::trunc(std::ldexp(uniform<T>(random), digits - 4)),
                                   exponent - digits + 1);
                return factors;
            });
    // The corners of a box around zero, and its mirror images in the diagonals. The centre is any
    // point on the long diagonal, then of one corner's mirror images.
    std::array<T, D> size;
    for (T& x : size) x = std::ldexp(uniform<T>(random), between(random, -8, 0));
    points<T, D, N> p;
    fill_distinct(p, [&](std::size_t i) {
        std::array<T, D> point{};
        const auto turn = random();
        if (s == surface::centred && i == 0)
            point.fill(std::ldexp(uniform<T>(random), between(random, -8, 0)));
        else
            for (std::size_t k = 0; k < space<D>(s); ++k) {
                const T x = size[(k + turn) % space<D>(s)];
                point[k] = s == surface::centred || random() % 2 == 0 ? x : -x;
            }
        return point;
    });
    if (s == surface::weighted) add_weights<T, D, N>(random, p);
    return p;
}

/// Any bits that are a finite number: all exponents, mixed.
template <std::floating_point T, std::size_t D, std::size_t N>
points<T, D, N> any_bits(generator& random, surface) {
    using bits = std::conditional_t<sizeof(T) == 8, std::uint64_t, std::uint32_t>;
    points<T, D, N> p;
    for (auto& point : p)
        for (T& x : point) do {
                x = std::bit_cast<T>(static_cast<bits>(random()));
            } while (!std::isfinite(x));
    return p;
}

/// A few different coordinates of any exponent, so that much is equal and much cancels.
template <std::floating_point T, std::size_t D, std::size_t N>
points<T, D, N> few_values(generator& random, surface s) {
    const auto values = any_bits<T, 1, 4>(random, s);
    points<T, D, N> p;
    for (auto& point : p)
        for (T& x : point) {
            x = values[random() % 4][0];
            if (random() % 2 == 0) x = -x;
            if (random() % 8 == 0) x = 0;
        }
    return p;
}

/// One of the families that are timed.
template <std::floating_point T, std::size_t D, std::size_t N>
points<T, D, N> any_timed(generator& random, surface s) {
    switch (random() % 4) {
        case 0:
            return any_uniform<T, D, N>(random, s);
        case 1:
            return near<T, D, N>(random, s);
        case 2:
            return grid<T, D, N>(random, s);
        default:
            return deep<T, D, N>(random, s);
    }
}
/// A timed family times any power of two.
template <std::floating_point T, std::size_t D, std::size_t N>
points<T, D, N> scaled(generator& random, surface s) {
    points<T, D, N> p = any_timed<T, D, N>(random, s);
    using limits = std::numeric_limits<T>;
    const int e = between(random, limits::min_exponent - limits::digits, limits::max_exponent - 9);
    for (auto& point : p)
        for (T& x : point) x = std::ldexp(x, e);
    return p;
}
/// A timed family where products of some coordinates begin to underflow or to overflow.
template <std::floating_point T, std::size_t D, std::size_t N>
points<T, D, N> in_windows(generator& random, surface s) {
    points<T, D, N> p = any_timed<T, D, N>(random, s);
    using limits = std::numeric_limits<T>;
    const int factors = between(random, 1, 7);
    const int window = (random() % 2 == 0 ? limits::min_exponent : limits::max_exponent) / factors;
    const int width = limits::digits / factors + 8;
    const int e =
        std::min(between(random, window - width, window + width), limits::max_exponent - 9);
    for (auto& point : p)
        for (T& x : point) x = std::ldexp(x, e);
    return p;
}

/// Points of one of the families, each axis times a power of two, and in half also one coordinate.
template <std::floating_point T, std::size_t D, std::size_t N>
points<T, D, N> stretched(generator& random, surface s) {
    points<T, D, N> p = random() % 2 == 0 ? near<T, D, N>(random, s) : deep<T, D, N>(random, s);
    const int most = 1 << between(random, 2, sizeof(T) == 8 ? 9 : 6);
    std::array<int, D> e;
    for (int& x : e) x = between(random, -most, most);
    for (auto& point : p)
        for (std::size_t i = 0; i < D; ++i) point[i] = std::ldexp(point[i], e[i]);
    if (random() % 2 == 0) {
        T& one = p[random() % N][random() % D];
        one = std::ldexp(one, between(random, -most, most - 8));  // together without overflow
    }
    return p;
}

template <std::floating_point T, std::size_t D, std::size_t N>
struct family {
    std::string_view name;
    points<T, D, N> (*make)(generator&, surface);
};
/// The first four are timed.
template <std::floating_point T, std::size_t D, std::size_t N>
inline constexpr std::array<family<T, D, N>, 9> families{{{"uniform", any_uniform<T, D, N>},
                                                          {"near", near<T, D, N>},
                                                          {"grid", grid<T, D, N>},
                                                          {"deep", deep<T, D, N>},
                                                          {"any bits", any_bits<T, D, N>},
                                                          {"few values", few_values<T, D, N>},
                                                          {"scaled", scaled<T, D, N>},
                                                          {"in windows", in_windows<T, D, N>},
                                                          {"stretched", stretched<T, D, N>}}};

}  // namespace predicate_inputs
