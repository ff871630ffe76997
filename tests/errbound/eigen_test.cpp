// Tracked scalars inside Eigen's matrices.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <errbound/eigen.hpp>
#include <errbound/predicates.hpp>

namespace {

using errbound::sign_type;
using number = errbound::tracked<double>;

TEST(Eigen, MatricesOfTrackedScalars) {
    Eigen::Matrix<number, 3, 3> m;
    m << 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 10.0;
    const number by_columns = m.col(0).cross(m.col(1)).dot(m.col(2));
    const number determinant = m.determinant();
    EXPECT_EQ(by_columns.value(), -3);
    EXPECT_EQ(determinant.value(), -3);
    EXPECT_GT(determinant.error(), 0);
    EXPECT_EQ(sign_of(determinant), sign_type::negative);
    const Eigen::Matrix<number, 3, 3> square = m * m - m.transpose();
    EXPECT_EQ(square(0, 0).value(), 1 + 8 + 21 - 1);
    const Eigen::Matrix<number, 3, 3> doubled = 2.0 * m;
    EXPECT_EQ(doubled(2, 2).value(), 20);
    const Eigen::Matrix<number, 3, 1> image = m * Eigen::Vector3d(1, 0, -1);
    EXPECT_EQ(image(0).value(), -2);
    EXPECT_EQ(sign_of((m * m.inverse())(0, 0)), sign_type::positive);
    Eigen::Matrix<number, Eigen::Dynamic, 1> v = Eigen::Matrix<number, Eigen::Dynamic, 1>::Ones(5);
    EXPECT_EQ(v.sum().value(), 5);
    EXPECT_LT(v.sum().error(), 1e-14);
}

TEST(Eigen, VectorsArePoints) {
    const Eigen::Vector2d a(0, 0), b(1, 0), c(0, 1);
    EXPECT_EQ(errbound::orient2d(a, b, c), sign_type::positive);
    const Eigen::Matrix<float, 3, 4> m = Eigen::Matrix<float, 3, 4>::Identity();
    EXPECT_EQ(errbound::orient3d(m.col(0), m.col(1), m.col(2), m.col(3)), sign_type::positive);
}

}  // namespace
