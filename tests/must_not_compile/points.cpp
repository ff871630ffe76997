// Types that must not be accepted as points. Each case is compiled separately, with its name
// defined.
#include <errbound/predicates.hpp>

#ifdef CASE_another_namespace  // coordinate_of.point, i. in the namespace of the point's type
// coordinate_of is not in the namespace of the point's type, so argument-dependent lookup does not
// find it.
namespace survey {
struct station {
    double easting, northing;
};
}  // namespace survey
constexpr double coordinate_of(const survey::station& s, int i) {
    return i == 0 ? s.easting : s.northing;
}
const survey::station s{};
const auto sign = errbound::orient2d(s, s, s);
#endif

#ifdef CASE_matrix  // if it is a row or a column: write m.col
// A point is a matrix with several rows and columns.
#include <Eigen/Core>

const Eigen::Matrix2d m = Eigen::Matrix2d::Zero();
const auto sign = errbound::orient2d(m, m, m);
#endif

#ifdef CASE_matrix_as_range  // a matrix is not a range of points: write m.colwise
// A matrix is passed as a range of points, which could be its columns or its rows.
#include <Eigen/Core>
#include <errbound/predicate_batch.hpp>

void find_signs(const Eigen::Matrix2Xd& m, errbound::sign_type* signs) {
    errbound::batch_signs(errbound::orient2d, std::span(signs, 8), m, m, m);
}
#endif

#ifdef CASE_too_short  // fewer coordinates than the predicate's shape
// Points have two coordinates instead of three.
struct point {
    double x, y;
};
const point p{};
const auto sign = errbound::orient3d(p, p, p, p);
#endif

#ifdef CASE_too_short_span  // fewer coordinates than the predicate's shape
// A span of two numbers is passed as a point of three.
#include <span>

const double x[2]{};
const std::span<const double, 2> p(x);
const auto sign = errbound::orient3d(p, p, p, p);
#endif

#ifdef CASE_too_short_vector  // fewer coordinates than the predicate's shape
// A vector with at most two elements, whose number is known at run time, is passed as a point of
// three.
#include <Eigen/Core>

const Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 2, 1> v;
const auto sign = errbound::orient3d(v, v, v, v);
#endif
