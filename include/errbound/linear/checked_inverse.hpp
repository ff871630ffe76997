// An approximate inverse R of a matrix A, with certified bounds of I − RA. Theorem: let |I − RA|v
// <= βv for some v > 0 and β < 1. Then A and R are nonsingular. For any ỹ the solution y of Ay = b
// has, entry by entry:
//   |y − ỹ| <= z + w·max_i(z_i/v_i)/(1 − β),   z >= |R(b − Aỹ)|, w >= |I − RA|v.
// For E = I − RA, ρ(|E|) <= β < 1, so RA = I − E is nonsingular; y − ỹ = (I − E)^-1 R(b − Aỹ), and
// |(I − E)^-1|z <= Σ |E|^k z <= z + |E|Σ|E|^k z <= z + |E|v·ζ/(1 − β) with z <= ζv. Sources: Rump
// 2010 (Acta Numerica 19), Sections 10.4 to 10.6; Oishi, Rump 2002 (Numer. Math. 90), for bounds
// that need only rounding to nearest; Rump 2013 (J. Comput. Appl. Math. 242), for the choice of v.
#pragma once

#include <Eigen/LU>
#include <errbound/linear/scaled_matrix.hpp>
#include <utility>

namespace errbound::linear {

/// R and its bounds hold for the entries A of a scaled matrix, and for every matrix whose entries
/// differ from these by at most η/2.
template <int N>
class checked_inverse {
  public:
    /// Cost: LU decomposition and two matrix products, one of them for the inverse.
    explicit checked_inverse(square<N>&& a)
        : a_(std::move(a)), inverse_(a_.partialPivLu().inverse()), defect_(product_in_blocks()) {
        defect_.diagonal().array() -= 1;
        if (inverse_.allFinite() && defect_.allFinite()) choose_weights();
    }

    /// True if A is certainly nonsingular. All other members except contraction() require it.
    bool regular() const { return contraction_ < 1; }
    /// The least β found for the theorem; infinite if none was found.
    double contraction() const { return contraction_; }
    const square<N>& matrix() const { return a_; }
    const square<N>& approximation() const { return inverse_; }

    /// At least |I − RA|v, v >= 0. |I − RA| <= |I − fl(RA)| + γ_h|R||A| + nη, where h counts an
    /// entry's roundings. Errors of η/2 in entries of A add |R|(η/2) times a matrix of ones.
    vector<N> defect_times(const vector<N>& v) const {
        const Index n = a_.rows();
        const double lost = relative_loss((std::min)(n, block) + n / block + 3);
        const double margin = underflow_margin() * (1 + enlarged(v.sum(), n));
        const vector<N> of_a = absolute_product(a_, v);
        vector<N> t(n);
        for (Index i = 0; i < n; ++i) t(i) = enlarged(of_a(i), n + 3) * lost + margin;
        const vector<N> rounded = absolute_product(inverse_, t),
                        seen = absolute_product(defect_, v);
        vector<N> bound(n);
        for (Index i = 0; i < n; ++i)
            bound(i) = enlarged(seen(i) + rounded(i), 2 * n + 8) + static_cast<double>(n) * margin;
        return bound;
    }

    /// At least |y − ỹ|, from z >= |R(b − Aỹ)|. The theorem gives a first bound. Inserted on the
    /// right of |y − ỹ| <= z + |I − RA||y − ỹ|, it gives a second, and each entry is the smaller
    /// one. Infinite or NaN on overflow.
    vector<N> error_from(const vector<N>& z) const {
        const Index n = a_.rows();
        double ratio = 0;
        for (Index i = 0; i < n; ++i) {
            const double r = enlarged(z(i) / weights_(i), 1);
            if (!(r <= ratio)) ratio = r;
            if (!(r < traits::infinity())) return vector<N>::Constant(n, traits::infinity());
        }
        const double factor = enlarged(ratio / (1 - contraction_), 3);
        vector<N> bound(n);
        for (Index i = 0; i < n; ++i)
            bound(i) = enlarged(z(i) + weighted_(i) * factor, 3) + underflow_margin();
        const vector<N> again = defect_times(bound);
        for (Index i = 0; i < n; ++i)
            bound(i) = (std::min)(bound(i), enlarged(z(i) + again(i), 1) + underflow_margin());
        return bound;
    }

  private:
    /// Rounding errors grow with the size and the number of the blocks of RA.
    static constexpr Index block = 256;

    square<N> product_in_blocks() const {
        const Index n = a_.rows(), first = (std::min)(block, n);
        square<N> sum(n, n);
        sum.noalias() = inverse_.leftCols(first) * a_.topRows(first);
        if (n <= block) return sum;
        square<N> next(n, n);
        for (Index k = block; k < n; k += block) {
            const Index width = (std::min)(block, n - k);
            next.noalias() = inverse_.middleCols(k, width) * a_.middleRows(k, width);
            sum += next;
        }
        return sum;
    }

    /// Starts with v = 1. If β is not well below one, iterates v = |I − RA|v, which tends to the
    /// vector with the least β (Perron, Frobenius).
    void choose_weights() {
        const Index n = a_.rows();
        constexpr int enough = 6;
        constexpr double good = 0x1p-10;
        vector<N> v = vector<N>::Ones(n);
        for (int k = 0; k < enough && !(contraction_ < good); ++k) {
            const vector<N> w = defect_times(v);
            if (!w.allFinite()) return;
            double beta = 0;
            for (Index i = 0; i < n; ++i) beta = (std::max)(beta, enlarged(w(i) / v(i), 1));
            if (beta < contraction_) {
                contraction_ = beta;
                weights_ = v;
                weighted_ = w;
            }
            v = w / w.maxCoeff();
            for (Index i = 0; i < n; ++i) v(i) = (std::max)(v(i), 0x1p-500);
        }
    }

    square<N> a_, inverse_, defect_;
    vector<N> weights_, weighted_;  // v and w
    double contraction_ = traits::infinity();
};

}  // namespace errbound::linear
