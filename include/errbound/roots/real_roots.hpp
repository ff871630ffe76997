// Real roots of one polynomial, always exact: floating point first (root_filter.hpp), integers for
// the undecided rest (root_isolation.hpp). Most users call errbound/polynomial.hpp.
#pragma once

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <errbound/bernstein.hpp>
#include <errbound/roots/double_order.hpp>
#include <errbound/roots/integer_polynomial.hpp>
#include <errbound/roots/polynomial_stages.hpp>
#include <errbound/roots/root_filter.hpp>
#include <errbound/roots/root_isolation.hpp>
#include <errbound/rules/tight.hpp>
#include <errbound/tracked.hpp>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

namespace errbound::roots {

/// The form Σ h_i s^(n−i) t^i of p without its roots at t = 0 and t = 1; empty if p is identically
/// zero. Its coefficients are power-basis coefficients in x = t/s, which maps (0, 1) to (0, ∞).
/// Proof: proofs/contact/UnboundedIntegers.v, without_end_roots_value.
template <exact_number Integer, int N>
integer_form<Integer> without_end_roots(const bernstein<Integer, N>& p) {
    std::size_t first = 0, last = N + 1;
    while (first < last && p.h[first] == 0) ++first;
    while (last > first && p.h[last - 1] == 0) --last;
    return {p.h.begin() + static_cast<std::ptrdiff_t>(first),
            p.h.begin() + static_cast<std::ptrdiff_t>(last)};
}

/// True if a <= b and [a, b] holds a finite number.
inline bool is_interval(double a, double b) {
    return a <= b && a < number_traits<double>::infinity() &&
           b > -number_traits<double>::infinity();
}

}  // namespace errbound::roots

namespace errbound {

/// The number of roots of the zero polynomial.
inline constexpr std::size_t infinitely_many = (std::numeric_limits<std::size_t>::max)();

struct occurring_signs {
    bool negative = false, zero = false, positive = false;

    constexpr void add(sign_type s) {
        if (s == sign_type::negative) negative = true;
        if (s == sign_type::zero) zero = true;
        if (s == sign_type::positive) positive = true;
    }
    friend constexpr bool operator==(const occurring_signs&, const occurring_signs&) = default;
};

/// The distinct roots of a polynomial on an interval, ascending. Calls narrow the roots' intervals,
/// so two threads must not use the same object at once.
template <exact_number Integer>
class real_roots {
  public:
    using interval = isolating_interval<Integer>;
    using point = dyadic<Integer>;
    using number = typename roots::staged_polynomial<Integer>::number;

    /// The roots of p in (0, ∞), by integers. Precondition: first and last coefficients are not
    /// zero. Proof: proofs/roots/RootFinder.v, found_roots_right.
    explicit real_roots(const roots::integer_form<Integer>& p) : p_(p) {
        const point zero;
        isolate(zero, exact().upper_bound());
    }

    /// The roots in [a, b], a <= b, possibly infinite. Throws roots::gave_up beyond the limits,
    /// which apply to this constructor. `stop` persists: later calls that it ends throw
    /// roots::gave_up and leave the object valid.
    real_roots(roots::staged_polynomial<Integer> p, double a, double b,
               const root_limits& limits = {})
        : p_(std::move(p)), meter_(limits) {
        assert(roots::is_interval(a, b));
        if (p_.is_zero()) {
            everywhere_ = true;
            return;
        }
        zeros_ = p_.divide_by_x();
        if (a == b) {
            if (a != 0 && possibly_zero(floating_sign_at(number(a))))
                isolate(point::from(a), point::from(a));
        } else {
            add(roots::root_filter<tight>(p_.floating(), a, b).parts());
        }
        if (a <= 0 && 0 <= b) add_zero();
        meter_.lift();
    }
    /// Counts roots for a < b and p not zero, after root_filter found `parts` for the roots other
    /// than 0 and left some undecided. Throws roots::gave_up.
    static std::size_t count(roots::staged_polynomial<Integer> p, double a, double b,
                             const std::vector<roots::filtered_part>& parts,
                             const root_limits& limits = {}) {
        real_roots roots;
        roots.p_ = std::move(p);
        const int zeros = roots.p_.divide_by_x();
        roots.meter_ = roots::work_meter(limits);
        roots.exact_.emplace(roots.p_.exact(), 1, roots.meter_);
        roots.add(parts);
        return roots.size() + (zeros > 0 && a <= 0 && 0 <= b);
    }

    /// True if the polynomial is identically zero: every point is a root, and none is listed.
    bool everywhere() const { return everywhere_; }
    std::size_t size() const { return intervals_.size(); }
    const interval& operator[](std::size_t k) const {
        assert(k < size());
        return intervals_[k];
    }
    /// True if isolation needed no integers.
    bool decided_by_filter() const { return decided_by_filter_; }

    /// Narrows root k's interval to this width. Throws std::invalid_argument unless 0 < width < ∞.
    void refine(std::size_t k, const point& width) {
        assert(k < size());
        if (sign_of(width) != sign_type::positive)
            throw std::invalid_argument(
                "errbound::real_roots::refine: width is out of range; expected a finite number > "
                "0");
        if (width < intervals_[k].high - intervals_[k].low) narrow(intervals_[k]);
        if (width < intervals_[k].high - intervals_[k].low)
            exact().refine(intervals_[k], width, meter_);
    }
    void refine(std::size_t k, double width) {
        refine(k, point::from(std::isfinite(width) ? width : 0));
    }

    /// Two adjacent doubles around root k (one of them infinite beyond the largest), or the root
    /// twice if it is a double. Narrows its interval.
    std::pair<double, double> neighbouring_doubles(std::size_t k) {
        constexpr std::int64_t few = 64, of_one_exponent = std::int64_t(1) << 52;
        assert(k < size());
        interval& root = intervals_[k];
        narrow(root);
        for (;;) {
            const std::int64_t low = roots::order_at_or_below(root.low),
                               high = roots::order_at_or_above(root.high);
            // low = high only for a point; otherwise the root is strictly inside.
            if (high - low <= 1) return {roots::double_of_order(low), roots::double_of_order(high)};
            if (high - low <= few || high - low > of_one_exponent)
                exact().cut(root, point::from(roots::double_of_order(low + (high - low) / 2)),
                            meter_);
            else
                exact().refine(root, quarter_ulp(root), meter_);
        }
    }

    /// Root k rounded to the nearest double, ties to even; infinite if |root| is at least half a
    /// unit in the last place beyond the largest double; never −0. Narrows its interval.
    double nearest_double(std::size_t k) {
        const auto [low, high] = neighbouring_doubles(k);
        if (low == high) return low;
        const auto place = [](double x) {
            const point beyond = point::power_of_two(std::numeric_limits<double>::max_exponent);
            return std::isfinite(x) ? point::from(x) : x > 0 ? beyond : -beyond;
        };
        interval& root = intervals_[k];
        const point half = middle(place(low), place(high));
        if (root.low < half && half < root.high) exact().cut(root, half, meter_);
        if (root.is_point() && root.low == half) return roots::order_of(low) % 2 == 0 ? low : high;
        const bool is_below = root.is_point() ? root.low < half : !(half < root.high);
        return is_below ? low : high;
    }

    /// Root k with a floating-point error bound.
    number enclosure(std::size_t k) {
        assert(k < size());
        narrow(intervals_[k]);
        return enclosure(intervals_[k]);
    }

    /// The exact sign of g at root k; sign_at_root computes it by integers only.
    sign_type sign_at(roots::staged_polynomial<Integer>& g, std::size_t k) {
        assert(k < size());
        interval& root = intervals_[k];
        const auto by_values = [&] {
            return sign_of(roots::value_at(g.floating(), enclosure(root)));
        };
        sign_type s = by_values();
        if (!certain(s) && narrow(root)) s = by_values();
        return certain(s) ? s : exact().sign_at_root(g.exact(), root, meter_);
    }
    template <class C>
    sign_type sign_at(const polynomial<C>& g, std::size_t k) {
        auto p = roots::staged<Integer>(g);
        return sign_at(p, k);
    }

    sign_type sign_at_root(const roots::integer_form<Integer>& g, std::size_t k) {
        return exact().sign_at_root(g, intervals_[k], meter_);
    }

    /// The signs of the polynomial on [a, b], the interval given to the constructor.
    occurring_signs signs_on(double a, double b) {
        occurring_signs signs;
        if (everywhere_ || size() > 0) signs.zero = true;
        if (everywhere_ || (a == b && signs.zero)) return signs;
        // The sign changes exactly at inner roots of odd multiplicity.
        for (const interval& root : intervals_) {
            const bool at_end = root.is_point() && (is_at(root, a) || is_at(root, b));
            if (root.multiplicity % 2 == 1 && !at_end) signs.negative = signs.positive = true;
        }
        if (!signs.negative) signs.add(sign_beside_roots(a, b));
        return signs;
    }

  private:
    real_roots() = default;

    const roots::root_isolation<Integer>& exact() {
        if (!exact_) exact_.emplace(p_.exact(), (std::numeric_limits<std::size_t>::max)(), meter_);
        return *exact_;
    }
    void isolate(const point& low, const point& high) {
        exact().isolate(low, high, intervals_, meter_);
    }

    void add(const std::vector<roots::filtered_part>& parts) {
        intervals_.reserve(parts.size() + 1);
        for (std::size_t i = 0; i < parts.size(); ++i) add(parts, i);
        decided_by_filter_ = !exact_;
    }
    /// Adds the roots in the filter's part i; if it is undecided, also those in adjacent undecided
    /// parts.
    void add(const std::vector<roots::filtered_part>& parts, std::size_t& i) {
        const roots::filtered_part& part = parts[i];
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
        isolate(low, high);
    }
    /// Both ends, ascending. A root bound replaces an infinite end. If all roots are on the other
    /// side of the finite end, both ends are the finite one.
    std::pair<point, point> ends(const roots::filtered_part& part) {
        const auto end = [this](double x, double other) {
            if (std::isfinite(x)) return point::from(x);
            const point bound = x > 0 ? exact().upper_bound() : exact().lower_bound();
            const bool beyond = std::isfinite(other) && (bound < point::from(other)) == (x > 0);
            return beyond ? point::from(other) : bound;
        };
        const auto quick_from = roots::exact_place(part, part.from),
                   quick_to = roots::exact_place(part, part.to);
        if (quick_from && quick_to && std::isfinite(*quick_from) && std::isfinite(*quick_to)) {
            const auto [low, high] = std::minmax(*quick_from, *quick_to);
            return {point::from(low), point::from(high)};
        }
        const point at0 = end(part.at0, part.at1), at1 = end(part.at1, part.at0);
        const point from = at0 + (at1 - at0) * point::from(part.from),
                    to = at0 + (at1 - at0) * point::from(part.to);
        return from < to ? std::pair{from, to} : std::pair{to, from};
    }

    /// Inserts the root at 0, if any, after moving ends of other intervals away from 0.
    /// Precondition: 0 is inside no other interval.
    void add_zero() {
        if (zeros_ == 0) return;
        const point zero;
        const point radius = point::from(rootless_radius());
        for (interval& root : intervals_) {
            if (root.low.is_zero()) root.low = radius.is_zero() ? exact().least_positive() : radius;
            if (root.high.is_zero())
                root.high = radius.is_zero() ? exact().greatest_negative() : -radius;
        }
        const auto next = std::find_if(intervals_.begin(), intervals_.end(),
                                       [&](const interval& root) { return zero < root.low; });
        intervals_.insert(next, interval{zero, zero, zeros_});
    }

    /// A t for which p_ has no root in [−t, t]: |c_i| t^i < |c_0|/2^i for i >= 1, so these sum to
    /// less than |c_0|.
    double rootless_radius() const {
        const std::vector<number>& c = p_.floating();
        const double first = std::abs(c[0].value()) - c[0].error();
        if (!(first > 0)) return 0;
        int exponent = std::numeric_limits<double>::max_exponent - 1;
        for (std::size_t i = 1; i < c.size(); ++i) {
            const double size = std::abs(c[i].value()) + c[i].error();
            if (size == 0) continue;
            // In every rounding direction, the exact `first` is at least 2^(ilogb(first) − 1), and
            // the exact `size` below 2^(ilogb(size) + 2).
            const int quotient = std::ilogb(first) - 1 - (std::ilogb(size) + 2);
            const int degree = static_cast<int>(i);
            const int root =
                quotient >= 0 ? quotient / degree : -((degree - 1 - quotient) / degree);
            exponent = (std::min)(exponent, root - 1);
        }
        return std::ldexp(1.0, exponent);
    }
    /// The root, enclosed around a double.
    static number enclosure(const interval& root) {
        using traits = number_traits<double>;
        const double low = root.low.to_double(), high = root.high.to_double();
        const double size = (std::max)(std::abs(low), std::abs(high));
        return number::within(
            low + (high - low) / 2,
            (high - low) / 2 + 4 * traits::epsilon() * size + 4 * traits::underflow_unit());
    }
    sign_type floating_sign_at(const number& x) const {
        return sign_of(roots::value_at(p_.floating(), x));
    }

    /// At most a quarter of the distance of doubles near the interval's larger end.
    static point quarter_ulp(const interval& root) {
        using limits = std::numeric_limits<double>;
        const int exponent = floor_log2((std::max)(magnitude(root.low), magnitude(root.high)));
        return point::power_of_two((std::max)(exponent, limits::min_exponent - 1) - limits::digits -
                                   1);
    }

    /// Narrows a root's interval to about double's precision, without integers. False on failure.
    bool narrow(interval& root) {
        if (root.is_point() || root.multiplicity % 2 == 0) return false;
        const sign_type before = floating_sign_at(enclosure({root.low, root.low}));
        const double low = root.low.to_double(), high = root.high.to_double();
        if (!certain(before) || !std::isfinite(low) || !std::isfinite(high)) return false;
        const double x = approximate_root(low, high, before == sign_type::negative);
        bool narrowed = false;
        for (const bool left : {true, false}) {
            double distance = (std::max)(number_traits<double>::epsilon() * std::abs(x),
                                         number_traits<double>::underflow_unit());
            for (;; distance *= 16) {
                const double t = left ? x - distance : x + distance;
                if (!(low < t && t < high)) break;
                if (floating_sign_at(number(t)) != (left ? before : -before)) continue;
                const point end = point::from(t);
                if (!(root.low < end && end < root.high)) break;
                (left ? root.low : root.high) = end;
                narrowed = true;
                break;
            }
        }
        return narrowed;
    }
    /// Newton's method in doubles; halves the bracket when steps do not halve.
    double approximate_root(double low, double high, bool rising) const {
        double x = low + (high - low) / 2, last_step = high - low;
        for (int i = 0; i < 4 * number_traits<double>::digits; ++i) {
            double y = 0, slope = 0;
            for (auto c = p_.floating().rbegin(); c != p_.floating().rend(); ++c) {
                slope = slope * x + y;
                y = y * x + c->value();
            }
            if (y == 0) break;
            ((y < 0) == rising ? low : high) = x;
            double next = x - y / slope;
            if (!(low < next && next < high && 2 * std::abs(next - x) <= last_step))
                next = low + (high - low) / 2;
            if (next == x) break;
            last_step = std::abs(next - x);
            x = next;
        }
        return x;
    }

    static bool is_at(const interval& root, double x) {
        return std::isfinite(x) && root.low == point::from(x);
    }
    /// The polynomial's sign at a point of [a, b], a < b, that is no root; or at a = b.
    sign_type sign_beside_roots(double a, double b) {
        const point x = beside_roots(a, b);
        const number place = enclosure({x, x});
        const sign_type power = zeros_ % 2 == 1 ? sign_of(x) : sign_type::positive;
        const sign_type s = floating_sign_at(place);
        return power * (certain(s) ? s : roots::sign_at(p_.exact(), x, meter_));
    }
    point beside_roots(double a, double b) const {
        if (intervals_.empty()) return point::from(std::isfinite(a) ? a : std::isfinite(b) ? b : 0);
        const interval& first = intervals_[0];
        if (!first.is_point()) return first.low;
        const point one = point::power_of_two(0);
        if (!std::isfinite(a)) return first.low - one;
        if (point::from(a) < first.low) return middle(point::from(a), first.low);
        if (size() == 1)
            return std::isfinite(b) ? middle(first.low, point::from(b)) : first.low + one;
        return intervals_[1].is_point() ? middle(first.low, intervals_[1].low) : intervals_[1].low;
    }

    roots::staged_polynomial<Integer> p_;  ///< divided by x^zeros_
    int zeros_ = 0;
    roots::work_meter meter_;
    std::optional<roots::root_isolation<Integer>> exact_;
    std::vector<interval> intervals_;
    bool everywhere_ = false;
    bool decided_by_filter_ = false;
};

}  // namespace errbound
