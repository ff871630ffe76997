// Counts and brackets the roots in (0, 1) of a cubic with coefficients of fixed width.
//
// Floating point estimates a root; exact signs at both ends of a bracket prove it. Each bracket
// predicts the next one, with some 40 more bits.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <errbound/bernstein.hpp>
#include <errbound/detail/bits.hpp>
#include <errbound/integers/fixed_integer.hpp>
#include <errbound/roots/sign_variations.hpp>
#include <optional>
#include <type_traits>

namespace ccd::detail {

template <int Words>
using cubic_form = errbound::bernstein<errbound::integers::fixed_integer<Words>, 3>;

/// Returns 3x. Precondition: it fits.
template <class Integer>
constexpr Integer thrice(const Integer& x) {
    return (x << 1) + x;
}

/// The sign changes of a cubic's coefficients bound the number of its roots in (0, 1). Proof:
/// proofs/contact/CubicRoots.v, no_changes, one_change, odd_changes.
struct inner_sign_changes {
    int count = 0;          ///< number of changes; without changes no root, with one change one
    bool opposite = false;  ///< count is odd: the cubic has opposite signs just inside the ends
    errbound::sign_type first = errbound::sign_type::zero;  ///< sign just inside t = 0

    constexpr inner_sign_changes() = default;
    template <class Integer>
    explicit constexpr inner_sign_changes(const errbound::bernstein<Integer, 3>& y) {
        const auto changes = errbound::roots::sign_changes_of(
            y.h.size(), errbound::sign_type::zero, [&](std::size_t i) { return sign_of(y.h[i]); });
        count = changes.count;
        first = changes.first;
        opposite = first != changes.last;
    }
};

/// The Hessian of a cubic form y, a quadratic form h. A double root of y is a double root of h; h
/// is zero if y has a triple root. 4·h0·h2 − h1² is 3 times the discriminant: positive for three
/// distinct real roots t/s (infinity included), negative for one and a complex pair. If
/// coordinates differ by at most D, |y_0| and |y_3| are at most 6D³, the others 18D³, and the
/// Hessian's coefficients 648D⁶. So if 18D³ <= 2^(64·w − 4.8), it fits in 2w words. Proof:
/// proofs/contact/CubicRoots.v, any_change, one_real_root, double_root_place, triple_root_place.
template <class Integer>
constexpr auto hessian(const errbound::bernstein<Integer, 3>& y) {
    return errbound::bernstein<decltype(y[0] * y[0]), 2>{{y[1] * y[1] - thrice(y[0] * y[2]),
                                                          y[1] * y[2] - thrice(thrice(y[0] * y[3])),
                                                          y[2] * y[2] - thrice(y[1] * y[3])}};
}

/// All numbers times one power of two, without their lowest bits.
template <class Integer, std::size_t N>
constexpr std::array<double, N> approximated(const std::array<Integer, N>& x) {
    int bits = 0;
    for (const auto& number : x) bits = std::max(bits, number.bit_length());
    std::array<double, N> r;
    for (std::size_t i = 0; i < N; ++i)
        r[i] = static_cast<double>(x[i].word_from_bit(std::max(0, bits - 63)));
    return r;
}

/// Estimates a root in [0, 1] from scaled Bernstein coefficients h, by Newton's method and
/// bisection. Precondition: the end coefficients have opposite signs or are zero. Proof that it
/// lies in [0, 1]: proofs/contact/Places.v, estimated_root_inside.
constexpr double estimated_root(const std::array<double, 4>& h) {
    constexpr double precision = 0x1p-52, converged = 0x1p-30;
    constexpr int max_steps = 60;
    const bool rising = h[3] > h[0];
    // The secant's root. If an end is a root, start in the middle to find the inner one.
    double low = 0, high = 1, t = h[0] == 0 || h[3] == 0 ? 0.5 : h[0] / (h[0] - h[3]);
    for (int k = 0; k < max_steps && high - low > precision; ++k) {
        const double s = 1 - t;
        const double value = ((h[0] * s + h[1] * t) * s + h[2] * t * t) * s + h[3] * t * t * t;
        const double slope =
            (h[1] - 3 * h[0]) * s * s + 2 * (h[2] - h[1]) * s * t + (3 * h[3] - h[2]) * t * t;
        if (value == 0) return t;
        (value < 0) == rising ? low = t : high = t;
        const double newton = t - value / slope;
        const bool inside = newton > low && newton < high;
        const double next = inside ? newton : (low + high) / 2;
        const double moved = std::fabs(next - t);
        t = next;
        // The remaining error is about the square of a Newton step. Below 2^-30, a
        // further step would not improve t.
        if (moved <= (inside ? converged : precision)) break;
    }
    return t;
}

/// A cubic on the interval [index, index + 1]/2^level of the step, times a power of two. Each
/// halving multiplies its coefficients by 8; the two spare words suffice for `max_halvings`.
template <int Words>
struct cubic_part {
    static constexpr int max_halvings = 40;

    cubic_form<Words + 2> y;
    inner_sign_changes roots;
    std::int64_t index;
    int level;
};

template <int T>
struct dyadic_point {
    errbound::integers::fixed_integer<T> numerator;
    int bits;
};

/// A root between low/2^bits and high/2^bits, or equal to both. y_low and y_high are the cubic's
/// values there, times 2^(3·bits).
template <int Words, int T>
struct root_bracket {
    errbound::integers::fixed_integer<T> low, high;
    int bits;
    errbound::integers::fixed_integer<Words + 3 * T> y_low, y_high;

    constexpr bool is_root() const { return low == high; }
    constexpr std::int64_t width() const { return (high - low).low_word(); }
    /// high − low < 2^width_bits()
    constexpr int width_bits() const {
        return static_cast<int>(errbound::detail::bit_width(static_cast<std::uint64_t>(width())));
    }
};

/// Precondition: the part has opposite signs at its ends. Proof that the numerator is at most
/// 2^bits: proofs/contact/Places.v, estimated_place_bits.
template <int Words>
constexpr dyadic_point<1> estimated_place(const cubic_part<Words>& part) {
    const int bits = std::min(part.level + 48, 62), to_bits = bits - part.level;
    const double place = std::ldexp(estimated_root(approximated(part.y.h)), to_bits);
    return {(part.index << to_bits) + static_cast<std::int64_t>(place), bits};
}

/// Returns a bracket around `place` for the root of `part`; nothing if the root is too far away.
/// Preconditions: `part` has opposite signs at its ends, and place.numerator at most 64·T − 2 bits.
/// Proof, for any place: proofs/contact/CubicRoots.v, bracket_near_right.
template <int Words, int T>
constexpr std::optional<root_bracket<Words, T>> bracket_near(const cubic_form<Words>& y,
                                                             const cubic_part<Words>& part,
                                                             const dyadic_point<T>& place) {
    using number = errbound::integers::fixed_integer<T>;
    using errbound::sign_type;
    const auto end = number::shifted(1, place.bits);
    const auto to_bits = [&](std::int64_t index) {
        return number::shifted(static_cast<std::uint64_t>(index), place.bits - part.level);
    };
    const number first = to_bits(part.index), last = to_bits(part.index + 1);
    const number middle = std::min(std::max(place.numerator, first), last);
    for (const int radius : {4, 14, 24}) {
        const auto reach = number::shifted(1, radius);
        root_bracket<Words, T> r{
            std::max(middle - reach, first), std::min(middle + reach, last), place.bits, {}, {}};
        r.y_low = value_at(y, end - r.low, r.low);
        r.y_high = value_at(y, end - r.high, r.high);
        // The signs just inside the part's ends are known, even if Y is zero at an end.
        const auto at_low = r.low == first ? part.roots.first : sign_of(r.y_low);
        const auto at_high = r.high == last ? -part.roots.first : sign_of(r.y_high);
        if (at_low == sign_type::zero)
            r.high = r.low;
        else if (at_high == sign_type::zero)
            r.low = r.high;
        else if (at_low != part.roots.first || at_high == part.roots.first)
            continue;
        return r;
    }
    return {};
}

/// Estimates the root from the bracket's end values and slopes, to as many more bits as doubles
/// can. Proof of the bits: proofs/contact/Places.v, refined_place_bits.
template <int Words, int T>
constexpr dyadic_point<T + 1> refined_place(const cubic_form<Words>& y,
                                            const root_bracket<Words, T>& bracket) {
    using number = errbound::integers::fixed_integer<Words + 3 * T>;
    const auto end = errbound::integers::fixed_integer<T>::shifted(1, bracket.bits);
    // dy/dt. Its coefficients are at most twice the bound 18D³ of y's.
    const errbound::bernstein<errbound::integers::fixed_integer<Words>, 2> slope{
        {y[1] - thrice(y[0]), (y[2] - y[1]) << 1, thrice(y[3]) - y[2]}};
    const errbound::integers::fixed_integer<1> width(bracket.width());
    const number rise_at_low = width * value_at(slope, end - bracket.low, bracket.low);
    const number rise_at_high = width * value_at(slope, end - bracket.high, bracket.high);
    const std::array h{bracket.y_low, thrice(bracket.y_low) + rise_at_low,
                       thrice(bracket.y_high) - rise_at_high, bracket.y_high};
    const int more = 46 - bracket.width_bits();
    const double place =
        std::ldexp(static_cast<double>(bracket.width()) * estimated_root(approximated(h)), more);
    return {(errbound::integers::fixed_integer<T + 1>(bracket.low) << more) +
                errbound::integers::fixed_integer<T + 1>(static_cast<std::int64_t>(place)),
            bracket.bits + more};
}

}  // namespace ccd::detail
