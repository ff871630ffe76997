// Real roots of one polynomial, always exactly: floating point first (errbound/root_filter.hpp),
// integers for what it leaves open (errbound/root_isolation.hpp).
//
// errbound/polynomial.hpp has the calls that most users want.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <errbound/bernstein.hpp>
#include <errbound/integer_polynomial.hpp>
#include <errbound/root_filter.hpp>
#include <errbound/root_isolation.hpp>
#include <errbound/rules/tight.hpp>
#include <errbound/tracked.hpp>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace errbound {

/// The form Σ h_i s^(n−i) t^i of p without its roots at t = 0 and t = 1 (leading and trailing zero
/// coefficients); empty if p is identically zero. Its coefficients are those of the power basis in
/// x = t/s, in which (0, 1) is (0, ∞).
template <exact_number Integer, int N>
integer_form<Integer> without_end_roots(const bernstein<Integer, N>& p) {
    std::size_t first = 0, last = N + 1;
    while (first < last && p.h[first] == 0) ++first;
    while (last > first && p.h[last - 1] == 0) --last;
    return {p.h.begin() + static_cast<std::ptrdiff_t>(first),
            p.h.begin() + static_cast<std::ptrdiff_t>(last)};
}

/// One polynomial for both stages: exact, and in floating point with error bounds.
template <exact_number Integer>
class staged_polynomial {
  public:
    using number = tracked<double, tight>;

    /// Of finite doubles, which are exact; integers are made of them when asked for.
    explicit staged_polynomial(const std::vector<double>& coefficients)
        : floating_(coefficients.begin(), coefficients.end()) {
        while (!floating_.empty() && floating_.back().value() == 0) floating_.pop_back();
    }
    explicit staged_polynomial(integer_form<Integer> p) : exact_(std::move(p)) {
        trim(exact_);
        int highest = std::numeric_limits<int>::min();
        for (const Integer& c : exact_)
            if (c != 0) highest = std::max(highest, floor_log2(c));
        // A positive multiple, where double's range asks for one.
        const int unit = std::max(0, highest - number_traits<double>::max_exponent / 2);
        for (const Integer& c : exact_) {
            const double x = nearby_double(c, -unit);
            const bool same = unit == 0 && std::abs(x) < 0x1p53;
            const double error = number_traits<double>::epsilon() * std::abs(x);
            floating_.push_back(
                same || c == 0
                    ? number(x)
                    : number::within(x, 2 * error + number_traits<double>::underflow_unit()));
        }
    }

    bool is_zero() const { return floating_.empty(); }
    std::size_t size() const { return floating_.size(); }
    const std::vector<number>& floating() const { return floating_; }
    /// A positive multiple.
    const integer_form<Integer>& exact() {
        if (exact_.empty() && !floating_.empty()) {
            int unit = std::numeric_limits<int>::max();
            for (const number& c : floating_)
                if (c.value() != 0) unit = std::min(unit, decomposed(c.value()).exponent);
            for (const number& c : floating_)
                exact_.push_back(dyadic<Integer>::from(c.value()).in_units(unit));
        }
        return exact_;
    }

    /// Divides by x as often as that goes; how often.
    int divide_by_x() {
        const auto first = std::find_if(floating_.begin(), floating_.end(), [](const number& c) {
            return c.value() != 0 || c.error() != 0;
        });
        const auto count = first - floating_.begin();
        floating_.erase(floating_.begin(), first);
        if (!exact_.empty()) exact_.erase(exact_.begin(), exact_.begin() + count);
        return static_cast<int>(count);
    }

  private:
    std::vector<number> floating_;
    integer_form<Integer> exact_;
};

/// The distinct roots of a polynomial on a part of the line, in ascending order. What is found out
/// of a root narrows its interval for what is asked next: not for use by two threads at once.
template <exact_number Integer>
class real_roots {
  public:
    using interval = isolating_interval<Integer>;
    using point = dyadic<Integer>;

    /// The roots of p in (0, ∞) by integers alone; p's first and last coefficients are not zero.
    explicit real_roots(const integer_form<Integer>& p) : p_(p) {
        const point zero;
        exact().isolate(zero, exact().upper_bound(), intervals_);
    }

    /// The roots in [a, b], a <= b, which may be infinite.
    real_roots(staged_polynomial<Integer> p, double a, double b) : p_(std::move(p)) {
        if (p_.is_zero()) {
            everywhere_ = true;
            return;
        }
        const int zeros = p_.divide_by_x();
        const bool zero_is_root = zeros > 0 && a <= 0 && 0 <= b;
        std::size_t negative = 0;
        if (a == b) {
            if (a != 0) exact().isolate(point::from(a), point::from(a), intervals_);
        } else {
            const root_filter<tight> filter(p_.floating(), a, b);
            const auto& parts = filter.parts();
            for (std::size_t i = 0; i < parts.size(); ++i) add(parts, i);
            decided_by_filter_ = filter.decides();
        }
        if (!zero_is_root) return;
        // No other interval may hold the root at 0.
        const point zero;
        for (interval& root : intervals_) {
            while (root.low == zero || root.high == zero || (root.low < zero && zero < root.high))
                exact().refine(root);
            if (root.low < zero) ++negative;
        }
        intervals_.insert(intervals_.begin() + static_cast<std::ptrdiff_t>(negative),
                          interval{zero, zero, zeros});
    }

    /// Whether the polynomial is identically zero: all points are roots, and none is listed.
    bool everywhere() const { return everywhere_; }
    std::size_t size() const { return intervals_.size(); }
    const interval& operator[](std::size_t k) const { return intervals_[k]; }
    /// Whether no integers were needed to isolate the roots.
    bool decided_by_filter() const { return decided_by_filter_; }

    /// Narrows root k's interval to at most this width > 0.
    void refine(std::size_t k, const point& width) {
        interval& root = intervals_[k];
        while (width < root.high - root.low) exact().refine(root);
    }
    void refine(std::size_t k, double width) { refine(k, point::from(width)); }

    /// The sign of g at root k, exactly.
    sign_type sign_at_root(const integer_form<Integer>& g, std::size_t k) {
        return exact().sign_at_root(g, intervals_[k]);
    }

  private:
    const root_isolation<Integer>& exact() {
        if (!exact_) exact_.emplace(p_.exact());
        return *exact_;
    }

    /// The filter's part i, together with its neighbours if it is not known.
    void add(const std::vector<filtered_part>& parts, std::size_t& i) {
        const filtered_part& part = parts[i];
        if (part.has_one_root) {
            const auto [low, high] = ends(part);
            intervals_.push_back({low, high});
            return;
        }
        auto [low, high] = ends(part);
        for (; i + 1 < parts.size() && !parts[i + 1].has_one_root; ++i) {
            const auto next = ends(parts[i + 1]);
            if (high < next.first) break;
            high = next.second;
        }
        exact().isolate(low, high, intervals_);
    }
    /// Both in ascending order; root bounds for infinite ends.
    std::pair<point, point> ends(const filtered_part& part) {
        const auto end = [this](double x) {
            if (std::isfinite(x)) return point::from(x);
            return x > 0 ? exact().upper_bound() : exact().lower_bound();
        };
        const point at0 = end(part.at0), at1 = end(part.at1);
        const point from = at0 + (at1 - at0) * point::from(part.from),
                    to = at0 + (at1 - at0) * point::from(part.to);
        return from < to ? std::pair{from, to} : std::pair{to, from};
    }

    staged_polynomial<Integer> p_;
    std::optional<root_isolation<Integer>> exact_;
    std::vector<interval> intervals_;
    bool everywhere_ = false;
    bool decided_by_filter_ = false;
};

}  // namespace errbound
