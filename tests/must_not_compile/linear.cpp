// Matrix functions that must be rejected for tracked numbers. Each case is compiled separately,
// with its name defined.

#ifdef CASE_col_piv_householder_qr
// The rank of a tracked matrix would be a guess, also by QR decomposition with pivots.
#include <Eigen/Dense>
#include <errbound/eigen.hpp>

int main() {
    const Eigen::Matrix<errbound::tracked<double>, 3, 3> a;
    return int(a.colPivHouseholderQr().rank());
}
#endif

#ifdef CASE_float_positions
// Positions of type float would have to be copied. Callers copy them.
#include <Eigen/Core>
#include <ccd/batch.hpp>

int main() {
    const Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor> positions(2, 3);
    return static_cast<int>(ccd::vertex_rows(positions, positions).vertices);
}
#endif

#ifdef CASE_floats
// Bounds are derived for doubles.
#include <errbound/certified_solve.hpp>

int main() {
    const Eigen::Matrix3f a = Eigen::Matrix3f::Identity();
    return errbound::certified_solve(a, Eigen::Vector3f::Ones().eval()).certified();
}
#endif

#ifdef CASE_full_piv_lu
// The rank of a tracked matrix would be a guess.
#include <Eigen/Dense>
#include <errbound/eigen.hpp>

int main() {
    const Eigen::Matrix<errbound::tracked<double>, 3, 3> a;
    return int(a.fullPivLu().rank());
}
#endif

#ifdef CASE_ldlt
// LDLT returns the sign of a matrix.
#include <Eigen/Dense>
#include <errbound/eigen.hpp>

int main() {
    const Eigen::Matrix<errbound::tracked<double>, 3, 3> a;
    return int(a.ldlt().isPositive());
}
#endif

#ifdef CASE_ordering
// Eigen's pivots compare by value, but tracked numbers have no operator<.
#include <errbound/eigen.hpp>

int main() {
    const errbound::tracked<double> a = 1.0, b = 3.0;
    return a < b;
}
#endif

#ifdef CASE_sizes
// Sizes known at compile time do not match.
#include <errbound/certified_solve.hpp>

int main() {
    const Eigen::Matrix3d a = Eigen::Matrix3d::Identity();
    return errbound::certified_solve(a, Eigen::Vector2d(1, 2)).certified();
}
#endif
