// LU decomposition of tracked matrices under the other rules with division.
#include <gtest/gtest.h>

#include <Eigen/LU>

#include "tests/errbound/linear/decomposition_check.hpp"
#include "tests/support/scaled.hpp"

namespace {

using namespace decomposition_check;

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

}  // namespace
