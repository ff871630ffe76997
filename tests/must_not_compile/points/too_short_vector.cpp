// A vector of at most two elements, how many is known when the program runs, as a point of three.
#include <Eigen/Core>
#include <errbound/predicates.hpp>

int main() {
    const Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 2, 1> v;
    return errbound::orient3d(v, v, v, v) == errbound::sign_type::zero;
}
