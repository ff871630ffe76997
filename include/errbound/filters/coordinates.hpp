// Coordinates of users' point types.
#pragma once

#include <array>
#include <cassert>
#include <cstddef>
#include <span>
#include <tuple>
#include <type_traits>

namespace errbound {

namespace filters {

/// Eigen's vectors, matrices, arrays and expressions of them.
template <class Point>
concept matrix_point = requires(const Point& p) {
    static_cast<int>(Point::RowsAtCompileTime);
    static_cast<int>(Point::ColsAtCompileTime);
    static_cast<int>(Point::MaxSizeAtCompileTime);
    p.rows() + p.cols();
};
/// Coordinate i of a row or a column vector. A matrix of dynamic size may be either.
template <matrix_point Matrix>
constexpr auto element_of(const Matrix& m, int i) {
    constexpr int rows = Matrix::RowsAtCompileTime, columns = Matrix::ColsAtCompileTime;
    static_assert(rows < 2 || columns < 2,
                  "errbound: a matrix is a point only if it is a row or a column: write m.col(i)");
    assert((m.rows() == 1 || m.cols() == 1) &&
           "errbound: a matrix is a point only if it is a row or a column");
    if constexpr (rows == 1 || columns == 1)
        return m[i];
    else
        return m.cols() == 1 ? m(i, 0) : m(0, i);
}

}  // namespace filters

/// Coordinate i of a point, or the number itself. Precondition: i < p.size(), if p has a size().
template <class Point>
constexpr auto coordinate_of(const Point& p, int i) {
    if constexpr (requires { p[i], p.size(); } || filters::matrix_point<Point>)
        assert(static_cast<std::size_t>(i) < static_cast<std::size_t>(p.size()) &&
               "errbound: a point has fewer coordinates than the predicate's shape");
    if constexpr (std::is_arithmetic_v<Point>) {
        return p;
    } else if constexpr (filters::matrix_point<Point>) {
        return filters::element_of(p, i);
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
            "errbound: a point needs p[i], or x, y (and z) as members or member functions, or a "
            "function coordinate_of(point, i) in the namespace of the point's type");
        if constexpr (requires { p.z; })
            return i == 0 ? p.x : i == 1 ? p.y : p.z;
        else
            return i == 0 ? p.x : p.y;
    }
}

namespace filters {

template <class>
inline constexpr bool is_sized_span = false;
template <class T, std::size_t Size>
inline constexpr bool is_sized_span<std::span<T, Size>> = Size != std::dynamic_extent;

/// Number of coordinates of a point type; 0 if the type does not fix it. A type with x and y but no
/// z, as members or functions, has two; if it has a third coordinate by another name, it needs
/// p[i].
template <class Point>
constexpr std::size_t max_dimension() {
    constexpr auto has = [](auto test) {
        return std::is_invocable_v<decltype(test), const Point&>;
    };
    if constexpr (std::is_arithmetic_v<Point>) {
        return 1;
    } else if constexpr (matrix_point<Point>) {
        constexpr int size = Point::MaxSizeAtCompileTime;  // negative if not fixed
        return size < 0 ? 0 : static_cast<std::size_t>(size);
    } else if constexpr (is_sized_span<Point>) {
        return Point::extent;
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
