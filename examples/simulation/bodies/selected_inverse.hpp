#pragma once

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

namespace simulation {

/// Returns the diagonal in the order of the factorised matrix. Entries of the inverse are computed
/// only where the factor has entries, from the last column on, since these need no others. Source:
/// Takahashi, Fagan, Chin, Formation of a sparse bus impedance matrix and its application to short
/// circuit study, 1973. Cost: that of the factorisation, up to a logarithm.
Eigen::VectorXd diagonal_of_inverse(
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>& factor);

}  // namespace simulation
