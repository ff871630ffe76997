// Tracked scalars in Eigen matrices and vectors (optional header; needs Eigen 3).
//
//   Eigen::Matrix<errbound::tracked<double>, 3, 3> m;
//   auto d = m.col(0).cross(m.col(1)).dot(m.col(2));   // d.error() bounds its rounding error
//
// Products, sums, dot, cross, determinants and inverses of small fixed-size matrices work, and so
// do products with plain T (2.0 * m). What must compare magnitudes to choose a pivot
// (decompositions, dynamic-size inverse) does not compile: a tracked number has no operator<.
#pragma once

#include <Eigen/Core>
#include <errbound/tracked.hpp>

namespace Eigen {

template <class T, class Rule>
struct NumTraits<errbound::tracked<T, Rule>> : GenericNumTraits<errbound::tracked<T, Rule>> {
    using Scalar = errbound::tracked<T, Rule>;
    using Real = Scalar;
    using NonInteger = Scalar;
    using Nested = Scalar;
    using Literal = T;
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
    static int digits10() { return NumTraits<T>::digits10(); }
};

/// T and tracked numbers over T mix: T is exact.
template <class T, class Rule, class BinaryOp>
struct ScalarBinaryOpTraits<errbound::tracked<T, Rule>, T, BinaryOp> {
    using ReturnType = errbound::tracked<T, Rule>;
};
template <class T, class Rule, class BinaryOp>
struct ScalarBinaryOpTraits<T, errbound::tracked<T, Rule>, BinaryOp> {
    using ReturnType = errbound::tracked<T, Rule>;
};

}  // namespace Eigen
