// Decompositions of tracked matrices, compared with exact rationals.
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <errbound/eigen.hpp>

#include "tests/errbound/linear/matrix_families.hpp"
#include "tests/errbound/linear/rational_systems.hpp"

namespace decomposition_check {

using errbound::sign_type;
using errbound::tracked;
using rational_systems::rational;
using rational_systems::table;

/// A system, and its exact solution, inverse and determinant.
struct exact_system {
    Eigen::MatrixXd a, b;
    table solution, inverse;
    rational determinant;

    exact_system(const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& right)
        : a(matrix),
          b(right),
          solution(right),
          inverse(Eigen::MatrixXd::Identity(a.rows(), a.rows())),
          determinant(eliminate(table(a), inverse)) {
        (void)eliminate(table(a), solution);
    }
    bool regular() const { return determinant != 0; }
};

template <class Number>
bool holds(const Number& x, const rational& exact) {
    return rational_systems::holds(x.value(), x.error(), exact);
}

/// Checks all entries. Returns the number of those with a finite error.
template <class Matrix>
int known(const Matrix& x, const table& exact, const char* what) {
    int count = 0;
    for (Eigen::Index i = 0; i < x.rows(); ++i)
        for (Eigen::Index j = 0; j < x.cols(); ++j) {
            EXPECT_TRUE(holds(x(i, j), exact(i, j))) << what << ' ' << i << ' ' << j;
            count += std::isfinite(x(i, j).error());
        }
    return count;
}

/// Checks LU decomposition, determinant and inverse. Returns the number of entries of the solution
/// with a finite error.
template <int N, class Rule>
int check_lu(const exact_system& s) {
    using number = tracked<double, Rule>;
    using matrix = Eigen::Matrix<number, N, N>;
    using vector = Eigen::Matrix<number, N, 1>;
    const matrix a = s.a.template cast<number>();
    const vector b = s.b.col(0).template cast<number>();
    const Eigen::Matrix<number, N, Eigen::Dynamic> sides = s.b.template cast<number>();

    const Eigen::PartialPivLU<matrix> lu(a);
    EXPECT_TRUE(holds(lu.determinant(), s.determinant));
    EXPECT_TRUE(holds(a.determinant(), s.determinant));
    const sign_type sign = sign_of(lu.determinant());
    EXPECT_TRUE(!certain(sign) || sign == sign_type(s.determinant.sign() + 1));
    if (!s.regular()) return 0;
    known(Eigen::Matrix<number, N, Eigen::Dynamic>(lu.solve(sides)), s.solution, "LU, matrix");
    known(matrix(a.inverse()), s.inverse, "inverse");
    return known(vector(lu.solve(b)), s.solution, "LU");
}

/// Checks QR decomposition. Returns the number of entries of the solution with a finite error.
template <int N, class Rule>
int check_qr(const exact_system& s) {
    using number = tracked<double, Rule>;
    const Eigen::Matrix<number, N, N> a = s.a.template cast<number>();
    const Eigen::Matrix<number, N, 1> b = s.b.col(0).template cast<number>();
    const Eigen::HouseholderQR<Eigen::Matrix<number, N, N>> qr(a);
    EXPECT_TRUE(holds(qr.absDeterminant(), abs(s.determinant)));
    if (!s.regular()) return 0;
    return known(Eigen::Matrix<number, N, 1>(qr.solve(b)), s.solution, "QR");
}

/// A system of n equations from the family, with three right-hand sides.
inline exact_system system_of(matrix_families::family f, int n, matrix_families::generator& make) {
    return {make.make(f, n),
            make.whole(0, 3) == 0 ? make.whole_numbers(n, 3, 2) : make.uniform(n, 3)};
}

}  // namespace decomposition_check
