// Tracked scalars in Eigen matrices and vectors (optional header; needs Eigen 3.4).
//
//   Eigen::Matrix<errbound::tracked<double>, 3, 3> m;
//   auto d = m.col(0).cross(m.col(1)).dot(m.col(2));   // d.error() bounds its rounding error
//   auto x = m.partialPivLu().solve(b);                // a bound for every entry
//
// Products (also with plain T, 2.0 * m), sums, dot, cross, determinant(), inverse(), PartialPivLU,
// LLT and HouseholderQR work for any size, under every rule with division. For a regular matrix all
// results are within their bounds. Regularity is not tested: check sign_of(m.determinant()), or
// LLT's info(), Success only if certainly positive definite. Entries without a bound have infinite
// or NaN errors.
#pragma once

#include <Eigen/Core>
#include <errbound/functions.hpp>
#include <errbound/linear/decompositions.hpp>
#include <limits>

namespace errbound {

/// True if a and b are certainly equal. Only this header defines it, for Eigen's kernels, which
/// skip zero factors. Numbers that are "not equal" may be equal.
template <class T, class Rule>
constexpr bool operator==(const tracked<T, Rule>& a, const tracked<T, Rule>& b) {
    return compare(a, b) == sign_type::zero;
}

}  // namespace errbound

// A wrong pivot (by_value) costs tightness, never soundness. FullPivLU, ColPivHouseholderQR, LDLT,
// isInvertible, eigenvalues and SVD do not compile: they would guess ranks or signs.
namespace Eigen {

template <class T, class Rule>
struct NumTraits<errbound::tracked<T, Rule>> : GenericNumTraits<errbound::tracked<T, Rule>> {
    using Scalar = errbound::tracked<T, Rule>;
    using Real = Scalar;
    using NonInteger = Scalar;
    using Nested = Scalar;
    using Literal = Scalar;  // other plain types carry their conversion's error
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

/// T is exact, so T and tracked numbers over T mix.
template <class T, class Rule, class BinaryOp>
struct ScalarBinaryOpTraits<errbound::tracked<T, Rule>, T, BinaryOp> {
    using ReturnType = errbound::tracked<T, Rule>;
};
template <class T, class Rule, class BinaryOp>
struct ScalarBinaryOpTraits<T, errbound::tracked<T, Rule>, BinaryOp> {
    using ReturnType = errbound::tracked<T, Rule>;
};

namespace internal {

/// True if one factor holds tracked numbers and the other one plain numbers.
template <class Left, class Right>
concept mixed_tracked_product = errbound::is_tracked<typename Left::Scalar>
!= errbound::is_tracked<typename Right::Scalar>;

/// Computes products of dynamic size entry by entry, as those of fixed size. Eigen's blocked
/// kernels would convert one scalar to the other.
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
