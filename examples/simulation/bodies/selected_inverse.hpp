// The diagonal of a sparse matrix's inverse, from its factors, without the rest of the inverse.
#pragma once

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

namespace simulation {

/// Of the matrix that was factorised, in its own order. Entries of the inverse are computed where
/// the factor has entries, from the last column on, since those need no others. Source: Takahashi,
/// Fagan, Chin, Formation of a sparse bus impedance matrix and its application to short circuit
/// study, 1973. Cost: as the factorisation, up to a logarithm.
Eigen::VectorXd diagonal_of_inverse(
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>& factor);

}  // namespace simulation
