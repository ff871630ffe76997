// What numbers of every format are taken to for comparison: their values, exactly.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <errbound/number_traits.hpp>
#include <limits>
#include <type_traits>

namespace errbound::validation {

/// (leading + rest[0] + rest[1] + ...)·2^exponent, a number of up to 212 bits; or an infinity or
/// NaN, which `leading` is. What a double holds is `leading` alone. Equal values are equal in
/// parts.
struct exact_value {
    double leading = 0;
    std::array<double, 3> rest{};
    int exponent = 0;

    constexpr exact_value() = default;
    constexpr exact_value(double x) : leading(x) {}

    constexpr bool is_finite() const { return std::isfinite(leading); }
    constexpr bool is_double() const { return exponent == 0 && rest[0] == 0; }
    constexpr bool operator==(const exact_value&) const = default;

    friend exact_value abs(const exact_value& x) { return x.leading < 0 ? -x : x; }
    exact_value operator-() const {
        exact_value r = *this;
        r.leading = -r.leading;
        for (double& part : r.rest) part = -part;
        return r;
    }
};

/// log10 |x| of a number that is finite and not zero, to double's accuracy.
inline double log10_of(const exact_value& x) {
    return std::log10(std::abs(x.leading)) + x.exponent * std::log10(2.0);
}

/// Whether every T is a double.
template <class T>
inline constexpr bool fits_double =
    number_traits<T>::digits <=
    std::numeric_limits<double>::digits&& number_traits<T>::max_exponent <=
    std::numeric_limits<double>::max_exponent&& number_traits<T>::min_exponent >=
    std::numeric_limits<double>::min_exponent;

/// Precondition: T has at most 212 bits.
template <class T>
exact_value exactly(const T& x) {
    using traits = number_traits<T>;
    const auto near = static_cast<double>(x);
    if constexpr (fits_double<T>) {
        return near;
    } else {
        static_assert(traits::digits <= 4 * std::numeric_limits<double>::digits);
        // (numeric_limits of MPFR's numbers has not the largest one: is_finite is too strict.)
        if (!(T(x - x) == 0) || T(near) == x) return near;
        exact_value r;
        r.exponent = traits::exponent(x);
        T left = traits::scale(x, -r.exponent);
        r.leading = static_cast<double>(left);
        left -= T(r.leading);
        for (std::size_t i = 0; left != 0; ++i) {
            r.rest[i] = static_cast<double>(left);
            left -= T(r.rest[i]);
        }
        return r;
    }
}

/// Precondition: T has it.
template <class T>
T number_of(const exact_value& x) {
    if constexpr (fits_double<T>) {
        return static_cast<T>(x.leading);
    } else {
        T sum = static_cast<T>(x.leading);
        for (const double part : x.rest) sum += static_cast<T>(part);  // exact: ever fewer bits
        return x.exponent == 0 ? sum : T(number_traits<T>::scale(sum, x.exponent));
    }
}

}  // namespace errbound::validation
