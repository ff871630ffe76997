// Intervals of doubles, rounded outwards: the bound rule `interval` without a value. Internal.
#pragma once

#include <algorithm>
#include <cmath>
#include <errbound/elementary.hpp>
#include <errbound/rules/interval.hpp>
#include <errbound/validation/mpfr_functions.hpp>
#include <limits>

namespace errbound::validation {

/// All x with lower <= x <= upper. Overflow and undefined operations give [−∞, ∞], as do sums,
/// products (except with exactly 0) and quotients of it.
class range {
  public:
    constexpr range() = default;
    constexpr range(double point) : range(point, point) {}
    constexpr range(double lower, double upper) : ends_{lower, upper} {}
    static constexpr range unknown() {
        return {-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
    }
    /// [value − error, value + error].
    static range within(double value, double error) {
        return interval::within<double>(value, error);
    }

    double lower() const { return ends_.lower; }
    double upper() const { return ends_.upper; }
    bool is_finite() const { return std::isfinite(ends_.lower) && std::isfinite(ends_.upper); }
    bool is_point() const { return ends_.lower == ends_.upper; }
    bool has_zero() const { return ends_.lower <= 0 && ends_.upper >= 0; }
    /// max |x| and min |x|.
    double most() const { return std::max(std::abs(ends_.lower), std::abs(ends_.upper)); }
    double least() const {
        return has_zero() ? 0 : std::min(std::abs(ends_.lower), std::abs(ends_.upper));
    }
    double middle() const { return lower() / 2 + upper() / 2; }

    range operator-() const { return {-ends_.upper, -ends_.lower}; }
    friend range operator+(const range& a, const range& b) {
        return interval::add<double>(a.lower() + b.lower(), a.operand(), b.operand());
    }
    friend range operator-(const range& a, const range& b) { return a + -b; }
    friend range operator*(const range& a, const range& b) {
        if (!a.is_finite() || !b.is_finite()) return a.is_zero() || b.is_zero() ? 0 : unknown();
        return interval::multiply<double>(a.lower() * b.lower(), a.operand(), b.operand());
    }
    friend range operator/(const range& a, const range& b) {
        if (!a.is_finite() || !b.is_finite()) return unknown();
        return interval::divide<double>(a.lower() / b.lower(), a.operand(), b.operand());
    }
    range& operator+=(const range& b) { return *this = *this + b; }
    friend range sqrt(const range& a) {
        return interval::square_root<double>(std::sqrt(a.lower()), a.operand());
    }
    friend range square(const range& a) {
        if (!a.is_finite()) return unknown();
        const range size(a.least(), a.most()), product = size * size;
        return {std::max(product.lower(), 0.0), product.upper()};
    }
    friend range abs(const range& a) { return {a.least(), a.most()}; }
    friend range min(const range& a, const range& b) {
        return {std::min(a.lower(), b.lower()), std::min(a.upper(), b.upper())};
    }
    friend range max(const range& a, const range& b) {
        return {std::max(a.lower(), b.lower()), std::max(a.upper(), b.upper())};
    }
    friend range hull(const range& a, const range& b) {
        return {std::min(a.lower(), b.lower()), std::max(a.upper(), b.upper())};
    }
    /// Precondition: both enclose the same numbers, but rounding may put a number just outside one
    /// of them. If they are disjoint, returns a.
    friend range common(const range& a, const range& b) {
        const range r(std::max(a.lower(), b.lower()), std::min(a.upper(), b.upper()));
        return r.lower() <= r.upper() ? r : a;
    }

  private:
    constexpr range(const interval::bound<double>& ends) : ends_(ends) {}
    rule_operand<double, interval> operand() const { return {ends_.lower, ends_}; }
    bool is_zero() const { return ends_.lower == 0 && ends_.upper == 0; }

    interval::bound<double> ends_{0, 0};
};

/// A function and its first two derivatives over a range.
struct function_range {
    range value, slope, curvature;
};

/// F at x, enclosed by function_error. Precondition: x is in F's domain, and no large angle.
template <elementary_function F, class... X>
range function_at(const X&... x) {
    if constexpr (function_error<F, double> != 0) {
        const double v = detail::system_function<F>(x...);
        if (std::isfinite(v))
            return range::within(v, detail::enlarged<double>(detail::error_of_function<F>(v)));
    }
    return range::unknown();
}
/// F within `reach` of x.
template <elementary_function F>
detail::bounded<double> function_around(double x, double reach) {
    if constexpr (function_error<F, double> != 0) return detail::function_of_range<F>(x, reach);
    return {0, std::numeric_limits<double>::infinity()};
}

/// F over a; unknown if a has numbers outside of the domain, or if F may have a pole there.
template <elementary_function F>
range function_over(const range& a) {
    using enum elementary_function;
    const double low = a.lower(), high = a.upper();
    if (!a.is_finite()) return range::unknown();
    const auto both = [](double x, double y) { return hull(function_at<F>(x), function_at<F>(y)); };
    if constexpr (F == log || F == log2 || F == log10)
        if (!(low > 0)) return range::unknown();
    if constexpr (F == log1p)
        if (!(low > -1)) return range::unknown();
    if constexpr (F == asin || F == acos)
        if (!(a.most() <= 1)) return range::unknown();
    if constexpr (F == atanh)
        if (!(a.most() < 1)) return range::unknown();
    if constexpr (F == acosh)
        if (!(low >= 1)) return range::unknown();
    if constexpr (F == cosh) return both(a.least(), a.most());
    if constexpr (detail::is_function_of_angle(F)) {
        const range all = F == tan ? range::unknown() : range(-1, 1);
        if (!(a.most() < detail::least_reduced_angle)) return all;
        const double middle = a.middle();
        const double reach = (a - middle).most();
        if constexpr (F == tan) {
            // A finite error means no pole, so that the tangent is monotone.
            const auto whole = function_around<tan>(middle, reach);
            return std::isfinite(whole.error) ? both(low, high) : all;
        } else {
            // F is monotone if its derivative, ±sin or cos, has no zero.
            constexpr elementary_function other = F == sin ? cos : sin;
            const auto slope = function_around<other>(middle, reach);
            if (std::abs(slope.value) > slope.error) return common(both(low, high), all);
            const auto whole = function_around<F>(middle, reach);
            return common(all, range::within(whole.value, whole.error));
        }
    }
    return both(low, high);  // monotone
}

/// x^y over a and b; unknown unless a > 0, or b is a whole number (not negative if a may be 0).
inline range power_over(const range& a, const range& b) {
    constexpr auto pow = elementary_function::pow;
    if (!a.is_finite() || !b.is_finite()) return range::unknown();
    if (a.lower() > 0)  // monotone in both
        return hull(
            hull(function_at<pow>(a.lower(), b.lower()), function_at<pow>(a.lower(), b.upper())),
            hull(function_at<pow>(a.upper(), b.lower()), function_at<pow>(a.upper(), b.upper())));
    const double n = b.lower();
    if (!b.is_point() || std::trunc(n) != n || (n < 0 && a.has_zero())) return range::unknown();
    if (n == 0) return 1;
    const bool odd = std::fmod(n, 2) != 0;
    const auto at = [&](double x) { return x == 0 ? range(0) : function_at<pow>(x, n); };
    return odd ? hull(at(a.lower()), at(a.upper())) : hull(at(a.least()), at(a.most()));
}

/// atan2 over two ranges.
inline range angle_over(const range& y, const range& x) {
    // The angle jumps at the negative x axis.
    if (!y.is_finite() || !x.is_finite() || (y.has_zero() && !(x.lower() > 0)))
        return range::unknown();
    if constexpr (function_error<elementary_function::atan2, double> != 0) {
        const double m = y.middle(), n = x.middle();
        const auto r = detail::angle_of_ranges<double>(m, (y - m).most(), n, (x - n).most());
        if (std::isfinite(r.error)) return range::within(r.value, r.error);
    }
    return range::unknown();
}

/// f over a, and b if it has two arguments.
inline range function_value(elementary_function f, const range& a, const range& b) {
    return with_function(f, [&]<elementary_function F>() {
        if constexpr (F == elementary_function::pow)
            return power_over(a, b);
        else if constexpr (F == elementary_function::atan2)
            return angle_over(a, b);
        else
            return function_over<F>(a);
    });
}

/// F and its derivatives over a. Precondition: F has one argument.
template <elementary_function F>
function_range derivatives_over(const range& a) {
    using enum elementary_function;
    const range v = function_over<F>(a);
    const range ln2(0x1.62e42fefa39efp-1, 0x1.62e42fefa39f0p-1);
    const range ln10(0x1.26bb1bbb55515p+1, 0x1.26bb1bbb55516p+1);
    const auto reciprocal = [](const range& x, const range& unit) {
        const range r = 1 / (x * unit);
        return std::pair(r, -r / x);
    };
    const auto with = [&](const range& slope, const range& curvature) {
        return function_range{v, slope, curvature};
    };
    /// ±1/√s and its derivative, for s = ±(1 − a²) or 1 + a² with s' = 2·turn·a.
    const auto root = [&](const range& s, double sign, double turn) {
        const range r = range(sign) / sqrt(s);
        return function_range{v, r, range(-turn) * a * r / s};
    };
    const range square_of_a = square(a);
    if constexpr (F == exp) return with(v, v);
    if constexpr (F == exp2) return with(v * ln2, v * ln2 * ln2);
    if constexpr (F == expm1) return with(function_over<exp>(a), function_over<exp>(a));
    if constexpr (F == log || F == log2 || F == log10) {
        const auto [slope, curvature] = reciprocal(a, F == log ? range(1) : F == log2 ? ln2 : ln10);
        return with(slope, curvature);
    }
    if constexpr (F == log1p) {
        const auto [slope, curvature] = reciprocal(1 + a, 1);
        return with(slope, curvature);
    }
    if constexpr (F == sin) return with(function_over<cos>(a), -v);
    if constexpr (F == cos) return with(-function_over<sin>(a), -v);
    if constexpr (F == tan) return with(1 + square(v), 2 * v * (1 + square(v)));
    if constexpr (F == asin || F == acos) return root(1 - square_of_a, F == asin ? 1 : -1, -1);
    if constexpr (F == asinh) return root(1 + square_of_a, 1, 1);
    if constexpr (F == acosh) return root(square_of_a - 1, 1, 1);
    if constexpr (F == atan) {
        const range r = 1 / (1 + square_of_a);
        return with(r, -2 * a * square(r));
    }
    if constexpr (F == atanh) {
        const range r = 1 / (1 - square_of_a);
        return with(r, 2 * a * square(r));
    }
    if constexpr (F == sinh) return with(function_over<cosh>(a), v);
    if constexpr (F == cosh) return with(function_over<sinh>(a), v);
    if constexpr (F == tanh) return with(1 - square(v), -2 * v * (1 - square(v)));
    const range r = 1 / (3 * square(v));  // cbrt
    return with(r, -2 * r / (3 * (v * square(v))));
}

}  // namespace errbound::validation
