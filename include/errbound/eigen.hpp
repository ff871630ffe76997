// Tracked scalars in Eigen's matrices and vectors (needs Eigen 3.4).
//
//   Eigen::Matrix<errbound::tracked<double>, 3, 3> m;
//   auto d = m.col(0).cross(m.col(1)).dot(m.col(2));   // d.error() bounds its rounding error
//   auto x = m.partialPivLu().solve(b);                // a bound for every entry
//
// docs/linear-algebra.md lists the operations that compile. If a matrix is nonsingular, all results
// are within their bounds, which may be infinite or NaN. Nonsingularity is not tested: check
// sign_of(m.determinant()). LLT's info() is Success only if m is certainly positive definite.
#pragma once

#include <Eigen/Core>
#include <errbound/functions.hpp>
#include <errbound/linear/decompositions.hpp>
#include <limits>

namespace errbound {

/// True if a and b are certainly equal. Only for Eigen's kernels, which skip zero factors.
template <class T, class Rule>
constexpr bool operator==(const tracked<T, Rule>& a, const tracked<T, Rule>& b) {
    return compare(a, b) == sign_type::zero;
}

}  // namespace errbound

// A wrong pivot (by_value) costs tightness, never soundness. Decompositions that would guess ranks
// or signs do not compile.
namespace Eigen {

template <class T, class Rule>
struct NumTraits<errbound::tracked<T, Rule>> : GenericNumTraits<errbound::tracked<T, Rule>> {
    using Scalar = errbound::tracked<T, Rule>;
    using Real = Scalar;
    using NonInteger = Scalar;
    using Nested = Scalar;
    using Literal = Scalar;  // literals convert, with the error of the conversion
    enum {
        IsComplex = 0,
        IsInteger = 0,
        IsSigned = 1,
        RequireInitialization = 1,
        ReadCost = 2,
        AddCost = 4,
        MulCost = 8
    };
    static Scalar epsilon() { return Scalar(NumTraits<T>::epsilon()); }
    static Scalar dummy_precision() { return Scalar(NumTraits<T>::dummy_precision()); }
    static Scalar highest() { return Scalar(NumTraits<T>::highest()); }
    static Scalar lowest() { return Scalar(NumTraits<T>::lowest()); }
    static Scalar infinity() { return Scalar(NumTraits<T>::infinity()); }
    static Scalar quiet_NaN() { return Scalar(NumTraits<T>::quiet_NaN()); }
    static int digits10() { return NumTraits<T>::digits10(); }
};

template <class T, class Rule, class BinaryOp>
struct ScalarBinaryOpTraits<errbound::tracked<T, Rule>, T, BinaryOp> {
    using ReturnType = errbound::tracked<T, Rule>;
};
template <class T, class Rule, class BinaryOp>
struct ScalarBinaryOpTraits<T, errbound::tracked<T, Rule>, BinaryOp> {
    using ReturnType = errbound::tracked<T, Rule>;
};

namespace internal {

template <class Left, class Right>
concept mixed_tracked_product = errbound::is_tracked<typename Left::Scalar>
!= errbound::is_tracked<typename Right::Scalar>;

/// Computes products of dynamic size entry by entry: Eigen's blocked kernels would convert scalars.
template <class Left, class Right>
requires mixed_tracked_product<Left, Right>
struct generic_product_impl<Left, Right, DenseShape, DenseShape, GemmProduct>
    : generic_product_impl<Left, Right, DenseShape, DenseShape, CoeffBasedProductMode> {
};
template <class Left, class Right>
requires mixed_tracked_product<Left, Right>
struct generic_product_impl<Left, Right, DenseShape, DenseShape, GemvProduct>
    : generic_product_impl<Left, Right, DenseShape, DenseShape, CoeffBasedProductMode> {
};

}  // namespace internal

}  // namespace Eigen
