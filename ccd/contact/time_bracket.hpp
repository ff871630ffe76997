// Brackets a root of a polynomial between adjacent doubles by its exact signs at doubles. Internal.
//
// The polynomial has coefficients of fixed width and one sign change in a given interval. A good
// estimate of the root costs two or three signs, a bad one some dozens, at most 100; the bracket is
// the same.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <errbound/bernstein.hpp>
#include <errbound/detail/bits.hpp>
#include <errbound/integers/binary_double.hpp>
#include <errbound/integers/fixed_integer.hpp>
#include <errbound/roots/double_order.hpp>
#include <optional>

#include "ccd/exact/cubic_roots.hpp"

namespace ccd::detail {

/// Holds a time: a double if low == high, else a time between two adjacent doubles. The lesser of
/// two different brackets, by low and then by high, has the earlier time. Proof:
/// proofs/times/TimeBrackets.v, lesser_bracket, least_bracket, bracket_of_first.
struct time_bracket {
    double low = 0, high = 0;
    friend constexpr auto operator<=>(const time_bracket&, const time_bracket&) = default;
};

/// Returns x·2^exponent, up to a few units in the last place.
template <int Words>
constexpr double approximated(const errbound::integers::fixed_integer<Words>& x, int exponent) {
    const int cut = std::max(0, x.bit_length() - 63);
    return std::ldexp(static_cast<double>(x.template from_bit<1>(cut).low_word()), cut + exponent);
}

/// Coefficients are scaled (errbound/bernstein.hpp). None may be the least number of its width.
template <int Words, int N>
class root_search {
  public:
    using form = errbound::bernstein<errbound::integers::fixed_integer<Words>, N>;

    explicit constexpr root_search(const form& p) : p_(p) {
        for (const auto& h : p.h) unit_ = std::max(unit_, h.bit_length());
        for (int i = 0; i <= N; ++i) floating_[i] = approximated(p[i], -unit_);
        slope_ = derivative(floating_);
    }

    /// The coefficients, rounded and scaled by one power of two.
    constexpr const std::array<double, N + 1>& floating() const { return floating_.h; }

    /// The polynomial changes its sign at exactly one root in (low, high). Returns this root, or a
    /// root without a change there that equals a `double`. `before` is the sign just above low.
    /// Returns nothing if the root is too near to 0 for fixed widths. Proof:
    /// proofs/times/TimeBrackets.v, search_right; of the loop and the number of signs,
    /// proofs/times/TimeSearch.v, between_searches, search_ends, double_numbers.
    constexpr std::optional<time_bracket> between(double low, double high,
                                                  errbound::sign_type before,
                                                  double estimate) const {
        using errbound::roots::double_of_order, errbound::roots::order_of;
        if (!(estimate > low && estimate < high)) estimate = estimate_from_start(low, high);
        std::int64_t a = order_of(low), b = order_of(high), x = order_of(estimate), step = 1;
        int corrections = 0;
        while (b - a > 1) {
            if (x <= a || x >= b) x = step == 1 ? std::clamp(x, a + 1, b - 1) : a + (b - a) / 2;
            const double t = double_of_order(x);
            const auto value = value_at(t);
            if (!value) return {};
            if (value->sign == errbound::sign_type::zero) return time_bracket{t, t};
            const bool earlier = value->sign == before;
            (earlier ? a : b) = x;
            // A Newton step, if it stays inside the interval.
            const double next = t - value->size / errbound::value_at(slope_, t);
            if (corrections++ < max_corrections && next > double_of_order(a) &&
                next < double_of_order(b)) {
                x = order_of(next);
                continue;
            }
            x += earlier ? step : -step;
            if (step < farthest_step) step *= 4;
        }
        return time_bracket{double_of_order(a), double_of_order(b)};
    }

    /// The sign at a double in [0, 1]; nothing if fixed widths do not suffice.
    constexpr std::optional<errbound::sign_type> sign_at(double t) const {
        const auto value = value_at(t);
        if (!value) return {};
        return value->sign;
    }

  private:
    static constexpr int max_corrections = 3;
    /// A power of 4; [0, 1] has almost 2^62 doubles.
    static constexpr std::int64_t farthest_step = std::int64_t{1} << 60;

    struct value_type {
        errbound::sign_type sign;
        double size;  ///< approximates the value, in units of the floating-point coefficients
    };

    /// Returns an estimate for roots near 0, where the given one has lost all digits.
    constexpr double estimate_from_start(double low, double high) const {
        const double step = floating_[0] / -slope_[0];
        return low == 0 && step > 0 && step < high ? step : low + (high - low) / 2;
    }

    constexpr std::optional<value_type> value_at(double t) const {
        const errbound::integers::binary_double d(t);
        if (d.magnitude == 0) return of_exact(p_[0], 0);
        const int zeros = errbound::detail::countr_zero(d.magnitude), bits = -(d.exponent + zeros);
        if (bits <= 62) return value_in_words<1>(d.magnitude >> zeros, bits);
        if (bits <= 126) return value_in_words<2>(d.magnitude >> zeros, bits);
        return {};
    }
    /// The value at numerator/2^bits. Proof of the widths: proofs/times/TimeSearch.v,
    /// search_widths.
    template <int T>
    constexpr value_type value_in_words(std::uint64_t numerator, int bits) const {
        using number = errbound::integers::fixed_integer<T>;
        const number t(static_cast<std::int64_t>(numerator));
        return of_exact(errbound::value_at(p_, number::shifted(1, bits) - t, t), N * bits);
    }
    template <int W>
    constexpr value_type of_exact(const errbound::integers::fixed_integer<W>& value,
                                  int bits) const {
        return {sign_of(value), approximated(value, -bits - unit_)};
    }

    const form& p_;
    int unit_ = 0;
    errbound::bernstein<double, N> floating_;
    errbound::bernstein<double, N - 1> slope_;
};

/// Precondition: p has coefficients of opposite signs, or exactly one zero. Proof:
/// proofs/times/TimeBrackets.v, linear_bracket_right.
template <int Words>
constexpr std::optional<time_bracket> bracket_of_linear_root(
    const errbound::bernstein<errbound::integers::fixed_integer<Words>, 1>& p) {
    if (p[0] == 0) return time_bracket{0, 0};
    if (p[1] == 0) return time_bracket{1, 1};
    const root_search<Words, 1> search(p);
    const auto& [start, end] = search.floating();
    return search.between(0, 1, sign_of(p[0]), start / (start - end));
}

/// A simple root in (0, 1) of a quadratic whose end coefficients are not zero. Either their signs
/// differ, or the discriminant is positive and the middle coefficient has the other sign.
enum class quadratic_root { only, first, second };

/// Estimates of the roots t/(s + t) of f0 s² + f1 st + f2 t², the lesser first.
constexpr std::array<double, 2> estimated_roots(const std::array<double, 3>& f) {
    const double root = std::sqrt(std::max(0.0, f[1] * f[1] - 4 * f[0] * f[2]));
    // x = t/s. q is a sum of two numbers of one sign.
    const double q = -(f[1] + (f[1] < 0 ? -root : root)) / 2;
    const auto place = [](double t, double s) { return t / (s + t); };
    const double x = place(q, f[2]), y = place(f[0], q);
    return {std::min(x, y), std::max(x, y)};
}

/// Proof: proofs/times/TimeBrackets.v, quadratic_only_right, quadratic_first_right,
/// quadratic_second_right.
template <int Words>
constexpr std::optional<time_bracket> bracket_of_quadratic_root(
    const errbound::bernstein<errbound::integers::fixed_integer<Words>, 2>& f,
    quadratic_root which) {
    const root_search<Words, 2> search(f);
    const auto first = sign_of(f[0]);
    const auto estimates = estimated_roots(search.floating());
    if (which == quadratic_root::only) {
        const double estimate = estimates[0] > 0 ? estimates[0] : estimates[1];
        return search.between(0, 1, first, estimate);
    }
    // Between the two roots, f has an extremum, where its slope is zero.
    const errbound::bernstein<errbound::integers::fixed_integer<Words>, 1> slope{
        {f[1] - (f[0] << 1), (f[2] << 1) - f[1]}};
    const auto extreme = bracket_of_linear_root(slope);
    if (!extreme) return {};
    const bool earlier = which == quadratic_root::first;
    const double beside = earlier ? extreme->low : extreme->high;
    const auto sign = search.sign_at(beside);
    if (!sign) return {};
    if (*sign == errbound::sign_type::zero) return time_bracket{beside, beside};
    if (*sign == first) return extreme;  // the root lies between this double and the extreme
    return earlier ? search.between(0, beside, first, estimates[0])
                   : search.between(beside, 1, -first, estimates[1]);
}

}  // namespace ccd::detail
