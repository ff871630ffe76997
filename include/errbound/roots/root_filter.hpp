// Real roots of polynomials in floating point, by Descartes' rule on tracked Bernstein
// coefficients: certain roots and undecided intervals. The first stage of real_roots.hpp. Values
// and bounds are separate arrays, so that halving, by additions only, is vectorised.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <errbound/error_free.hpp>
#include <errbound/number_traits.hpp>
#include <errbound/roots/sign_variations.hpp>
#include <errbound/rules/rule.hpp>
#include <errbound/tracked.hpp>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace errbound::roots {

/// A rule that stores only the absolute error.
template <class Rule>
concept absolute_rule = bound_rule<Rule> && requires(typename Rule::template bound<double> b) {
    requires sizeof(b) == sizeof(double);
    b.error;
};

/// An interval: x = at0 + (at1 − at0)·u for from <= u <= to, with these exact doubles.
struct filtered_part {
    double at0, at1;
    double from, to;
    bool has_one_root;  ///< simple and strictly inside, none at the ends; otherwise undecided
};

/// The part's x at u, if it is certainly a double.
inline std::optional<double> exact_place(const filtered_part& part, double u) {
    if (u == 0) return part.at0;
    if (u == 1) return part.at1;
    const auto width = two_sum(part.at1, -part.at0);
    const auto offset = two_product(width.value, u);
    const auto x = two_sum(part.at0, offset.value);
    const bool exact = width.error == 0 && offset.error == 0 && x.error == 0 &&
                       product_error_is_exact(width.value, u, offset);
    return exact ? std::optional(x.value) : std::nullopt;
}

/// Control values with errors, in the caller's arrays.
template <absolute_rule Rule>
struct tracked_row {
    double* value;
    double* error;

    void add_next(std::size_t count) const {
        double* const __restrict v = value;
        double* const __restrict e = error;
        for (std::size_t j = 0; j < count; ++j) {
            const double sum = v[j] + v[j + 1];
            e[j] = sum_error(sum, v[j], e[j], v[j + 1], e[j + 1]);
            v[j] = sum;
        }
    }
    void add_previous(std::size_t first, std::size_t last) const {
        double* const __restrict v = value;
        double* const __restrict e = error;
        for (std::size_t j = last; j >= first; --j) {
            const double sum = v[j] + v[j - 1];
            e[j] = sum_error(sum, v[j], e[j], v[j - 1], e[j - 1]);
            v[j] = sum;
        }
    }
    /// this[j] *= factor[j] for first <= j <= last, powers of two <= 1. Underflow changes value and
    /// error by less than the smallest number each; 1 + 4ε covers two roundings.
    void shrink(const double* factor, std::size_t first, std::size_t last) const {
        constexpr double lost = 2 * number_traits<double>::underflow_unit();
        for (std::size_t j = first; j <= last; ++j) {
            value[j] *= factor[j];
            error[j] = (error[j] * factor[j] + lost) * (1 + 4 * number_traits<double>::epsilon());
        }
    }
    /// 1 or −1 for a certain sign, otherwise 0.
    int sign(std::size_t j) const {
        return (value[j] > error[j] ? 1 : 0) - (value[j] < -error[j] ? 1 : 0);
    }
    int variations(std::size_t count) const {
        return max_sign_variations(count, [this](std::size_t j) { return sign(j); });
    }

  private:
    static double sum_error(double sum, double a, double a_error, double b, double b_error) {
        using bound = typename Rule::template bound<double>;
        return Rule::template add<double>(sum, {a, bound{a_error}}, {b, bound{b_error}}).error;
    }
};

/// Cost: on each side of 0, at most max_halvings halvings of degree²/2 additions; few for separated
/// roots.
template <absolute_rule Rule>
class root_filter {
  public:
    using number = tracked<double, Rule>;

    /// Up to this n, binomials and their products with n are exact in double.
    static constexpr std::size_t max_degree = 50;
    static constexpr int max_halvings = 200;
    /// A part [from, to] is halved if its width is at least this times `to`. Ends then have at most
    /// 48 bits, so they are doubles.
    static constexpr double narrowest = 0x1p-46;
    static constexpr std::size_t max_rows = 64;

    /// The parts of [a, b] that have or may have a root, ascending. Precondition: a < b, possibly
    /// infinite. Coefficients ascend in the power basis; empty is zero.
    root_filter(std::span<const number> coefficients, double a, double b) {
        const std::size_t size = coefficients.size();
        if (size == 0 || size - 1 > max_degree || !is_strict(sign_of(coefficients.back()))) {
            parts_.push_back({a, b, 0, 1, false});
            return;
        }
        if (size == 1) return;
        double largest = 0;
        for (const number& c : coefficients) largest = (std::max)(largest, std::abs(c.value()));
        // Scales extreme coefficients, so that powers, binomials and sums stay in range.
        int e = number_traits<double>::exponent(largest);
        if (std::abs(e) < number_traits<double>::max_exponent / 2) e = 0;
        c_ = {first_.data(), size};
        for (std::size_t i = 0; i < size; ++i)
            c_[i] = e == 0 ? coefficients[i] : scale(coefficients[i], -e);
        if (a < 0) {
            for (std::size_t i = 1; i < size; i += 2) c_[i] = -c_[i];
            on_half_line(b < 0 ? -b : 0, -a);
            std::reverse(parts_.begin(), parts_.end());
            for (filtered_part& p : parts_) p.at0 = -p.at0, p.at1 = -p.at1;
            for (std::size_t i = 1; i < size; i += 2) c_[i] = -c_[i];
        }
        if (b > 0) on_half_line(a > 0 ? a : 0, b);
    }

    const std::vector<filtered_part>& parts() const { return parts_; }
    bool decides() const {
        return std::all_of(parts_.begin(), parts_.end(),
                           [](const filtered_part& p) { return p.has_one_root; });
    }

  private:
    static bool is_strict(sign_type s) {
        return s == sign_type::positive || s == sign_type::negative;
    }

    /// The parts of [low, high], 0 <= low < high, for c_.
    void on_half_line(double low, double high) {
        sign_type last = sign_of(c_[0]);
        bool all_strict = is_strict(last);
        int changes = 0;
        for (std::size_t i = 1; i < c_.size(); ++i) {
            const sign_type s = sign_of(c_[i]);
            if (!certain(s)) all_strict = false;
            if (s == sign_type::zero || s == last) continue;
            ++changes;
            last = s;
        }
        if (all_strict && changes == 0) return;
        const double bound = root_bound();
        if (bound <= low) return;
        if (all_strict && changes == 1 && low == 0 && bound <= high) {
            parts_.push_back({0, bound, 0, 1, true});
            return;
        }
        at0_ = low, at1_ = (std::min)(high, bound);
        if (!std::isfinite(at1_)) {
            parts_.push_back({low, high, 0, 1, false});
            return;
        }
        subdivide();
    }

    /// A bound of Kioustelidis (see positive_root_exponent), not a power of two, so that ends are
    /// rarely roots that people choose. 0 if there is no positive root, infinite if the bound is
    /// out of range.
    double root_bound() const {
        const std::size_t n = c_.size() - 1;
        const auto largest = [](const number& c) {
            return (std::abs(c.value()) + c.error()) * (1 + 4 * number_traits<double>::epsilon());
        };
        const number& top = c_[n];
        const double least =
            (std::abs(top.value()) - top.error()) * (1 - 4 * number_traits<double>::epsilon());
        if (!(least >= number_traits<double>::smallest_normal()))
            return number_traits<double>::infinity();
        const int last = std::ilogb(least);
        int exponent = (std::numeric_limits<int>::min)();
        for (std::size_t i = 0; i < n; ++i) {
            const sign_type s = sign_of(c_[i]);
            if (s == sign_type::zero || s == sign_of(top)) continue;
            if (!std::isfinite(largest(c_[i]))) return number_traits<double>::infinity();
            const int quotient = std::ilogb(largest(c_[i])) + 1 - last;
            const int degree = static_cast<int>(n - i);
            exponent = (std::max)(exponent, 1 + (quotient > 0 ? (quotient + degree - 1) / degree
                                                              : quotient / degree));
        }
        if (exponent == (std::numeric_limits<int>::min)()) return 0;
        return (std::max)(std::ldexp(45.0 / 32, exponent),
                          number_traits<double>::smallest_normal());
    }

    void set_control_values() {
        const std::size_t n = c_.size() - 1;
        const number high(at1_);
        std::array<number, max_degree + 1> b;
        number power = high;
        double binomial = 1;
        b[0] = c_[0];
        for (std::size_t i = 1; i <= n; ++i) {
            binomial = binomial * static_cast<double>(n - i + 1) / static_cast<double>(i);
            b[i] = c_[i] * power;
            if (i == n) break;
            b[i] /= number(binomial);
            power *= high;
        }
        rows_.resize(16 * (n + 1));
        const auto first = row(0);
        for (std::size_t i = 0; i <= n; ++i) {
            first.value[i] = b[i].value();
            first.error[i] = b[i].error();
        }
        for (std::size_t i = 1; i <= n; ++i) first.add_previous(i, n);
        if (at0_ == 0) return;
        // `first` belongs to [0, at1]; de Casteljau's scheme gives its part [at0, at1].
        for (std::size_t i = 0; i <= n; ++i) b[i] = number::within(first.value[i], first.error[i]);
        const number right = number(at0_) / high, left = (high - number(at0_)) / high;
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t j = 0; j < n - i; ++j) b[j] = b[j] * left + b[j + 1] * right;
        for (std::size_t i = 0; i <= n; ++i) {
            first.value[i] = b[i].value();
            first.error[i] = b[i].error();
        }
    }

    tracked_row<Rule> row(std::size_t k) {
        const std::size_t size = c_.size();
        return {&rows_[2 * k * size], &rows_[(2 * k + 1) * size]};
    }

    /// De Casteljau's scheme without the powers of two; `whole` becomes the right half.
    static void take_left_half(const tracked_row<Rule>& whole, const tracked_row<Rule>& left,
                               std::size_t n) {
        for (std::size_t i = 0; i <= n; ++i) {
            left.value[i] = whole.value[0];
            left.error[i] = whole.error[0];
            whole.add_next(n - i);
        }
    }

    void subdivide() {
        struct span_of_u {
            double from, to;
        };
        const std::size_t size = c_.size(), n = size - 1;
        set_control_values();
        std::array<double, max_degree + 1> right_factor, left_factor;
        double factor = 1;
        for (std::size_t i = 0; i <= n; ++i, factor /= 2)
            left_factor[i] = right_factor[n - i] = factor;

        // Row k of rows_ belongs to spans[k]; the last is the leftmost.
        std::array<span_of_u, max_rows> spans;
        spans[0] = {0, 1};
        int halvings = 0;
        for (std::size_t count = 1; count > 0;) {
            const std::size_t k = count - 1;
            const auto whole = row(k);
            const auto [from, to] = spans[k];
            const int changes = whole.variations(size);
            if (changes < 2) {
                if (changes == 1) parts_.push_back({at0_, at1_, from, to, true});
                --count;
                continue;
            }
            if (changes == 2 && add_pair(from, to, whole.sign(0))) {
                --count;
                continue;
            }
            // Halving does not help ends of uncertain sign.
            if (whole.sign(0) == 0 || whole.sign(n) == 0 || halvings == max_halvings ||
                count == max_rows || to - from < narrowest * to) {
                parts_.push_back({at0_, at1_, from, to, false});
                --count;
                continue;
            }
            ++halvings;
            if (rows_.size() < 2 * (k + 2) * size) rows_.resize(2 * rows_.size());
            const auto right = row(k), left = row(k + 1);
            take_left_half(right, left, n);
            left.shrink(left_factor.data(), 1, n);
            right.shrink(right_factor.data(), 0, n - 1);
            const double half = from + (to - from) / 2;
            spans[k] = {half, to};
            spans[count++] = {from, half};
        }
    }

    /// Halving separates two close roots slowly. If at most two are left, evaluates the polynomial
    /// at its extremum in doubles. If the sign differs from `outside`, the sign at both ends, each
    /// side has one root. If the sign is uncertain or zero, the part is undecided. Tried after 4,
    /// 8, 16,
    /// ... halvings.
    bool add_pair(double from, double to, int outside) {
        const int halvings = -std::ilogb(to - from);
        if (halvings < 4 || !std::has_single_bit(static_cast<unsigned>(halvings))) return false;
        const double u = extremum(from, to);
        if (!(from < u && u < to)) return false;
        const number low(at0_), x = low + (number(at1_) - low) * number(u);
        number value = c_.back();
        for (std::size_t i = c_.size() - 1; i-- > 0;) value = value * x + c_[i];
        const sign_type s = sign_of(value);
        if (s == (outside < 0 ? sign_type::negative : sign_type::positive)) return false;
        if (is_strict(s)) {
            parts_.push_back({at0_, at1_, from, u, true});
            parts_.push_back({at0_, at1_, u, to, true});
        } else {
            parts_.push_back({at0_, at1_, from, to, false});
        }
        return true;
    }
    /// A zero of the derivative, by Newton's method from the middle, rounded to 46 bits; NaN on
    /// failure.
    double extremum(double from, double to) const {
        const double width = at1_ - at0_;
        double u = from + (to - from) / 2;
        for (int i = 0; i < 8; ++i) {
            const double x = at0_ + width * u;
            double value = 0, slope = 0, half_curvature = 0;
            for (std::size_t k = c_.size(); k-- > 0;) {
                half_curvature = half_curvature * x + slope;
                slope = slope * x + value;
                value = value * x + c_[k].value();
            }
            const double step = slope / (2 * half_curvature * width);
            u -= step;
            if (std::abs(step) <= 0x1p-30 * u) {
                const double much = u * 129;  // as split in errbound/error_free.hpp
                return much - (much - u);
            }
        }
        return std::numeric_limits<double>::quiet_NaN();
    }

    std::array<number, max_degree + 1> first_;
    std::span<number> c_;  ///< view of first_
    double at0_ = 0, at1_ = 0;
    std::vector<double> rows_;
    std::vector<filtered_part> parts_;
};

}  // namespace errbound::roots
