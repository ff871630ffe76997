#include "examples/simulation/bodies/selected_inverse.hpp"

#include <algorithm>
#include <vector>

namespace simulation {
namespace {

using sparse = Eigen::SparseMatrix<double>;

/// The entries of the inverse where the unit lower factor has entries, and the diagonal.
struct selected_entries {
    const sparse& pattern;  ///< strictly below the diagonal, columns sorted
    std::vector<double> below;
    Eigen::VectorXd diagonal;

    /// Precondition: the entry is in the pattern, or i = j.
    double at(Eigen::Index i, Eigen::Index j) const {
        if (i == j) return diagonal[i];
        const auto [column, row] = std::minmax(i, j);
        const auto* first = pattern.innerIndexPtr() + pattern.outerIndexPtr()[column];
        const auto* last = pattern.innerIndexPtr() + pattern.outerIndexPtr()[column + 1];
        return below[std::size_t(std::lower_bound(first, last, row) - pattern.innerIndexPtr())];
    }
};

}  // namespace

Eigen::VectorXd diagonal_of_inverse(const Eigen::SimplicialLDLT<sparse>& factor) {
    const sparse lower = sparse(factor.matrixL()).triangularView<Eigen::StrictlyLower>();
    const Eigen::Index n = lower.rows();
    selected_entries z{lower, std::vector<double>(std::size_t(lower.nonZeros())),
                       Eigen::VectorXd(n)};
    for (Eigen::Index j = n - 1; j >= 0; --j) {
        const auto begin = lower.outerIndexPtr()[j], end = lower.outerIndexPtr()[j + 1];
        double on_diagonal = 1 / factor.vectorD()[j];
        for (auto p = begin; p < end; ++p) {
            const Eigen::Index i = lower.innerIndexPtr()[p];
            double sum = 0;
            for (auto q = begin; q < end; ++q)
                sum -= lower.valuePtr()[q] * z.at(i, lower.innerIndexPtr()[q]);
            z.below[std::size_t(p)] = sum;
            on_diagonal -= lower.valuePtr()[p] * sum;
        }
        z.diagonal[j] = on_diagonal;
    }
    return factor.permutationPinv() * z.diagonal;
}

}  // namespace simulation
