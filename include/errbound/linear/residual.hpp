// Residuals b − Ay, computed as if in twice the precision, with certified error bounds.
#pragma once

#include <errbound/error_free.hpp>
#include <errbound/linear/scaled_matrix.hpp>

namespace errbound::linear {

template <int N>
struct enclosed_vector {
    vector<N> value, error;  ///< |value − exact| <= error
};

/// Returns b − Ay, where entries of A and b may have errors of η/2. Infinite or NaN on overflow.
/// Each row's sum is s + Σ(e + f), with e and f the exact errors of products and sums. With
/// underflow, a product plus its error differs from the exact product by at most 5η (Ogita, Rump,
/// Oishi 2005, Section 3). The computed Σ(e + f) has an error of at most γ_(n+1)Σ(|e| + |f|); the
/// final sum is rounded once. Entries' η/2 add (1 + Σ|y_j|)η/2. Source: Dot2 of that paper, whose a
/// priori bound is n times larger.
template <int N>
enclosed_vector<N> residual(const square<N>& a, const vector<N>& b, const vector<N>& y) {
    const Index n = a.rows();
    vector<N> sum = b, correction = vector<N>::Zero(n), lost = vector<N>::Zero(n);
    for (Index j = 0; j < n; ++j) {
        const double factor = -y(j);
        const double* const column = &a.coeffRef(0, j);
        if (factor == 0) continue;
        for (Index i = 0; i < n; ++i) {
            const with_error<double> product = two_product(column[i], factor);
            const with_error<double> next = two_sum(sum(i), product.value);
            sum(i) = next.value;
            correction(i) += product.error + next.error;
            lost(i) += traits::abs(product.error) + traits::abs(next.error);
        }
    }
    const double margin = underflow_margin() * (1 + enlarged(y.cwiseAbs().sum(), n));
    enclosed_vector<N> r{sum + correction, vector<N>(n)};
    for (Index i = 0; i < n; ++i)
        r.error(i) = enlarged(traits::abs(r.value(i)) * traits::unit_roundoff() +
                                  enlarged(lost(i), n + 1) * relative_loss(n + 1),
                              4) +
                     margin;
    return r;
}

}  // namespace errbound::linear
