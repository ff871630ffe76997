// Eigen's decompositions for tracked scalars. Soundness for any pivots: if no exact pivot is zero,
// all numbers are exact elimination's, rounded and tracked. If a pivot may be zero, quotients by it
// have infinite errors. Finite results do not depend on such a quotient, or multiply it by an exact
// zero. So they hold for a slightly moved pivot and, by continuity, for the matrix, if it is
// nonsingular.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/QR>
#include <errbound/functions.hpp>
#include <type_traits>

namespace errbound::linear {

/// The size of a pivot's value; zero only for an exact zero, because elimination skips columns of
/// score 0.
template <class T, class Rule>
T pivot_score(const tracked<T, Rule>& x) {
    using scalar_traits = number_traits<T>;
    const T size = scalar_traits::abs(x.value());
    if (size > 0 || sign_of(x) == sign_type::zero) return size;
    return scalar_traits::underflow_unit();
}

/// The reflection H = I − τww', w = (1, essential), Hx = (β, 0, ..., 0).
template <class Number>
struct reflection {
    Number tau, beta;
};

/// Overwrites x's entries, except the first, with `essential`; H = I if these are certainly zero.
/// Scales against overflow and underflow. Source: Golub and Van Loan 2013, Algorithm 5.1.1.
template <class Vector>
reflection<typename Vector::Scalar> reflect_in_place(Vector x) {
    using number = typename Vector::Scalar;
    using scalar_traits = number_traits<typename number::value_type>;
    typename number::value_type greatest(0);
    bool moves = false;
    for (Eigen::Index i = 0; i < x.size(); ++i) {
        greatest = (scalar_traits::max)(greatest, scalar_traits::abs(x(i).value()));
        moves = moves || (i > 0 && sign_of(x(i)) != sign_type::zero);
    }
    if (!moves) return {number(0), x(0)};
    const int e =
        greatest > 0 && scalar_traits::is_finite(greatest) ? scalar_traits::exponent(greatest) : 0;
    for (Eigen::Index i = 0; i < x.size(); ++i) x(i) = scale(x(i), -e);
    const number norm = sqrt(number(x.squaredNorm()));
    const number beta = x(0).value() >= 0 ? -norm : norm, distance = x(0) - beta;
    const number tau = -distance / beta;
    for (Eigen::Index i = 1; i < x.size(); ++i) x(i) /= distance;
    return {tau, scale(beta, e)};
}

/// a = LL' in place, by columns; the upper triangle is kept. True if all pivots are certainly
/// positive: the lower triangle's symmetric matrix is then positive definite.
template <class Matrix>
bool cholesky_in_place(Matrix a) {
    using number = typename Matrix::Scalar;
    bool positive = true;
    for (Eigen::Index k = 0; k < a.rows(); ++k) {
        const Eigen::Index below = a.rows() - k - 1;
        const number pivot = a(k, k) - number(a.row(k).head(k).squaredNorm());
        positive = positive && sign_of(pivot) == sign_type::positive;
        a(k, k) = sqrt(pivot);
        if (k > 0)
            a.col(k).tail(below) -=
                a.bottomLeftCorner(below, k).lazyProduct(a.row(k).head(k).transpose());
        for (Eigen::Index i = k + 1; i < a.rows(); ++i) a(i, k) /= a(k, k);
    }
    return positive;
}

template <class T>
struct guessing_decomposition {
    static_assert(sizeof(T) == 0,
                  "errbound: this decomposition compares numbers whose order is not certain, to "
                  "decide a rank or a sign; use PartialPivLU, LLT or HouseholderQR");
};

}  // namespace errbound::linear

namespace Eigen {

namespace internal {

template <class T, class Rule>
struct scalar_score_coeff_op<errbound::tracked<T, Rule>> {
    using result_type = T;
    T operator()(const errbound::tracked<T, Rule>& x) const {
        return errbound::linear::pivot_score(x);
    }
};

/// Eigen's version treats a small nonzero tail as zero.
template <class MatrixQR, class Coefficients, class T, class Rule, bool InnerStrideIsOne>
struct householder_qr_inplace_blocked<MatrixQR, Coefficients, errbound::tracked<T, Rule>,
                                      InnerStrideIsOne> {
    static void run(MatrixQR& a, Coefficients& coefficients, Index /*block*/,
                    errbound::tracked<T, Rule>* workspace) {
        for (Index k = 0; k < coefficients.size(); ++k) {
            const Index rows = a.rows() - k, columns = a.cols() - k - 1;
            const auto h = errbound::linear::reflect_in_place(a.col(k).tail(rows));
            coefficients(k) = h.tau;
            a(k, k) = h.beta;
            a.bottomRightCorner(rows, columns)
                .applyHouseholderOnTheLeft(a.col(k).tail(rows - 1), h.tau, workspace + k + 1);
        }
    }
};

}  // namespace internal

/// Eigen's version stops at a pivot whose value is not positive, without a factor.
template <class T, class Rule, int Rows, int Columns, int Options, int MaxRows, int MaxColumns,
          int UpLo_>
class LLT<Matrix<errbound::tracked<T, Rule>, Rows, Columns, Options, MaxRows, MaxColumns>, UpLo_>
    : public SolverBase<LLT<
          Matrix<errbound::tracked<T, Rule>, Rows, Columns, Options, MaxRows, MaxColumns>, UpLo_>> {
  public:
    using MatrixType =
        Matrix<errbound::tracked<T, Rule>, Rows, Columns, Options, MaxRows, MaxColumns>;
    using Base = SolverBase<LLT>;
    friend class SolverBase<LLT>;
    EIGEN_GENERIC_PUBLIC_INTERFACE(LLT)
    using Traits = internal::LLT_Traits<MatrixType, UpLo_>;

    LLT() = default;
    explicit LLT(Index size) : m_matrix(size, size) {}
    template <class Input>
    explicit LLT(const EigenBase<Input>& a) {
        compute(a.derived());
    }
    template <class Input>
    LLT& compute(const EigenBase<Input>& a) {
        m_matrix = a.derived();
        eigen_assert(m_matrix.rows() == m_matrix.cols());
        bool positive = false;
        if constexpr (UpLo_ == Lower)
            positive = errbound::linear::cholesky_in_place(m_matrix.topRows(m_matrix.rows()));
        else
            positive = errbound::linear::cholesky_in_place(m_matrix.transpose());
        m_info = positive ? Success : NumericalIssue;
        m_isInitialized = true;
        return *this;
    }

    typename Traits::MatrixL matrixL() const { return Traits::getL(m_matrix); }
    typename Traits::MatrixU matrixU() const { return Traits::getU(m_matrix); }
    const MatrixType& matrixLLT() const { return m_matrix; }
    MatrixType reconstructedMatrix() const {
        return matrixL() * matrixL().adjoint().toDenseMatrix();
    }
    /// Success: certainly positive definite. NumericalIssue: possibly not.
    ComputationInfo info() const { return m_info; }
    const LLT& adjoint() const { return *this; }
    Index rows() const { return m_matrix.rows(); }
    Index cols() const { return m_matrix.cols(); }

    template <class Derived>
    void solveInPlace(const MatrixBase<Derived>& b) const {
        matrixL().solveInPlace(b);
        matrixU().solveInPlace(b);
    }
    template <class Right, class Result>
    void _solve_impl(const Right& b, Result& x) const {
        x = b;
        solveInPlace(x);
    }
    template <bool, class Right, class Result>
    void _solve_impl_transposed(const Right& b, Result& x) const {
        _solve_impl(b, x);
    }

  private:
    MatrixType m_matrix;
    bool m_isInitialized = false;  // SolverBase uses this name
    ComputationInfo m_info = InvalidInput;
};

template <class T, class Rule, int... Sizes>
class FullPivLU<Matrix<errbound::tracked<T, Rule>, Sizes...>>
    : errbound::linear::guessing_decomposition<T> {};
template <class T, class Rule, int... Sizes>
class ColPivHouseholderQR<Matrix<errbound::tracked<T, Rule>, Sizes...>>
    : errbound::linear::guessing_decomposition<T> {};
template <class T, class Rule, int... Sizes>
class FullPivHouseholderQR<Matrix<errbound::tracked<T, Rule>, Sizes...>>
    : errbound::linear::guessing_decomposition<T> {};
template <class T, class Rule, int... Sizes>
class CompleteOrthogonalDecomposition<Matrix<errbound::tracked<T, Rule>, Sizes...>>
    : errbound::linear::guessing_decomposition<T> {};
template <class T, class Rule, int UpLo, int... Sizes>
class LDLT<Matrix<errbound::tracked<T, Rule>, Sizes...>, UpLo>
    : errbound::linear::guessing_decomposition<T> {};

}  // namespace Eigen
