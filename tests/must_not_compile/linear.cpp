// Matrix functions that must be rejected for tracked numbers. Each case is compiled separately,
// with its name defined.
#include <Eigen/Dense>
#include <ccd/batch.hpp>
#include <errbound/certified_solve.hpp>
#include <errbound/eigen.hpp>

const Eigen::Matrix<errbound::tracked<double>, 3, 3> a;

// The rank of a tracked matrix would be a guess.
#ifdef CASE_col_piv_householder_qr  // compares numbers whose order is not certain
const auto rank = a.colPivHouseholderQr().rank();
#endif
#ifdef CASE_full_piv_lu  // compares numbers whose order is not certain
const auto rank = a.fullPivLu().rank();
#endif

#ifdef CASE_ldlt  // compares numbers whose order is not certain
// LDLT returns the sign of a matrix.
const bool is_positive = a.ldlt().isPositive();
#endif

#ifdef CASE_ordering  // use_compare_or_by_value
// Eigen's pivots compare by value, but tracked numbers have no operator<.
const bool is_less = a(0, 0) < a(1, 1);
#endif

#ifdef CASE_float_positions  // vertex_rows takes matrices of double: copy others, by m.cast
// Positions of type float would have to be copied. Callers copy them.
const Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor> positions(2, 3);
const ccd::vertex_rows rows(positions, positions);
#endif

#ifdef CASE_floats  // certified_solve takes matrices of double
// Bounds are derived for doubles.
const auto x =
    errbound::certified_solve(Eigen::Matrix3f::Identity().eval(), Eigen::Vector3f::Ones().eval());
#endif

#ifdef CASE_sizes  // takes a square matrix and a right-hand side with as many rows
// Sizes known at compile time do not match.
const auto x = errbound::certified_solve(Eigen::Matrix3d::Identity().eval(), Eigen::Vector2d(1, 2));
#endif
