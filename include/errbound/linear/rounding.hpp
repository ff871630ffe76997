// Rounding errors of sums of products in any order, for bounds of matrix products. In Eigen's
// kernels each product passes through at most h roundings, fused or not. Then (Higham 2002, Section
// 3.1, for any order) |computed − Σ x_i y_i| <= γ_h Σ |x_i y_i| + kη, γ_h = hu/(1 − hu), k the
// number of products. Sums do not underflow, a product's underflow is at most η/2, and its later
// growth at most 1 + γ_h < 2. For a dot product of length n, h = n.
#pragma once

#include <Eigen/Core>
#include <bit>
#include <cstdint>
#include <errbound/number_traits.hpp>

namespace errbound::linear {

using Eigen::Index;
using traits = number_traits<double>;

/// At least γ_h. Precondition: h <= 2^50, so hu and 1 − hu are exact.
inline double relative_loss(Index h) {
    const double x = static_cast<double>(h) * traits::unit_roundoff();
    return x / (1 - x) * (1 + 2 * traits::epsilon());
}

/// At least the exact value of a sum, product or quotient tree over nonnegative numbers, computed
/// as x with at most `roundings` <= 2^48 and no underflow: 1/(1 − u)^k <= (1 + 2(k + 4)u)(1 − u)³.
inline double enlarged(double x, Index roundings) {
    return x * (1 + static_cast<double>(roundings + 4) * traits::epsilon());
}

/// More than 2^51 underflows together can lose.
inline double underflow_margin() {
    return traits::smallest_normal();
}

/// |m|v for v >= 0. Its upper bound is enlarged(·, n + 1) plus n underflows, n = m.cols().
template <class Matrix, class Vector>
Vector absolute_product(const Matrix& m, const Vector& v) {
    Vector sum = Vector::Zero(m.rows());
    for (Index j = 0; j < m.cols(); ++j) sum += m.col(j).cwiseAbs() * v(j);
    return sum;
}

inline double times_power_of_two(double x, int e) {
    if (e < -1022 || e > 1023) return traits::scale(x, e);
    return x * std::bit_cast<double>(static_cast<std::uint64_t>(e + 1023) << 52);
}

}  // namespace errbound::linear
