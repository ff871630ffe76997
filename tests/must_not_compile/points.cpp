// Types that must not be taken for points. Each case is compiled alone, with its name defined.
#include <errbound/predicates.hpp>

#ifdef CASE_another_namespace
// coordinate_of is not in the namespace of the point's type, so that nobody finds it.

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
// A matrix that is neither a row nor a column as a point.
#include <Eigen/Core>

int main() {
    const Eigen::Matrix2d m = Eigen::Matrix2d::Zero();
    return errbound::orient2d(m, m, m) == errbound::sign_type::zero;
}
#endif

#ifdef CASE_matrix_as_range
// A matrix as a range of points: of its columns or of its rows?
#include <Eigen/Core>
#include <errbound/predicate_batch.hpp>

int main() {
    const Eigen::Matrix2Xd m(2, 8);
    errbound::sign_type signs[8];
    errbound::batch_signs(errbound::orient2d, signs, m, m, m);
}
#endif

#ifdef CASE_too_short
// Points of two coordinates where three are asked for.

struct point {
    double x, y;
};

int main() {
    const point p{};
    return errbound::orient3d(p, p, p, p) == errbound::sign_type::zero;
}
#endif

#ifdef CASE_too_short_span
// A span of two numbers as a point of three.
#include <span>

int main() {
    const double x[2]{};
    const std::span<const double, 2> p(x);
    return errbound::orient3d(p, p, p, p) == errbound::sign_type::zero;
}
#endif

#ifdef CASE_too_short_vector
// A vector of at most two elements, how many is known when the program runs, as a point of three.
#include <Eigen/Core>

int main() {
    const Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 2, 1> v;
    return errbound::orient3d(v, v, v, v) == errbound::sign_type::zero;
}
#endif
