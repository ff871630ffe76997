// Coordinates of what users have as points.
#pragma once

#include <array>
#include <cstddef>
#include <tuple>
#include <type_traits>

namespace errbound {

/// Coordinate i of a point, or the number itself, of what users have as points.
template <class Point>
constexpr auto coordinate_of(const Point& p, int i) {
    if constexpr (std::is_arithmetic_v<Point>) {
        return p;
    } else if constexpr (requires { p[i]; }) {
        return p[static_cast<std::size_t>(i)];
    } else if constexpr (requires { p.x() + p.y(); }) {
        if constexpr (requires { p.z(); })
            return i == 0 ? p.x() : i == 1 ? p.y() : p.z();
        else
            return i == 0 ? p.x() : p.y();
    } else {
        static_assert(
            requires { p.x + p.y; },
            "errbound: a point needs p[i], or x, y (and z) as members or member functions");
        if constexpr (requires { p.z; })
            return i == 0 ? p.x : i == 1 ? p.y : p.z;
        else
            return i == 0 ? p.x : p.y;
    }
}

namespace filters {

/// How many coordinates a point is known to have; 0 if its type does not tell. x and y without z,
/// as members or functions, are two: of a point with a third under another name it takes p[i].
template <class Point>
constexpr std::size_t known_dimension() {
    constexpr auto has = [](auto test) {
        return std::is_invocable_v<decltype(test), const Point&>;
    };
    if constexpr (std::is_arithmetic_v<Point>) {
        return 1;
    } else if constexpr (requires { Point::SizeAtCompileTime; }) {
        return Point::SizeAtCompileTime > 0 ? std::size_t{Point::SizeAtCompileTime} : 0;
    } else if constexpr (std::is_array_v<Point>) {
        return std::extent_v<Point>;
    } else if constexpr (requires { std::tuple_size<Point>::value; }) {
        return std::tuple_size_v<Point>;
    } else if constexpr (has([](const auto& p) -> decltype(p[0]) { return p[0]; })) {
        return 0;
    } else if constexpr (has([](const auto& p) -> decltype(p.z()) { return p.z(); }) ||
                         has([](const auto& p) -> decltype(p.z) { return p.z; })) {
        return 3;
    } else if constexpr (has([](const auto& p) -> decltype(p.y()) { return p.y(); }) ||
                         has([](const auto& p) -> decltype(p.y) { return p.y; })) {
        return 2;
    } else {
        return 0;
    }
}

}  // namespace filters

}  // namespace errbound
