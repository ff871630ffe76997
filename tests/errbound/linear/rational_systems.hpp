// Linear systems in exact rationals.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "tests/support/special_values.hpp"

namespace rational_systems {

using ::rational;
using Eigen::Index;

struct table {
    Index rows, columns;
    std::vector<rational> entries;

    table(Index n, Index m) : rows(n), columns(m), entries(std::size_t(n * m)) {}
    explicit table(const Eigen::MatrixXd& a) : table(a.rows(), a.cols()) {
        for (Index i = 0; i < rows; ++i)
            for (Index j = 0; j < columns; ++j) (*this)(i, j) = rational(a(i, j));
    }
    rational& operator()(Index i, Index j) { return entries[std::size_t(i * columns + j)]; }
    const rational& operator()(Index i, Index j) const {
        return entries[std::size_t(i * columns + j)];
    }
};

/// Replaces b with the solution, by Gauss-Jordan elimination, and returns a's determinant. If that
/// is zero, b is undefined.
inline rational eliminate(table a, table& b) {
    rational determinant = 1;
    for (Index k = 0; k < a.rows; ++k) {
        Index pivot = k;
        while (pivot < a.rows && a(pivot, k) == 0) ++pivot;
        if (pivot == a.rows) return 0;
        if (pivot != k) {
            determinant = -determinant;
            for (Index j = 0; j < a.columns; ++j) std::swap(a(k, j), a(pivot, j));
            for (Index j = 0; j < b.columns; ++j) std::swap(b(k, j), b(pivot, j));
        }
        determinant *= a(k, k);
        for (Index i = 0; i < a.rows; ++i) {
            if (i == k || a(i, k) == 0) continue;
            const rational factor = a(i, k) / a(k, k);
            for (Index j = k; j < a.columns; ++j) a(i, j) -= factor * a(k, j);
            for (Index j = 0; j < b.columns; ++j) b(i, j) -= factor * b(k, j);
        }
    }
    for (Index i = 0; i < b.rows; ++i)
        for (Index j = 0; j < b.columns; ++j) b(i, j) /= a(i, i);
    return determinant;
}

/// The solution of ax = b, or nothing if a is singular. Precondition: all numbers are finite.
inline std::optional<table> solve(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
    table x(b);
    if (eliminate(table(a), x) == 0) return std::nullopt;
    return x;
}

/// True if |value − exact| <= error, or if either is not finite.
inline bool holds(double value, double error, const rational& exact) {
    if (!std::isfinite(error) || !std::isfinite(value)) return true;
    return abs(rational(value) - exact) <= rational(error);
}

}  // namespace rational_systems
