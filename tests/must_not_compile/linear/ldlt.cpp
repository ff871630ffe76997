// And the sign of a matrix by LDLT.
#include <Eigen/Dense>
#include <errbound/eigen.hpp>

int main() {
    const Eigen::Matrix<errbound::tracked<double>, 3, 3> a;
    return int(a.ldlt().isPositive());
}
