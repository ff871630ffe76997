// The rank of a tracked matrix would be a guess.
#include <Eigen/Dense>
#include <errbound/eigen.hpp>

int main() {
    const Eigen::Matrix<errbound::tracked<double>, 3, 3> a;
    return int(a.fullPivLu().rank());
}
