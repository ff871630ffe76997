// A matrix as a range of points: of its columns or of its rows?
#include <Eigen/Core>
#include <errbound/predicate_batch.hpp>
#include <errbound/predicates.hpp>

int main() {
    const Eigen::Matrix2Xd m(2, 8);
    errbound::sign_type signs[8];
    errbound::batch_signs(errbound::orient2d, signs, m, m, m);
}
