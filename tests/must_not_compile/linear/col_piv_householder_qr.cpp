// So would it by QR decomposition with pivots.
#include <Eigen/Dense>
#include <errbound/eigen.hpp>

int main() {
    const Eigen::Matrix<errbound::tracked<double>, 3, 3> a;
    return int(a.colPivHouseholderQr().rank());
}
