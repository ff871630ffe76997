// Inputs of predicates: as they come, nearly degenerate, exactly degenerate, and of every size.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <random>
#include <string_view>
#include <type_traits>

namespace predicate_inputs {

/// What makes points degenerate: they lie on a line or plane, or on a circle or sphere.
enum class surface : std::uint8_t { flat, round };

template <class T, std::size_t Dimension, std::size_t Count>
using points = std::array<std::array<T, Dimension>, Count>;

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

/// On a line, plane, circle or sphere in [−1, 1], rounded and jittered by up to two units in the
/// last place.
template <std::floating_point T, std::size_t D, std::size_t N>
points<T, D, N> near(generator& random, surface s) {
    points<T, D, N> p;
    if (s == surface::flat) {
        std::array<T, D> slope;
        for (T& m : slope) m = uniform<T>(random, T(-0.5), T(0.5));
        for (auto& point : p) {
            T last = slope[D - 1] / 2;
            for (std::size_t k = 0; k + 1 < D; ++k) {
                point[k] = uniform<T>(random);
                last += slope[k] * point[k] / T(D - 1);
            }
            point[D - 1] = last;
        }
    } else {
        std::array<T, D> center;
        for (T& c : center) c = uniform<T>(random, T(-0.25), T(0.25));
        const T radius = uniform<T>(random, T(0.25), T(0.75));
        std::normal_distribution<T> normal;
        for (auto& point : p) {
            T length = 0;
            for (T& x : point) x = normal(random), length += x * x;
            length = std::sqrt(length);
            for (std::size_t k = 0; k < D; ++k) point[k] = center[k] + radius * point[k] / length;
        }
    }
    for (auto& point : p)
        for (T& x : point) x = jittered(random, x, 2);
    return p;
}

/// Small integers, exactly zero.
template <std::floating_point T, std::size_t D, std::size_t N>
points<T, D, N> grid(generator& random, surface s) {
    points<T, D, N> p;
    if (s == surface::flat) {  // integer combinations of D − 1 steps
        std::array<std::array<int, D>, D> step;
        for (auto& v : step)
            for (int& x : v) x = between(random, -7, 7);
        for (auto& point : p) {
            std::array<int, D> x = step[D - 1];
            for (std::size_t k = 0; k + 1 < D; ++k) {
                const int times = between(random, -7, 7);
                for (std::size_t i = 0; i < D; ++i) x[i] += times * step[k][i];
            }
            for (std::size_t i = 0; i < D; ++i) point[i] = static_cast<T>(x[i]);
        }
    } else {  // the corners of a box, moved, and its mirror images in the diagonals
        std::array<int, D> size, center;
        for (int& x : size) x = between(random, 1, 20);
        for (int& x : center) x = between(random, -20, 20);
        for (auto& point : p) {
            const auto turn = static_cast<std::size_t>(between(random, 0, D - 1));
            for (std::size_t i = 0; i < D; ++i) {
                const int x = size[(i + turn) % D];
                point[i] = static_cast<T>(center[i] + (between(random, 0, 1) == 0 ? x : -x));
            }
        }
    }
    return p;
}

/// Exactly zero, with coordinate differences that do not fit the number type: coordinates of one
/// point are those of the others in another order, or have equal ones.
template <std::floating_point T, std::size_t D, std::size_t N>
points<T, D, N> deep(generator& random, surface s) {
    points<T, D, N> p;
    const auto any = [&] { return std::ldexp(uniform<T>(random), between(random, -8, 0)); };
    if (s == surface::flat) {
        for (auto& point : p) {
            for (T& x : point) x = any();
            point[D - 1] = point[0];
        }
    } else {
        std::array<T, D> size;
        for (T& x : size) x = any();
        for (auto& point : p) {
            const auto turn = static_cast<std::size_t>(between(random, 0, D - 1));
            for (std::size_t i = 0; i < D; ++i)
                point[i] =
                    between(random, 0, 1) == 0 ? size[(i + turn) % D] : -size[(i + turn) % D];
        }
    }
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

/// One of the families above, times a power of two from all that there are: through the windows of
/// underflow and overflow of each predicate.
template <std::floating_point T, std::size_t D, std::size_t N>
points<T, D, N> scaled(generator& random, surface s) {
    points<T, D, N> p;
    switch (random() % 4) {
        case 0:
            p = any_uniform<T, D, N>(random, s);
            break;
        case 1:
            p = near<T, D, N>(random, s);
            break;
        case 2:
            p = grid<T, D, N>(random, s);
            break;
        default:
            p = deep<T, D, N>(random, s);
            break;
    }
    using limits = std::numeric_limits<T>;
    const int e = between(random, limits::min_exponent - limits::digits, limits::max_exponent - 9);
    for (auto& point : p)
        for (T& x : point) x = std::ldexp(x, e);
    return p;
}

/// Points of one of the families, each coordinate times a power of two of its own or its axis's.
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
        one = std::ldexp(one, between(random, -most, most));
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
inline constexpr std::array<family<T, D, N>, 8> families{{{"uniform", any_uniform<T, D, N>},
                                                          {"near", near<T, D, N>},
                                                          {"grid", grid<T, D, N>},
                                                          {"deep", deep<T, D, N>},
                                                          {"any bits", any_bits<T, D, N>},
                                                          {"few values", few_values<T, D, N>},
                                                          {"scaled", scaled<T, D, N>},
                                                          {"stretched", stretched<T, D, N>}}};

}  // namespace predicate_inputs
