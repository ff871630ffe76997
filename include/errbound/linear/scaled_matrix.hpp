// A square matrix scaled by powers of two in rows and columns, for norms at any scale.
#pragma once

#include <algorithm>
#include <errbound/linear/rounding.hpp>
#include <limits>

namespace errbound::linear {

template <int N>
using square = Eigen::Matrix<double, N, N>;
template <int N>
using vector = Eigen::Matrix<double, N, 1>;
template <int N>
using exponents = Eigen::Matrix<int, N, 1>;

inline constexpr int exponent_of_zero = (std::numeric_limits<int>::min)() / 8;  ///< sums fit an int

/// e with 2^(e−1) <= |x| < 2^e. Precondition: x is finite.
inline int exponent_of(double x) {
    return x == 0 ? exponent_of_zero : traits::exponent(x);
}

/// entries(i, j) = a(i, j)·2^−(row(i) + column(j)): exact, or with an error of at most η/2 if
/// subnormal. The largest entry of every row and column is in [1/2, 1), unless a has a zero row or
/// column.
template <int N>
struct scaled_matrix {
    square<N> entries;
    exponents<N> row, column;
    bool has_zero_row_or_column = false;

    template <class Matrix>
    explicit scaled_matrix(const Matrix& a)
        : entries(a), row(exponents<N>::Constant(a.rows(), exponent_of_zero)), column(row) {
        const Index n = a.rows();
        for (Index j = 0; j < n; ++j)
            for (Index i = 0; i < n; ++i) row(i) = (std::max)(row(i), exponent_of(entries(i, j)));
        for (Index j = 0; j < n; ++j)
            for (Index i = 0; i < n; ++i)
                if (entries(i, j) != 0)
                    column(j) = (std::max)(column(j), exponent_of(entries(i, j)) - row(i));
        for (Index i = 0; i < n; ++i)
            if (row(i) == exponent_of_zero || column(i) == exponent_of_zero)
                has_zero_row_or_column = true;
        if (has_zero_row_or_column) return;
        for (Index j = 0; j < n; ++j)
            for (Index i = 0; i < n; ++i)
                entries(i, j) = times_power_of_two(entries(i, j), -(row(i) + column(j)));
    }
};

/// b(i)·2^−(row(i) + whole), rounded in the same way; the largest is in [1/2, 1).
template <int N>
struct scaled_vector {
    vector<N> entries;
    int whole = exponent_of_zero;

    template <class Vector>
    scaled_vector(const Vector& b, const exponents<N>& row) : entries(b) {
        for (Index i = 0; i < entries.size(); ++i)
            if (entries(i) != 0) whole = (std::max)(whole, exponent_of(entries(i)) - row(i));
        for (Index i = 0; i < entries.size(); ++i)
            if (entries(i) != 0) entries(i) = times_power_of_two(entries(i), -(row(i) + whole));
    }
    bool is_zero() const { return whole == exponent_of_zero; }
};

}  // namespace errbound::linear
