// A matrix that is neither a row nor a column as a point.
#include <Eigen/Core>
#include <errbound/predicates.hpp>

int main() {
    const Eigen::Matrix2d m = Eigen::Matrix2d::Zero();
    return errbound::orient2d(m, m, m) == errbound::sign_type::zero;
}
