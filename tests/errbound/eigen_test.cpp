// Tracked scalars in Eigen's matrices; Eigen's vectors, of every kind, as points.
#undef NDEBUG  // assertions check sizes that are known at run time
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <errbound/eigen.hpp>
#include <errbound/predicate_batch.hpp>
#include <errbound/predicates.hpp>
#include <errbound/rules/affine.hpp>
#include <errbound/rules/interval.hpp>
#include <errbound/rules/residual.hpp>
#include <vector>

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

/// a, b, c turn left.
const Eigen::VectorXd a = Eigen::Vector2d(0, 0), b = Eigen::Vector2d(1, 0),
                      c = Eigen::Vector2d(0, 1);

template <class... Points>
void expect_left_turn(const Points&... p) {
    EXPECT_EQ(errbound::orient2d(p...), sign_type::positive);
    for (const auto stage :
         {errbound::predicate_stage::static_filter, errbound::predicate_stage::long_integers})
        EXPECT_EQ(errbound::orient2d.by(stage, p...), sign_type::positive);
}

TEST(Eigen, VectorsArePoints) {
    const Eigen::Matrix<float, 3, 4> m = Eigen::Matrix<float, 3, 4>::Identity();
    EXPECT_EQ(errbound::orient3d(m.col(0), m.col(1), m.col(2), m.col(3)), sign_type::positive);
    expect_left_turn(Eigen::Vector2d(0, 0), Eigen::Vector2d(1, 0), Eigen::Vector2d(0, 1));
    Eigen::MatrixXd columns(2, 3);
    columns << a, b, c;
    const Eigen::MatrixXd rows = columns.transpose(), identity = Eigen::MatrixXd::Identity(2, 2);
    expect_left_turn(a, b, c);
    expect_left_turn(columns.col(0), columns.col(1), columns.col(2));
    expect_left_turn(rows.row(0), rows.row(1), rows.row(2));
    expect_left_turn(columns.block(0, 0, 2, 1), rows.block(1, 0, 1, 2), columns.rightCols(1));
    expect_left_turn(Eigen::Map<const Eigen::VectorXd>(a.data(), 2),
                     Eigen::Map<const Eigen::RowVectorXd>(b.data(), 2), c.head(2));
    expect_left_turn(a + b - b, 2 * b, c.cwiseAbs());
    expect_left_turn(identity * a, c.reverse(), c.transpose() * identity);
    expect_left_turn(a.cast<float>(), Eigen::ArrayXf(b.cast<float>()), c.array());
    expect_left_turn(Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 2, 1>(a), b, Eigen::Vector2d(c));
}

// 2^24 + 1 is no float.
template <class Rule>
void expect_plain_numbers_converted_within_their_error() {
    using scalar = errbound::tracked<float, Rule>;
    constexpr double plain = 16777217;
    const Eigen::Matrix<scalar, 2, 2> fixed = Eigen::Matrix<scalar, 2, 2>::Constant(scalar(1));
    const Eigen::Matrix<scalar, Eigen::Dynamic, Eigen::Dynamic> dynamic = fixed;
    const Eigen::Array<scalar, 2, 2> array = fixed.array();
    const auto expect_within = [](const auto& result, double truth) {
        const scalar x = result.eval()(0, 0);
        EXPECT_LE(std::abs(double(x.value()) - truth), double(x.error())) << Rule::name << truth;
        EXPECT_LE(double(x.error()), 1e-5 * std::abs(truth)) << Rule::name << truth;
    };
    expect_within(fixed * plain, plain);
    expect_within(plain * fixed, plain);
    expect_within(dynamic * plain, plain);
    expect_within(dynamic * 16777217L, plain);
    expect_within(plain * dynamic, plain);
    expect_within(dynamic / plain, 1 / plain);
    expect_within(fixed * 0.1, 0.1);
    expect_within(array + plain, plain + 1);
    expect_within(plain / array, plain);
    expect_within(dynamic * (plain * fixed), 2 * plain);
    const scalar exact = (fixed * 2.0F)(0, 0), integer = (fixed * 2)(0, 0);
    EXPECT_EQ(exact.error(), (scalar(1) * scalar(2)).error());
    EXPECT_EQ(integer.error(), exact.error());
}

// (1 2; 3 4)(5 6; 7 8) = (19 22; 43 50); either factor is plain, and sizes are known at run time.
TEST(Eigen, MixedProductsOfDynamicSize) {
    Eigen::MatrixXd a(2, 2), b(2, 2), both(2, 2);
    a << 1, 2, 3, 4;
    b << 5, 6, 7, 8;
    both << 19, 22, 43, 50;
    const Eigen::MatrixX<number> tracked_a = a.cast<number>(), tracked_b = b.cast<number>();
    const Eigen::MatrixX<number> right = tracked_a * b, left = a * tracked_b;
    Eigen::MatrixX<number> sum = Eigen::MatrixX<number>::Ones(2, 2);
    sum.noalias() += tracked_a.transpose() * Eigen::MatrixXd(a.transpose());
    const Eigen::VectorX<number> image = tracked_a * Eigen::VectorXd(b.col(0));
    const Eigen::VectorX<number> row = Eigen::RowVectorXd(a.row(0)) * tracked_b;
    for (int i = 0; i < 2; ++i) {
        for (int j = 0; j < 2; ++j) {
            EXPECT_EQ(right(i, j).value(), both(i, j));
            EXPECT_EQ(left(i, j).value(), both(i, j));
            EXPECT_EQ(sum(i, j).value(), (a.transpose() * a.transpose())(i, j) + 1);
        }
        EXPECT_EQ(image(i).value(), both(i, 0));
        EXPECT_EQ(row(i).value(), both(0, i));
    }
    // The sum of 30 terms 0.1·x, where x has the error 1e-3.
    const Eigen::MatrixX<number> known =
        Eigen::MatrixX<number>::Constant(30, 30, number::within(1, 1e-3));
    const Eigen::MatrixX<number> tenths = Eigen::MatrixXd::Constant(30, 30, 0.1) * known;
    EXPECT_GE(tenths(29, 29).error(), 2.99e-3);
    EXPECT_LE(tenths(29, 29).error(), 3.01e-3);
}

TEST(Eigen, PlainNumbersOfOtherTypesHaveTheErrorOfTheirConversion) {
    expect_plain_numbers_converted_within_their_error<errbound::tight>();
    expect_plain_numbers_converted_within_their_error<errbound::residual>();
    expect_plain_numbers_converted_within_their_error<errbound::interval>();
    expect_plain_numbers_converted_within_their_error<errbound::affine>();
}

TEST(Eigen, VectorsOfASizeKnownAtRunTimeMakeBatches) {
    const std::vector<Eigen::VectorXd> list(100, c);
    const Eigen::MatrixXd columns = c.replicate(1, 100), rows = columns.transpose();
    const errbound::every<Eigen::VectorXd> from{a}, to{b};
    const std::vector<sign_type> left(100, sign_type::positive);
    std::vector<sign_type> signs(100);
    const auto expect_left = [&](const auto& points) {
        errbound::batch_signs(errbound::orient2d, signs, from, to, points);
        EXPECT_EQ(signs, left);
        signs.assign(100, sign_type::uncertain);
    };
    expect_left(list);
    expect_left(columns.colwise());
    expect_left(rows.rowwise());
}

TEST(Eigen, PointsAndBatchesThatAreTooShortFailAssertions) {
    constexpr const char* message = "fewer coordinates than the predicate's shape";
    const Eigen::VectorXd one = Eigen::VectorXd::Zero(1);
    EXPECT_DEATH((void)errbound::orient2d(a, b, one), message);
    EXPECT_DEATH((void)errbound::orient2d(a, std::vector<double>{1}, c), message);
    EXPECT_DEATH((void)errbound::orient2d(a, std::span<const double>(b.data(), 1), c), message);
    const Eigen::MatrixXd square = Eigen::MatrixXd::Zero(2, 2);
    EXPECT_DEATH((void)errbound::orient2d(a, b, square.block(0, 0, 2, 2)),
                 "a point only if it is a row or a column");
    std::vector<sign_type> signs(3);
    EXPECT_DEATH(errbound::batch_signs(errbound::orient2d, signs, square.colwise(),
                                       square.colwise(), square.colwise()),
                 "a range has fewer points than there are signs");
}

}  // namespace
