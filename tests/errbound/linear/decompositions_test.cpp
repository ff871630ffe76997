// Eigen's decompositions of tracked matrices, compared with exact rationals; orders and limits of
// numbers.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <errbound/eigen.hpp>
#include <limits>
#include <vector>

#include "tests/errbound/linear/matrix_families.hpp"
#include "tests/errbound/linear/rational_systems.hpp"
#include "tests/support/scaled.hpp"

namespace {

using errbound::sign_type;
using errbound::tracked;
using matrix_families::family;
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
exact_system system_of(matrix_families::family f, int n, matrix_families::generator& make) {
    return {make.make(f, n),
            make.whole(0, 3) == 0 ? make.whole_numbers(n, 3, 2) : make.uniform(n, 3)};
}

/// True if exact elimination of 30 unknowns takes well under a second.
bool quick_in_rationals(family f) {
    return f == family::uniform || f == family::small_integers || f == family::unimodular ||
           f == family::nearly_dependent || f == family::tridiagonal;
}

TEST(Decompositions, HoldAtFixedSizes) {
    matrix_families::generator make(1);
    for (const family f : matrix_families::all) {
        SCOPED_TRACE(matrix_families::names[int(f)]);
        for (int k = 0; k < support::scaled(10); ++k) {
            const exact_system s = system_of(f, 5, make);
            check_lu<5, errbound::tight>(s);
            check_qr<5, errbound::tight>(s);
        }
    }
}

TEST(Decompositions, HoldAtAnySize) {
    matrix_families::generator make(2);
    int unknowns = 0, by_lu = 0, by_qr = 0;
    for (const family f : matrix_families::all) {
        SCOPED_TRACE(matrix_families::names[int(f)]);
        for (const int n : {1, 2, 3, 4, 5, 6, 8, 12, 30})
            for (int k = 0; k < support::scaled(n > 8 ? 1 : 6); ++k) {
                if (n > 8 && !quick_in_rationals(f)) break;
                const exact_system s = system_of(f, n, make);
                unknowns += n;
                by_lu += check_lu<Eigen::Dynamic, errbound::tight>(s);
                by_qr += check_qr<Eigen::Dynamic, errbound::tight>(s);
            }
    }
    EXPECT_GT(3 * by_lu, unknowns);
    EXPECT_GT(3 * by_qr, unknowns);
}

template <class Rule>
class DecompositionsBy : public testing::Test {};
using Rules = testing::Types<errbound::sharp, errbound::interval, errbound::residual>;
TYPED_TEST_SUITE(DecompositionsBy, Rules);

TYPED_TEST(DecompositionsBy, Hold) {
    matrix_families::generator make(1);
    int unknowns = 0, all = 0;
    for (const auto f : matrix_families::all) {
        SCOPED_TRACE(matrix_families::names[int(f)]);
        for (const int n : {1, 2, 3, 5, 8})
            for (int k = 0; k < support::scaled(5); ++k) {
                all += check_lu<Eigen::Dynamic, TypeParam>(system_of(f, n, make));
                unknowns += n;
            }
    }
    EXPECT_GT(3 * all, unknowns);
}

TEST(DecompositionsByNone, AreThoseOfPlainNumbers) {
    using number = tracked<double, errbound::none>;
    matrix_families::generator make(2);
    const Eigen::Matrix3d a = make.uniform(3, 3);
    const Eigen::Matrix<number, 3, 3> same = a.cast<number>();
    const double determinant = a.determinant();
    EXPECT_NEAR(same.determinant().value(), determinant, 1e-15);
}

/// Pivots that are zero, that may be zero, and that are not numbers.
TEST(Decompositions, WithPivotsThatMayBeZero) {
    using number = tracked<double>;
    Eigen::MatrixX<number> a(2, 2);
    const Eigen::VectorX<number> b = Eigen::VectorX<number>::Ones(2);
    for (const number& x : {number::within(0, 1e-300), number::within(1e-20, 1e-19),
                            number(std::numeric_limits<double>::quiet_NaN()),
                            number::within(0, std::numeric_limits<double>::infinity())}) {
        a << x, number(1), x, number(2);
        EXPECT_FALSE(certain(sign_of(a.determinant())));
        EXPECT_FALSE(std::isfinite(Eigen::VectorX<number>(a.partialPivLu().solve(b))(0).error()));
        EXPECT_FALSE(std::isfinite(Eigen::VectorX<number>(a.householderQr().solve(b))(0).error()));
    }
    a << 0.0, 1.0, 0.0, 2.0;
    EXPECT_EQ(sign_of(a.determinant()), sign_type::zero);
}

template <class Rule, int UpLo>
void check_cholesky(const exact_system& s, bool definite, int& proved) {
    using number = tracked<double, Rule>;
    const Eigen::MatrixX<number> a = s.a.template cast<number>();
    const Eigen::LLT<Eigen::MatrixX<number>, UpLo> llt(a);
    EXPECT_TRUE(definite || llt.info() != Eigen::Success);
    proved += llt.info() == Eigen::Success;
    if (!s.regular()) return;
    known(Eigen::VectorX<number>(llt.solve(s.b.template cast<number>())), s.solution, "LLT");
}

/// Tests the signs of the leading minors.
bool positive_definite(const Eigen::MatrixXd& a) {
    for (Eigen::Index n = 1; n <= a.rows(); ++n) {
        table none(n, 0);
        if (eliminate(table(a.topLeftCorner(n, n)), none) <= 0) return false;
    }
    return true;
}

TEST(Decompositions, CholeskyProvesThatMatricesArePositiveDefinite) {
    matrix_families::generator make(4);
    int tried = 0, proved = 0;
    for (const int n : {1, 2, 3, 5, 8})
        for (int k = 0; k < support::scaled(20); ++k) {
            const Eigen::MatrixXd factor = make.whole_numbers(n, n, 3),
                                  whole = make.whole_numbers(n, n, 2);
            Eigen::MatrixXd a = factor * factor.transpose();
            if (k % 2 == 0) a += whole + whole.transpose();
            if (k % 5 == 0) a *= std::ldexp(1.0, make.whole(-1070, 900));
            const exact_system s(a, make.uniform(n, 1));
            const bool definite = positive_definite(a);
            check_cholesky<errbound::tight, Eigen::Lower>(s, definite, proved);
            check_cholesky<errbound::tight, Eigen::Upper>(s, definite, proved);
            tried += 2;
        }
    EXPECT_GT(10 * proved, tried);
}

TEST(Decompositions, HouseholderFactors) {
    using number = tracked<double>;
    Eigen::MatrixX<number> a(2, 2);
    a << 3.0, 1.0, 4.0, 2.0;  // R = (-5, -2.2; 0, -0.4)
    const Eigen::HouseholderQR<Eigen::MatrixX<number>> qr(a);
    const Eigen::MatrixX<number> q = qr.householderQ(), r = qr.matrixQR();
    EXPECT_TRUE(holds(r(0, 0), -5));
    EXPECT_TRUE(holds(r(0, 1), rational(-11) / 5));
    EXPECT_TRUE(holds(q(0, 0), rational(-3) / 5));
    EXPECT_TRUE(holds(q(1, 0), rational(-4) / 5));
    EXPECT_LT(q(1, 0).error(), 1e-14);
    a *= number(0x1p-1000);  // squares underflow
    const number tiny = Eigen::HouseholderQR<Eigen::MatrixX<number>>(a).matrixQR()(0, 0);
    EXPECT_TRUE(holds(tiny, rational(-5) * rational(0x1p-1000)));
    EXPECT_LT(tiny.error(), 0x1p-1040);
}

TEST(ByValue, SortsNumbersWhoseOrderIsUncertain) {
    using number = tracked<double>;
    const double nan = std::numeric_limits<double>::quiet_NaN();
    std::vector<number> numbers{nan, number::within(2, 5), 3, nan, number::within(1, 9)};
    std::sort(numbers.begin(), numbers.end(), errbound::by_value{});
    EXPECT_EQ(numbers[0].value(), 1);
    EXPECT_EQ(numbers[1].value(), 2);
    EXPECT_EQ(numbers[2].value(), 3);
}

TEST(NumericLimits, AreThoseOfTheNumberType) {
    using limits = std::numeric_limits<tracked<float>>;
    static_assert(limits::is_specialized && limits::digits == 24 && !limits::is_iec559);
    EXPECT_EQ(limits::max().value(), std::numeric_limits<float>::max());
    EXPECT_EQ(limits::epsilon().error(), 0);
    EXPECT_FALSE(certain(sign_of(limits::quiet_NaN())));
    EXPECT_EQ(Eigen::NumTraits<tracked<double>>::highest().value(),
              std::numeric_limits<double>::max());
}

}  // namespace
