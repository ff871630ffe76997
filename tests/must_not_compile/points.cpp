// Types that must not be accepted as points. Each case is compiled separately, with its name
// defined.
#include <errbound/predicates.hpp>

#ifdef CASE_another_namespace
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

int main() {
    const survey::station s{};
    return errbound::orient2d(s, s, s) == errbound::sign_type::zero;
}
#endif

#ifdef CASE_matrix
// A point is a matrix with several rows and columns.
#include <Eigen/Core>

int main() {
    const Eigen::Matrix2d m = Eigen::Matrix2d::Zero();
    return errbound::orient2d(m, m, m) == errbound::sign_type::zero;
}
#endif

#ifdef CASE_matrix_as_range
// A matrix is passed as a range of points, which could be its columns or its rows.
#include <Eigen/Core>
#include <errbound/predicate_batch.hpp>

int main() {
    const Eigen::Matrix2Xd m(2, 8);
    errbound::sign_type signs[8];
    errbound::batch_signs(errbound::orient2d, signs, m, m, m);
}
#endif

#ifdef CASE_too_short
// Points have two coordinates instead of three.

struct point {
    double x, y;
};

int main() {
    const point p{};
    return errbound::orient3d(p, p, p, p) == errbound::sign_type::zero;
}
#endif

#ifdef CASE_too_short_span
// A span of two numbers is passed as a point of three.
#include <span>

int main() {
    const double x[2]{};
    const std::span<const double, 2> p(x);
    return errbound::orient3d(p, p, p, p) == errbound::sign_type::zero;
}
#endif

#ifdef CASE_too_short_vector
// A vector with at most two elements, whose number is known at run time, is passed as a point of
// three.
#include <Eigen/Core>

int main() {
    const Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 2, 1> v;
    return errbound::orient3d(v, v, v, v) == errbound::sign_type::zero;
}
#endif
