// Real roots of polynomials with integer coefficients, exactly: isolation, refinement, signs of
// other polynomials there. The exact stage of errbound/roots/real_roots.hpp.
//
// Isolation is by Descartes' rule on intervals (Vincent, Collins, Akritas; in Bernstein form: Lane,
// Riesenfeld 1981): a square-free polynomial has no root inside an interval if its Bernstein
// coefficients there have no sign change, and exactly one if they have one; other intervals are
// split. That ends by the two-circle theorem (Krandick, Mehlhorn 2006).
//
// Allocates; time and memory are bounded by degree and size of the coefficients (the separation of
// the roots limits the number of splits).
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <errbound/roots/fixed_row.hpp>
#include <errbound/roots/integer_polynomial.hpp>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

namespace errbound {

/// One root: low = high is the root, or it lies strictly between them and is the only one in
/// [low, high].
template <exact_number Integer>
struct isolating_interval {
    dyadic<Integer> low, high;
    int multiplicity = 1;

    bool is_point() const { return low == high; }
};

}  // namespace errbound

namespace errbound::roots {

/// A bound of Kioustelidis (1986): no root of p is at or above 2^(this). p has a last coefficient,
/// not zero. INT_MIN: p has no positive root.
/// Proof: with M the largest (|c_i|/|c_n|)^(1/(n−i)) over the c_i of the other sign than c_n's, and
/// x >= 2M, these terms are at most |c_n|x^n·Σ 2^(i−n) < |c_n|x^n in sum.
/// Checked: proofs/ControlValues.v, root_exponent_right.
template <class Integer>
int positive_root_exponent(const integer_form<Integer>& p) {
    const int n = static_cast<int>(p.size()) - 1;
    const bool negative = p.back() < 0;
    const int last = floor_log2(p.back());
    int exponent = std::numeric_limits<int>::min();
    for (int i = 0; i < n; ++i) {
        const Integer& c = p[static_cast<std::size_t>(i)];
        if (c == 0 || (c < 0) == negative) continue;
        const int quotient = floor_log2(c) + 1 - last;  // log2 |c_i/c_n| is less
        const int root = quotient > 0 ? (quotient + n - i - 1) / (n - i) : quotient / (n - i);
        exponent = std::max(exponent, root + 1);
    }
    return exponent;
}

/// The numbers 1/C(n, i), times the least common multiple of the C(n, i). For n <= 40, 64 bits hold
/// them (the multiple is lcm(1, ..., n + 1)/(n + 1)).
/// Proof: proofs/ControlValues.v, weights_right, weights_fit.
template <class Number>
std::vector<Number> inverse_binomials(std::size_t n) {
    using std::gcd;
    std::vector<Number> binomials{Number(1)};
    Number multiple = 1;
    for (std::size_t i = 1; i <= n; ++i) {
        binomials.push_back(Number(binomials.back() * Number(n - i + 1) / Number(i)));
        multiple *= binomials[i] / Number(gcd(multiple, binomials[i]));
    }
    for (Number& b : binomials) b = multiple / b;
    return binomials;
}

/// A positive multiple of p's control values (Bernstein coefficients) on [low, high], all integers.
/// Proof: proofs/ControlValues.v, control_values_on_right.
template <class Integer>
integer_form<Integer> control_values_on(integer_form<Integer> p, const dyadic<Integer>& low,
                                        const dyadic<Integer>& high) {
    const std::size_t n = p.size() - 1;
    const dyadic<Integer> width = high - low;
    const int e = std::min(low.is_zero() ? width.exponent() : low.exponent(), width.exponent());
    // x = 2^e·(start + length·u) with u in [0, 1]: first a multiple of p(2^e·y).
    const Integer start = low.in_units(e), length = width.in_units(e);
    for (std::size_t i = 0; i <= n; ++i) {
        const std::size_t power = e >= 0 ? i : n - i;
        p[i] <<= static_cast<unsigned>(power) * static_cast<unsigned>(e >= 0 ? e : -e);
    }
    Integer term;  // kept, so that it allocates once
    if (start != 0)
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t j = n; j-- > i;) {
                term = p[j + 1];
                term *= start;
                p[j] += term;
            }
    // Control values are Σ_j C(i, j)/C(n, j)·a_j for power-basis coefficients a_j in u.
    const auto weigh = [&](const auto& weights) {
        Integer power = 1;
        for (std::size_t i = 0; i <= n; ++i) {
            p[i] *= Integer(weights[i]);
            if (length == 1) continue;
            p[i] *= power;
            power *= length;
        }
    };
    if (n <= 40)
        weigh(inverse_binomials<std::uint64_t>(n));
    else
        weigh(inverse_binomials<Integer>(n));
    for (std::size_t i = 1; i <= n; ++i)
        for (std::size_t j = n; j >= i; --j) p[j] += p[j - 1];
    return p;
}

/// The control values on the two halves, times 2^n (de Casteljau).
/// Proof: proofs/ControlValues.v, halves_right.
template <class Integer>
std::pair<integer_form<Integer>, integer_form<Integer>> halves(integer_form<Integer> b) {
    const std::size_t n = b.size() - 1;
    integer_form<Integer> left(n + 1);
    for (std::size_t i = 0;; ++i) {
        left[i] = b[0] << static_cast<unsigned>(n - i);
        if (i == n) break;
        for (std::size_t j = 0; j < n - i; ++j) b[j] += b[j + 1];
        b[n - i] <<= static_cast<unsigned>(n - i);
        // b[n − i] is now final: the last entry of row i, which later rows do not touch.
    }
    return {std::move(left), std::move(b)};
}

/// A zero in (0, 1) of the derivative of the form with these control values, by Newton's method in
/// plain doubles from the middle; what is not there if that leaves (0, 1).
inline double extremum(const std::vector<double>& b) {
    const std::size_t n = b.size() - 1;
    std::vector<double> slopes(n);
    double t = 0.5;
    for (int i = 0; i < 8 && 0 < t && t < 1; ++i) {
        for (std::size_t j = 0; j < n; ++j) slopes[j] = b[j + 1] - b[j];
        for (std::size_t left = n; left > 2; --left)
            for (std::size_t j = 0; j + 1 < left; ++j)
                slopes[j] = (1 - t) * slopes[j] + t * slopes[j + 1];
        const double bend = slopes[1] - slopes[0];
        t -= (slopes[0] + t * bend) / (bend * static_cast<double>(n - 1));
    }
    return t;
}

/// The roots of one polynomial p with p(0) ≠ 0, and what is asked at them.
template <exact_number Integer>
class root_isolation {
  public:
    using form = integer_form<Integer>;
    using point = dyadic<Integer>;
    using interval = isolating_interval<Integer>;

    /// Multiplicities are reported if they are at most this.
    explicit root_isolation(const form& p,
                            std::size_t multiplicities = std::numeric_limits<std::size_t>::max())
        : chain_(squarefree_chain(p, multiplicities)) {
        if (chain_.empty()) chain_.push_back({Integer(1)});
        right_ = half_line(squarefree());
        left_ = half_line(mirrored(squarefree()));
    }

    /// p without its factors' multiplicities.
    const form& squarefree() const { return chain_[0]; }

    /// All roots lie between these, strictly.
    point upper_bound() const { return unlikely_root(right_.upper); }
    point lower_bound() const { return -unlikely_root(left_.upper); }

    /// Between 0 and the positive or the negative roots, strictly.
    point least_positive() const { return unlikely_root(right_.lower - 1); }
    point greatest_negative() const { return -unlikely_root(left_.lower - 1); }

    /// Appends the roots in [low, high], low <= high, in ascending order.
    /// Proof: proofs/RootIsolation.v, isolate_right.
    void isolate(const point& low, const point& high, std::vector<interval>& roots) const {
        const std::size_t first = roots.size();
        append_if_root(low, roots);
        if (low < high) {
            const point zero;
            if (low < zero) {
                std::vector<interval> found;
                inside(left_, high < zero ? -high : zero, -low, found);
                for (auto r = found.rbegin(); r != found.rend(); ++r)
                    roots.push_back({-r->high, -r->low});
            }
            if (zero < high) inside(right_, low < zero ? zero : low, high, roots);
            append_if_root(high, roots);
        }
        for (std::size_t k = first; k < roots.size(); ++k)
            roots[k].multiplicity = multiplicity(roots[k]);
    }

    /// Narrows the root's interval to at most half of it, or to this width.
    void refine(interval& root) const { refine(root, scale(root.high - root.low, -1)); }
    /// Quadratic interval refinement (J. Abbott 2006): the secant picks one of 2^bits parts, and
    /// bits doubles if that is right.
    void refine(interval& root, const point& width) const {
        for (int bits = 1; width < root.high - root.low;)
            bits = keep_part(root, bits) ? 2 * bits : std::max(1, bits / 2);
    }

    /// The sign of g at the root; refines it. Zero is decided by a common factor, any other sign
    /// when all of g's control values on the interval have it.
    /// Proof: proofs/RootIsolation.v, sign_at_root_right.
    sign_type sign_at_root(const form& g, interval& root) const {
        if (g.empty()) return sign_type::zero;
        form common;
        for (int bits = 1;; bits *= 2) {
            if (root.is_point()) return sign_at(g, root.low);
            const form b = control_values_on(g, root.low, root.high);
            const auto differs = [&](const Integer& c) { return sign_of(c) != sign_of(b[0]); };
            if (b[0] != 0 && std::none_of(b.begin(), b.end(), differs)) return sign_of(b[0]);
            if (common.empty()) {
                common = common_factor(squarefree(), g);
                if (vanishes(common, root)) return sign_type::zero;
            }
            refine(root, scale(root.high - root.low, -bits));
        }
    }

  private:
    /// A square-free polynomial, and bounds 2^lower < x < 2^upper of its positive
    /// roots x; upper < lower if there is none. Proof: proofs/ControlValues.v, half_line_right.
    struct half_line {
        form p;
        int lower = 1, upper = 0;

        half_line() = default;
        explicit half_line(const form& f) : p(f) {
            const int above = positive_root_exponent(f);
            if (above == std::numeric_limits<int>::min()) return;
            upper = above;
            lower = -positive_root_exponent(form(f.rbegin(), f.rend()));
        }
    };

    /// For square-free f without root at the ends of the interval.
    static bool changes_sign(const form& f, const interval& root) {
        return sign_at(f, root.low) != sign_at(f, root.high);
    }
    /// Whether f, a divisor of p's, vanishes at the root. Proof: proofs/CommonFactor.v,
    /// vanishes_right.
    static bool vanishes(const form& f, const interval& root) {
        if (f.size() < 2) return false;
        if (root.is_point()) return sign_at(f, root.low) == sign_type::zero;
        return changes_sign(f, root);
    }
    int multiplicity(const interval& root) const {
        const auto is_root_of = [&](const form& f) { return vanishes(f, root); };
        return 1 + static_cast<int>(std::find_if_not(chain_.begin() + 1, chain_.end(), is_root_of) -
                                    (chain_.begin() + 1));
    }

    /// Keeps one of 2^bits parts of the interval if the root is in the one where the secant has it,
    /// and otherwise what lies on the root's side of that; one half if bits is 1.
    /// Proof: proofs/RootIsolation.v, keep_part_right, secant_part_right.
    bool keep_part(interval& root, int bits) const {
        const form& f = squarefree();
        const point at_low = value_at(f, root.low), at_high = value_at(f, root.high);
        const int unit = std::min(at_low.exponent(), at_high.exponent());
        const Integer above_low = abs(at_low.in_units(unit));
        const Integer whole = above_low + abs(at_high.in_units(unit));
        const Integer part = (above_low << static_cast<unsigned>(bits)) / whole;
        const point width = root.high - root.low, start = root.low;
        const auto place = [&](const Integer& k) { return start + width * point(k, -bits); };
        const sign_type before = sign_of(at_low);
        // The part's ends: the sign there tells on which side of it the root is.
        const point left = place(part), right = place(Integer(part + 1));
        if (root.low < left) {
            const sign_type s = sign_at(f, left);
            if (s == sign_type::zero) return root.low = root.high = left, true;
            if (s != before) return root.high = left, false;
            root.low = left;
        }
        if (right < root.high) {
            const sign_type s = sign_at(f, right);
            if (s == sign_type::zero) return root.low = root.high = right, true;
            if (s == before) return root.low = right, false;
            root.high = right;
        }
        return true;
    }

    void append_if_root(const point& x, std::vector<interval>& roots) const {
        if (sign_at(squarefree(), x) == sign_type::zero) roots.push_back({x, x});
    }

    /// A point between 2^exponent and twice that, and such that halving from there hardly meets the
    /// numbers that people choose as roots.
    static point unlikely_root(int exponent) { return {Integer(45), exponent - 5}; }

    /// The roots strictly between low and high, 0 <= low < high.
    static void inside(const half_line& line, point low, point high, std::vector<interval>& roots) {
        if (line.upper < line.lower) return;
        const point least = unlikely_root(line.lower - 1), greatest = unlikely_root(line.upper);
        if (low < least) low = least;
        if (greatest < high) high = greatest;
        if (low < high) on_part(line.p, low, high, control_values_on(line.p, low, high), 0, roots);
    }

    /// b: control values on the part, which came of this many halvings.
    /// Proof: proofs/RootIsolation.v, on_part_right.
    static void on_part(const form& p, const point& low, const point& high, form b, int halvings,
                        std::vector<interval>& roots) {
        const int variations = sign_variations(b.size(), [&b](std::size_t i) {
            return b[i] == 0 ? 0 : b[i] > 0 ? 1 : -1;
        });
        if (variations == 0) return;
        const bool roots_at_ends = b.front() == 0 || b.back() == 0;
        if (variations == 1 && !roots_at_ends) {
            roots.push_back({low, high});
            return;
        }
        const int low_exponent = floor_log2(low), high_exponent = floor_log2(high);
        if (variations == 2 && !roots_at_ends && high_exponent - low_exponent < 40 &&
            add_pair(p, low, high, nearby_values(b), sign_of(b.front()), halvings, roots))
            return;
        // Of wide ranges halve the exponents, so that roots far apart in size take few steps.
        const bool by_exponent = high_exponent - low_exponent >= 12;
        if (!by_exponent && !roots_at_ends) {
            if (fixed_row<4> row(b); row.ends_are_certain()) {
                b = {};
                on_part(p, low, high, std::move(row), halvings, roots);
                return;
            }
        }
        const point half = by_exponent
                               ? unlikely_root(low_exponent + (high_exponent - low_exponent) / 2)
                               : middle(low, high);
        auto parts = by_exponent ? std::pair{control_values_on(p, low, half),
                                             control_values_on(p, half, high)}
                                 : halves(std::move(b));
        b = {};
        const bool half_is_root = parts.second.front() == 0;
        on_part(p, low, half, std::move(parts.first), halvings + 1, roots);
        if (half_is_root) roots.push_back({half, half});
        on_part(p, half, high, std::move(parts.second), halvings + 1, roots);
    }

    /// The same by cut coefficients; back to all their bits where those kept do not tell.
    static void on_part(const form& p, const point& low, const point& high, fixed_row<4> row,
                        int halvings, std::vector<interval>& roots) {
        if (!row.ends_are_certain()) {
            on_part(p, low, high, control_values_on(p, low, high), halvings, roots);
            return;
        }
        const int variations = row.max_variations();
        if (variations == 0) return;
        if (variations == 1) {
            roots.push_back({low, high});
            return;
        }
        if (variations == 2 && halvings > 0 &&
            add_pair(p, low, high, row.nearby_values(),
                     row.sign(0) < 0 ? sign_type::negative : sign_type::positive, halvings, roots))
            return;
        const point half = middle(low, high);
        auto parts = std::move(row).halves();
        on_part(p, low, half, std::move(parts.first), halvings + 1, roots);
        if (parts.second.sign(0) == 0 && sign_at(p, half) == sign_type::zero)
            roots.push_back({half, half});
        on_part(p, half, high, std::move(parts.second), halvings + 1, roots);
    }

    /// Two close roots, or two that are not real, would take many halvings to part. Where at most
    /// two are left, the part is split at the extremum between them instead, which Newton's method
    /// finds to more and more bits: they lie on either side of it, or in neither of the circles
    /// that have its sides as diameters, so that no sign change is left. Tried after 0, 8, 16, 32,
    /// ... halvings; false if nothing comes of it. b: control values in doubles, a hint; at_ends:
    /// their sign at both ends.
    /// Proof: proofs/SignVariations.v, two_variations_two_roots.
    static bool add_pair(const form& p, const point& low, const point& high,
                         const std::vector<double>& b, sign_type at_ends, int halvings,
                         std::vector<interval>& roots) {
        if (halvings % 8 != 0 || (halvings & (halvings - 1)) != 0) return false;
        const double t = extremum(b);
        if (!(0 < t && t < 1)) return false;
        const form slope = derivative(p), curvature = derivative(slope);
        point x = low + (high - low) * point::from(t);
        for (int bits = 64;; bits *= 2) {
            const point value = value_at(p, x);
            if (value.is_zero()) return false;
            if (sign_of(value) == -at_ends) {
                roots.push_back({low, x});
                roots.push_back({x, high});
                return true;
            }
            const point rise = value_at(slope, x), bend = value_at(curvature, x);
            // By its parabola, the extremum is on the same side as p(x) if p·p'' > p'²/2.
            if (bits > 256 || rise.is_zero() || bend.is_zero() ||
                rise * rise < magnitude(value * bend))
                break;
            x = x - quotient(rise, bend, bits);
            if (!(low < x && x < high)) return false;
        }
        on_part(p, low, x, control_values_on(p, low, x), halvings + 1, roots);
        on_part(p, x, high, control_values_on(p, x, high), halvings + 1, roots);
        return true;
    }
    static std::vector<double> nearby_values(const form& b) {
        int unit = 0;
        for (const Integer& c : b)
            if (c != 0) unit = std::max(unit, floor_log2(c));
        std::vector<double> values;
        values.reserve(b.size());
        for (const Integer& c : b) values.push_back(nearby_double(c, -unit));
        return values;
    }

    std::vector<form> chain_;
    half_line right_, left_;
};

}  // namespace errbound::roots
