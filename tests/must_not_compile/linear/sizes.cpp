// Sizes that are known when it is compiled and do not match.
#include <errbound/certified_solve.hpp>

int main() {
    const Eigen::Matrix3d a = Eigen::Matrix3d::Identity();
    return errbound::certified_solve(a, Eigen::Vector2d(1, 2)).certified();
}
