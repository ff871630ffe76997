// Real roots in (0, 1) of polynomials with integer coefficients, and exact signs of others there.
//
// A polynomial is a form Σ h_i s^(n−i) t^i, as in bernstein.hpp, of run-time degree; h_i are at
// the same time power-basis coefficients in x = t/s, in which (0, 1) is (0, ∞). Integer is an exact
// type with + − × / %, comparison, abs(), gcd() and msb() found by argument-dependent lookup
// (Boost.Multiprecision's integers). Allocates; time and memory are bounded by degree and size of
// the coefficients (the root separation of the polynomials limits the refinement).
#pragma once

#include <algorithm>
#include <cstddef>
#include <errbound/bernstein.hpp>
#include <errbound/sign.hpp>
#include <utility>
#include <vector>

namespace errbound {

template <exact_number Integer>
using integer_form = std::vector<Integer>;

/// The form of p without its roots at t = 0 and t = 1 (leading and trailing zero coefficients);
/// empty if p is identically zero.
template <exact_number Integer, int N>
integer_form<Integer> without_end_roots(const bernstein<Integer, N>& p) {
    std::size_t first = 0, last = N + 1;
    while (first < last && p.h[first] == 0) ++first;
    while (last > first && p.h[last - 1] == 0) --last;
    return {p.h.begin() + static_cast<std::ptrdiff_t>(first),
            p.h.begin() + static_cast<std::ptrdiff_t>(last)};
}

namespace detail {

template <class Integer>
void trim(integer_form<Integer>& p) {
    while (!p.empty() && p.back() == 0) p.pop_back();
}

/// p divided by the (positive) greatest common divisor of its coefficients.
template <class Integer>
void make_primitive(integer_form<Integer>& p) {
    Integer content = 0;
    for (const Integer& c : p) content = gcd(content, c);
    if (content > 1)
        for (Integer& c : p) c /= content;
}

/// A positive multiple of the remainder of a by b (power basis in x), and of the quotient.
template <class Integer>
std::pair<integer_form<Integer>, integer_form<Integer>> pseudo_divide(
    integer_form<Integer> a, const integer_form<Integer>& b) {
    const Integer lead = abs(b.back());
    const bool negative = b.back() < 0;
    integer_form<Integer> quotient(a.size() < b.size() ? 0 : a.size() - b.size() + 1);
    while (a.size() >= b.size()) {
        const std::size_t shift = a.size() - b.size();
        const Integer factor = negative ? Integer(-a.back()) : a.back();
        for (Integer& c : quotient) c *= lead;
        quotient[shift] = factor;
        for (Integer& c : a) c *= lead;
        for (std::size_t i = 0; i < b.size(); ++i) a[i + shift] -= factor * b[i];
        trim(a);
    }
    return {std::move(quotient), std::move(a)};
}

template <class Integer>
integer_form<Integer> derivative_in_x(const integer_form<Integer>& p) {
    integer_form<Integer> d;
    for (std::size_t i = 1; i < p.size(); ++i) d.push_back(p[i] * Integer(i));
    return d;
}

}  // namespace detail

/// The greatest common divisor, primitive; empty only if both are identically zero.
template <exact_number Integer>
integer_form<Integer> common_factor(integer_form<Integer> a, integer_form<Integer> b) {
    detail::trim(a);
    detail::trim(b);
    while (!b.empty()) {
        detail::make_primitive(b);
        a = detail::pseudo_divide(std::move(a), b).second;
        std::swap(a, b);
    }
    detail::make_primitive(a);
    return a;
}

/// The point t/(s + t) of [0, 1], for s, t >= 0 not both zero; x = t/s there.
template <exact_number Integer>
struct ratio {
    Integer s, t;
};

/// The sign of p at a point. (At x = ∞ it is that of p's last coefficient, which is not zero.)
template <exact_number Integer>
sign_type sign_at(const integer_form<Integer>& p, const ratio<Integer>& point) {
    if (p.empty()) return sign_type::zero;
    Integer sum = p[0], power = 1;
    for (std::size_t i = 1; i < p.size(); ++i) {
        power *= point.t;
        sum = sum * point.s + p[i] * power;
    }
    return sign_of(sum);
}

/// The distinct roots of a polynomial in (0, 1), by Sturm's theorem and bisection: of the
/// exponent of x first, so that roots near the ends take few steps, then of x itself.
template <exact_number Integer>
class real_roots {
  public:
    /// The roots of p; p has no root at 0 or 1 (see without_end_roots) and is not empty.
    explicit real_roots(const integer_form<Integer>& p) {
        const auto d = detail::derivative_in_x(p);
        squarefree_ = d.empty() ? p : detail::pseudo_divide(p, common_factor(p, d)).first;
        detail::make_primitive(squarefree_);
        chain_ = sturm_chain(squarefree_);
        for (const Integer& c : squarefree_) {
            const Integer size = abs(c);
            if (size > 0) exponent_bound_ = std::max(exponent_bound_, int(msb(size)) + 2);
        }
        isolate({1, 0}, {0, 1});
    }

    std::size_t size() const { return intervals_.size(); }

    /// The sign of g at root k (in ascending order); g is not changed by roots at 0 or 1.
    /// Exact: zero is decided by a common factor, any other sign by refining the root's interval
    /// until g's coefficients on it have one sign.
    sign_type sign_at_root(const integer_form<Integer>& g, std::size_t k) {
        // A remainder by the squarefree part has g's signs at the roots, and at most its degree.
        return sign_of_reduced(detail::pseudo_divide(g, squarefree_).second, k);
    }

  private:
    sign_type sign_of_reduced(integer_form<Integer> g, std::size_t k) {
        if (g.empty()) return sign_type::zero;
        detail::make_primitive(g);
        const integer_form<Integer> common = common_factor(squarefree_, g);
        interval& root = intervals_[k];
        if (common.size() > 1) {
            const auto chain = sturm_chain(common);
            if (variations(chain, root.low) != variations(chain, root.high)) return sign_type::zero;
        }
        for (;;) {
            if (sign_at(squarefree_, root.high) == sign_type::zero) return sign_at(g, root.high);
            const sign_type hull = sign_on(g, root);
            if (certain(hull)) return hull;
            refine(root);
        }
    }

    /// Contains exactly one root, in (low, high].
    struct interval {
        ratio<Integer> low, high;
    };
    using chain_type = std::vector<integer_form<Integer>>;

    static chain_type sturm_chain(const integer_form<Integer>& p) {
        chain_type chain{p, detail::derivative_in_x(p)};
        while (!chain.back().empty()) {
            auto rest = detail::pseudo_divide(chain[chain.size() - 2], chain.back()).second;
            detail::make_primitive(rest);
            for (Integer& c : rest) c = -c;
            chain.push_back(std::move(rest));
        }
        chain.pop_back();
        return chain;
    }

    /// Sign variations of the chain: those at low less those at high are the number of roots of a
    /// squarefree polynomial in (low, high].
    static int variations(const chain_type& chain, const ratio<Integer>& point) {
        int count = 0;
        sign_type last = sign_type::zero;
        for (const auto& p : chain) {
            const sign_type s = sign_at(p, point);
            if (s == sign_type::zero) continue;
            if (last != sign_type::zero && s != last) ++count;
            last = s;
        }
        return count;
    }

    /// ⌊log2 x⌋ of a point (every s here is a power of two or 0). At the ends it is a bound of
    /// Cauchy's: roots have 2^-bound < x < 2^(bound − 1), so no interval that holds one is narrow
    /// and has x = ∞ as its end.
    int exponent(const ratio<Integer>& point) const {
        if (point.t == 0) return -exponent_bound_;
        if (point.s == 0) return exponent_bound_;
        return int(msb(point.t)) - int(msb(point.s));
    }

    /// A point strictly between a and b.
    ratio<Integer> middle(const ratio<Integer>& a, const ratio<Integer>& b) const {
        const int low = exponent(a), high = exponent(b);
        if (high - low >= 2) {
            const int e = low + (high - low) / 2;
            return e >= 0 ? ratio<Integer>{1, Integer(1) << e}
                          : ratio<Integer>{Integer(1) << -e, 1};
        }
        // x = (xa + xb)/2
        const Integer& s = a.s < b.s ? b.s : a.s;
        return {Integer(2 * s), Integer(a.t * (s / a.s) + b.t * (s / b.s))};
    }

    void isolate(const ratio<Integer>& low, const ratio<Integer>& high) {
        const int count = variations(chain_, low) - variations(chain_, high);
        if (count == 0) return;
        if (count == 1) {
            intervals_.push_back({low, high});
            return;
        }
        const ratio<Integer> half = middle(low, high);
        isolate(low, half);
        isolate(half, high);
    }

    void refine(interval& root) const {
        const ratio<Integer> half = middle(root.low, root.high);
        if (variations(chain_, root.low) != variations(chain_, half))
            root.high = half;
        else
            root.low = half;
    }

    /// The one sign of g's coefficients on [low, high], or uncertain.
    static sign_type sign_on(const integer_form<Integer>& g, const interval& range) {
        const integer_form<Integer> s{range.low.s, range.high.s};
        const integer_form<Integer> t{range.low.t, range.high.t};
        // g(s(σ, τ), t(σ, τ)) by Horner's rule; s and t are linear forms on the interval.
        integer_form<Integer> sum{g[0]}, power{Integer(1)};
        for (std::size_t i = 1; i < g.size(); ++i) {
            power = product(power, t);
            sum = product(sum, s);
            for (std::size_t j = 0; j < sum.size(); ++j) sum[j] += g[i] * power[j];
        }
        sign_type all = sign_of(sum[0]);
        for (const Integer& c : sum)
            if (sign_of(c) != all || c == 0) return sign_type::uncertain;
        return all;
    }
    static integer_form<Integer> product(const integer_form<Integer>& a,
                                         const integer_form<Integer>& b) {
        integer_form<Integer> r(a.size() + b.size() - 1);
        for (std::size_t i = 0; i < a.size(); ++i)
            for (std::size_t j = 0; j < b.size(); ++j) r[i + j] += a[i] * b[j];
        return r;
    }

    integer_form<Integer> squarefree_;
    chain_type chain_;
    int exponent_bound_ = 0;
    std::vector<interval> intervals_;
};

}  // namespace errbound
