// Bounds are derived for doubles.
#include <errbound/certified_solve.hpp>

int main() {
    const Eigen::Matrix3f a = Eigen::Matrix3f::Identity();
    return errbound::certified_solve(a, Eigen::Vector3f::Ones().eval()).certified();
}
