// Linear systems in double precision with a certified error of every entry (needs Eigen 3).
//
//   const auto x = errbound::certified_solve(a, b);      // a: n×n; b: n×m, one system a column
//   if (x.certified()) use(x.values, x.errors);          // |values − exact solution| <= errors
//   else std::puts(errbound::reason(x.status));          // for example, that a is nearly singular
//
// Entries of a and b are exact doubles. If the result is `certified`, a is nonsingular and every
// entry of the exact solution lies within its error. Rounding must be to nearest (environment.hpp).
// Bounds hold for every order of Eigen's sums, vectorised, fused or threaded, but not for
// Strassen's products.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <errbound/linear/checked_inverse.hpp>
#include <errbound/linear/residual.hpp>
#include <type_traits>
#include <utility>

namespace errbound {

enum class solve_status : std::uint8_t {
    certified,        ///< the matrix is nonsingular, and the errors hold
    nearly_singular,  ///< singular, or too close to singular for doubles to decide
    not_finite,       ///< an entry is infinite or NaN
    sizes_differ,     ///< not square, or the right-hand side has another number of rows
    out_of_range,     ///< nonsingular, but the solution or its bound is not a double
};

constexpr const char* reason(solve_status status) {
    switch (status) {
        case solve_status::certified:
            return "certified";
        case solve_status::nearly_singular:
            return "the matrix is singular, or too close to singular";
        case solve_status::not_finite:
            return "an entry is infinite or NaN";
        case solve_status::sizes_differ:
            return "the matrix is not square, or the right-hand side has another number of rows";
        case solve_status::out_of_range:
            return "the solution, or its bound, is out of the range of doubles";
    }
    return "";
}

template <int Rows, int Columns>
struct certified_solution {
    using matrix = Eigen::Matrix<double, Rows, Columns>;  ///< a column for each right-hand side

    solve_status status;  ///< `certified`, or the reason
    matrix values;        ///< NaN unless certified
    matrix errors;        ///< |values − exact solution| <= errors; infinite unless certified
    /// A certified β < 1 with |I − RA|v <= βv for some R and v > 0, which proves that A is
    /// nonsingular; infinite if none was found. If it is 1e-3, a condition number up to a thousand
    /// times larger would pass.
    double contraction;

    bool certified() const { return status == solve_status::certified; }
};

namespace linear {

/// An upper bound of |y − ỹ| with Ay = b, from an enclosure r of b − Aỹ. `step`, the computed
/// R·r.value, is off by at most γ_n|R||r| + nη (linear/rounding.hpp); r.error adds |R|·r.error.
template <int N>
vector<N> error_from_residual(const checked_inverse<N>& inverse, const enclosed_vector<N>& r,
                              const vector<N>& step) {
    const Index n = step.size();
    vector<N> t(n), z(n);
    for (Index i = 0; i < n; ++i)
        t(i) = enlarged(r.error(i) + traits::abs(r.value(i)) * relative_loss(n + 2), 3);
    const vector<N> of_t = absolute_product(inverse.approximation(), t);
    for (Index i = 0; i < n; ++i)
        z(i) = enlarged(traits::abs(step(i)) + of_t(i), n + 4) +
               static_cast<double>(n) * underflow_margin();
    return inverse.error_from(z);
}

/// Refines ỹ by residuals in twice the precision while corrections halve. Encloses y around ỹ + d,
/// with the last correction d, and rounds ỹ + d.
template <int N>
enclosed_vector<N> solve_column(const checked_inverse<N>& inverse, const vector<N>& b) {
    constexpr int enough = 20;
    const Index n = b.size();
    vector<N> y = inverse.approximation() * b, step(n);
    enclosed_vector<N> r;
    double last = traits::infinity();
    for (int k = 0;; ++k) {
        r = residual<N>(inverse.matrix(), b, y);
        step.noalias() = inverse.approximation() * r.value;
        const double relative =
            (step.array().abs() / y.cwiseAbs().cwiseMax(traits::smallest_normal()).array())
                .maxCoeff();
        if (relative <= traits::unit_roundoff() || !(relative < last / 2) || k == enough) break;
        y += step;
        last = relative;
    }
    enclosed_vector<N> rest = residual<N>(inverse.matrix(), r.value, step);
    for (Index i = 0; i < n; ++i) rest.error(i) = enlarged(rest.error(i) + r.error(i), 1);
    const vector<N> next = inverse.approximation() * rest.value;
    vector<N> error = error_from_residual<N>(inverse, rest, next);
    for (Index i = 0; i < n; ++i) {
        const with_error<double> sum = two_sum(y(i), step(i));
        y(i) = sum.value;
        error(i) = enlarged(traits::abs(sum.error) + error(i), 1);
    }
    return {y, error};
}

/// value·2^e ± error·2^e, rounded outwards.
inline with_error<double> scaled_back(double value, double error, int e) {
    const double v = times_power_of_two(value, e), bound = times_power_of_two(error, e);
    const bool exact =
        e >= 0 || (times_power_of_two(v, -e) == value && times_power_of_two(bound, -e) == error);
    return {v, exact ? bound : enlarged(bound + 2 * traits::underflow_unit(), 1)};
}

template <int Rows, int Columns, int OfRight>
inline constexpr bool may_be_equal =
    (Rows == Columns || Rows == Eigen::Dynamic || Columns == Eigen::Dynamic) &&
    (Columns == OfRight || Columns == Eigen::Dynamic || OfRight == Eigen::Dynamic) &&
    (Rows == OfRight || Rows == Eigen::Dynamic || OfRight == Eigen::Dynamic);

template <int Rows, int Columns>
certified_solution<Rows, Columns> refused(solve_status status, Index rows, Index columns,
                                          double contraction = traits::infinity()) {
    using matrix = typename certified_solution<Rows, Columns>::matrix;
    return {status, matrix::Constant(rows, columns, traits::infinity() - traits::infinity()),
            matrix::Constant(rows, columns, traits::infinity()), contraction};
}

}  // namespace linear

/// Returns the solution x of ax = b with certified errors, or the reason why there is none.
///
/// Errors are near half a unit in the last place, larger near the limit of the condition number,
/// about 2^53/√n. Beyond it, the result is nearly_singular. Scaling of rows and columns does not
/// change this limit. Cost: an LU decomposition and two products of n×n matrices, measured as 6.7
/// to 11.4 times a plain solve; a few matrix-vector products in doubled precision per column of b.
/// Memory: six n×n matrices, on the heap only if n is Eigen::Dynamic. Throws std::bad_alloc.
/// Sources: linear/checked_inverse.hpp, linear/residual.hpp.
template <class MatrixType, class RightHandSide>
auto certified_solve(const Eigen::MatrixBase<MatrixType>& a,
                     const Eigen::MatrixBase<RightHandSide>& b) {
    static_assert(std::is_same_v<typename MatrixType::Scalar, double> &&
                      std::is_same_v<typename RightHandSide::Scalar, double>,
                  "errbound: certified_solve takes matrices of double");
    static_assert(linear::may_be_equal<MatrixType::RowsAtCompileTime, MatrixType::ColsAtCompileTime,
                                       RightHandSide::RowsAtCompileTime>,
                  "errbound: certified_solve takes a square matrix and a right-hand side with as "
                  "many rows");
    constexpr int N = MatrixType::ColsAtCompileTime, M = RightHandSide::ColsAtCompileTime;
    using answer = certified_solution<N, M>;
    const auto refuse = [&](solve_status status, double contraction = linear::traits::infinity()) {
        return linear::refused<N, M>(status, a.cols(), b.cols(), contraction);
    };
    if (a.rows() != a.cols() || a.rows() != b.rows()) return refuse(solve_status::sizes_differ);
    if (a.rows() == 0)
        return answer{solve_status::certified, typename answer::matrix(0, b.cols()),
                      typename answer::matrix(0, b.cols()), 0};
    const auto& given = a.derived().eval();  // no copy if `a` is a plain matrix
    const auto& sides = b.derived().eval();
    if (!given.allFinite() || !sides.allFinite()) return refuse(solve_status::not_finite);
    linear::scaled_matrix<N> scaled(given);
    if (scaled.has_zero_row_or_column) return refuse(solve_status::nearly_singular);
    const linear::checked_inverse<N> inverse(std::move(scaled.entries));
    if (!inverse.regular()) return refuse(solve_status::nearly_singular);

    answer x{solve_status::certified, answer::matrix::Zero(a.rows(), b.cols()),
             answer::matrix::Zero(a.rows(), b.cols()), inverse.contraction()};
    for (Eigen::Index k = 0; k < b.cols(); ++k) {
        const linear::scaled_vector<N> right(sides.col(k), scaled.row);
        if (right.is_zero()) continue;  // the solution is zero too
        const linear::enclosed_vector<N> y = linear::solve_column<N>(inverse, right.entries);
        for (Eigen::Index i = 0; i < a.rows(); ++i) {
            const with_error<double> entry =
                linear::scaled_back(y.value(i), y.error(i), right.whole - scaled.column(i));
            if (!linear::traits::is_finite(entry.value) || !linear::traits::is_finite(entry.error))
                return refuse(solve_status::out_of_range, inverse.contraction());
            x.values(i, k) = entry.value;
            x.errors(i, k) = entry.error;
        }
    }
    return x;
}

}  // namespace errbound
