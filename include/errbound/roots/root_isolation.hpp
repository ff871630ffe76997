// Real roots of integer polynomials, exactly: isolation, refinement, signs of other polynomials at
// roots. The exact stage of real_roots.hpp. Allocates; degree and coefficient size bound time and
// memory. Bounded stack: no recursion.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <errbound/roots/descartes_search.hpp>
#include <errbound/roots/integer_polynomial.hpp>
#include <limits>
#include <utility>
#include <vector>

namespace errbound::roots {

/// A bound of Kioustelidis (1986): no root of p is at or above 2^(result). INT_MIN: no positive
/// root. Precondition: the last coefficient is not zero. Proof: with M the largest
/// (|c_i|/|c_n|)^(1/(n−i)) over c_i of the sign opposite to c_n's, and x >= 2M, these terms sum to
/// at most |c_n|x^n·Σ 2^(i−n) < |c_n|x^n. Checked: proofs/roots/ControlValues.v,
/// root_exponent_right.
template <class Integer>
int positive_root_exponent(const integer_form<Integer>& p) {
    const int n = static_cast<int>(p.size()) - 1;
    const bool negative = p.back() < 0;
    const int last = floor_log2(p.back());
    int exponent = (std::numeric_limits<int>::min)();
    for (int i = 0; i < n; ++i) {
        const Integer& c = p[static_cast<std::size_t>(i)];
        if (c == 0 || (c < 0) == negative) continue;
        const int quotient = floor_log2(c) + 1 - last;  // log2 |c_i/c_n| is less
        const int root = quotient > 0 ? (quotient + n - i - 1) / (n - i) : quotient / (n - i);
        exponent = (std::max)(exponent, root + 1);
    }
    return exponent;
}

/// The roots of one polynomial p with p(0) ≠ 0, and signs at them.
template <exact_number Integer>
class root_isolation {
  public:
    using form = integer_form<Integer>;
    using point = dyadic<Integer>;
    using interval = isolating_interval<Integer>;
    using end = typename descartes_search<Integer>::end;

    /// Reports multiplicities up to `multiplicities`.
    root_isolation(const form& p, std::size_t multiplicities, work_meter& meter)
        : chain_(squarefree_chain(p, multiplicities, meter)) {
        if (chain_.empty()) chain_.push_back({Integer(1)});
        right_ = half_line(squarefree());
        left_ = half_line(mirrored(squarefree()));
    }

    /// p with its multiple factors reduced to simple ones.
    const form& squarefree() const { return chain_[0]; }

    /// All roots lie strictly between these.
    point upper_bound() const { return unlikely_root<Integer>(right_.upper); }
    point lower_bound() const { return -unlikely_root<Integer>(left_.upper); }

    /// Points strictly between 0 and all positive roots, and between all negative roots and 0.
    point least_positive() const { return unlikely_root<Integer>(right_.lower - 1); }
    point greatest_negative() const { return -unlikely_root<Integer>(left_.lower - 1); }

    /// Appends the roots in [low, high], ascending. Proof: proofs/roots/RootIsolation.v,
    /// isolate_right.
    void isolate(const point& low, const point& high, std::vector<interval>& roots,
                 work_meter& meter) const {
        const std::size_t first = roots.size();
        const end from = end_at(low, meter), to = end_at(high, meter), zero{point(), false};
        if (from.is_root) roots.push_back({low, low});
        if (low < high) {
            if (low < zero.at) {
                std::vector<interval> found;
                inside(left_, high < zero.at ? end{-high, to.is_root} : zero, {-low, from.is_root},
                       found, meter);
                for (auto r = found.rbegin(); r != found.rend(); ++r)
                    roots.push_back({-r->high, -r->low});
            }
            if (zero.at < high) inside(right_, low < zero.at ? zero : from, to, roots, meter);
            if (to.is_root) roots.push_back({high, high});
        }
        for (std::size_t k = first; k < roots.size(); ++k)
            roots[k].multiplicity = multiplicity(roots[k], meter);
    }

    void refine(interval& root, work_meter& meter) const {
        refine(root, scale(root.high - root.low, -1), meter);
    }
    /// Narrows the interval to this width by quadratic interval refinement (J. Abbott 2006).
    void refine(interval& root, const point& width, work_meter& meter) const {
        for (int bits = 1; width < root.high - root.low;)
            bits = keep_part(root, bits, meter) ? 2 * bits : (std::max)(1, bits / 2);
    }

    /// Keeps the root's side of x, strictly inside the interval, or x if it is the root.
    void cut(interval& root, const point& x, work_meter& meter) const {
        const sign_type s = sign_at(squarefree(), x, meter);
        if (s == sign_type::zero)
            root.low = root.high = x;
        else
            (s == sign_at(squarefree(), root.low, meter) ? root.low : root.high) = x;
    }

    /// The sign of g at the root, whose interval it refines. A common factor decides zero, equal
    /// signs of g's control values any other sign. Proof: proofs/roots/RootIsolation.v,
    /// sign_at_root_right.
    sign_type sign_at_root(const form& g, interval& root, work_meter& meter) const {
        if (g.empty()) return sign_type::zero;
        form common;
        for (int bits = 1;; bits *= 2) {
            if (root.is_point()) return sign_at(g, root.low, meter);
            const form b = control_values_on(g, root.low, root.high, meter);
            const auto differs = [&](const Integer& c) { return sign_of(c) != sign_of(b[0]); };
            if (b[0] != 0 && std::none_of(b.begin(), b.end(), differs)) return sign_of(b[0]);
            if (common.empty()) {
                common = common_factor(squarefree(), g, meter);
                if (vanishes(common, root, meter)) return sign_type::zero;
            }
            refine(root, scale(root.high - root.low, -bits), meter);
        }
    }

  private:
    /// A square-free polynomial p. Its positive roots x have 2^lower < x < 2^upper; upper < lower
    /// if there are none. `variations` is the number of sign changes of its coefficients; if 1,
    /// there is one root (Descartes). Proof: proofs/roots/ControlValues.v, half_line_right.
    struct half_line {
        form p;
        int lower = 1, upper = 0;
        int variations = 0;

        half_line() = default;
        explicit half_line(const form& f) : p(f) {
            const int above = positive_root_exponent(f);
            if (above == (std::numeric_limits<int>::min)()) return;
            upper = above;
            lower = -positive_root_exponent(form(f.rbegin(), f.rend()));
            variations = sign_variations(f.size(), [&](std::size_t i) { return sign(f[i]); });
        }
    };

    /// Precondition: f is square-free, without root at the interval's ends.
    static bool changes_sign(const form& f, const interval& root, work_meter& meter) {
        return sign_at(f, root.low, meter) != sign_at(f, root.high, meter);
    }
    /// True if f, a divisor of p, is zero at the root. Proof: proofs/roots/CommonFactor.v,
    /// vanishes_right.
    static bool vanishes(const form& f, const interval& root, work_meter& meter) {
        if (f.size() < 2) return false;
        if (root.is_point()) return sign_at(f, root.low, meter) == sign_type::zero;
        return changes_sign(f, root, meter);
    }
    int multiplicity(const interval& root, work_meter& meter) const {
        const auto is_root_of = [&](const form& f) { return vanishes(f, root, meter); };
        return 1 + static_cast<int>(std::find_if_not(chain_.begin() + 1, chain_.end(), is_root_of) -
                                    (chain_.begin() + 1));
    }

    /// ⌊2^bits·a/(a + b)⌋ for the magnitudes a and b of the end values; their errors only worsen
    /// the choice. Precondition: b is not 0. Proof: proofs/roots/RootIsolation.v,
    /// secant_part_right.
    static Integer secant_part(const nearby_value<Integer>& at_low,
                               const nearby_value<Integer>& at_high, int bits) {
        const Integer parts = Integer(1) << static_cast<unsigned>(bits);
        if (at_low.value == 0) return 0;
        if (at_low.log2() > at_high.log2() + bits + 1) return parts - 1;
        if (at_high.log2() > at_low.log2() + bits + 1) return 0;
        const std::int64_t unit = (std::min)(at_low.exponent, at_high.exponent);
        const auto size = [&](const nearby_value<Integer>& x) {
            return Integer(Integer(abs(x.value)) << static_cast<unsigned>(x.exponent - unit));
        };
        const Integer a = size(at_low), b = size(at_high);
        return Integer(a << static_cast<unsigned>(bits)) / Integer(a + b);
    }
    /// Divides the interval into 2^bits parts. Keeps the secant's choice if it holds the root,
    /// otherwise the root's side of that part (a half for bits = 1). Proof:
    /// proofs/roots/RootIsolation.v, keep_part_right.
    bool keep_part(interval& root, int bits, work_meter& meter) const {
        const form& f = squarefree();
        const auto at_low = value_within(f, root.low, bits + 4, meter);
        const Integer part = secant_part(at_low, value_within(f, root.high, bits + 4, meter), bits);
        const point width = root.high - root.low, start = root.low;
        const auto place = [&](const Integer& k) { return start + width * point(k, -bits); };
        const sign_type before = at_low.sign();
        const point left = place(part), right = place(Integer(part + 1));
        if (root.low < left) {
            const sign_type s = sign_at(f, left, meter);
            if (s == sign_type::zero) return root.low = root.high = left, true;
            if (s != before) return root.high = left, false;
            root.low = left;
        }
        if (right < root.high) {
            const sign_type s = sign_at(f, right, meter);
            if (s == sign_type::zero) return root.low = root.high = right, true;
            if (s == before) return root.low = right, false;
            root.high = right;
        }
        return true;
    }

    std::uint64_t work_of_value(const point& x) const {
        const std::uint64_t n = squarefree().size();
        return x.is_zero()
                   ? 0
                   : n * (1 + n * static_cast<std::uint64_t>(floor_log2(x.numerator()) + 1) / 128);
    }
    end end_at(const point& x, work_meter& meter) const {
        if (x <= lower_bound() || upper_bound() <= x) return {x, false};
        meter.spend(work_of_value(x));
        return {x, sign_at(squarefree(), x, meter) == sign_type::zero};
    }

    /// The roots strictly between low and high, 0 <= low < high.
    static void inside(const half_line& line, end low, end high, std::vector<interval>& roots,
                       work_meter& meter) {
        if (line.upper < line.lower) return;
        const end least{unlikely_root<Integer>(line.lower - 1), false},
            greatest{unlikely_root<Integer>(line.upper), false};
        const bool above = low.at <= least.at, below = greatest.at <= high.at, all = above && below;
        if (above) low = least;
        if (below) high = greatest;
        if (!(low.at < high.at)) return;
        if (line.variations > 1) {
            descartes_search<Integer>(line.p, meter).find(low, high, roots);
        } else if (line.variations == 1 && !low.is_root && !high.is_root) {
            // A sign change proves a root. Proof: proofs/roots/RootIsolation.v, isolate_right.
            if (all || sign_at(line.p, low.at, meter) != sign_at(line.p, high.at, meter))
                roots.push_back({low.at, high.at});
        }
    }

    std::vector<form> chain_;
    half_line right_, left_;
};

}  // namespace errbound::roots
