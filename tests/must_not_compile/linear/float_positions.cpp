// Positions of float would be copied: their copy is the caller's.
#include <Eigen/Core>
#include <ccd/batch.hpp>

int main() {
    const Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor> positions(2, 3);
    return static_cast<int>(ccd::vertex_rows(positions, positions).vertices);
}
