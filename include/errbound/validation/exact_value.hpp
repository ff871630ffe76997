// Exact values of numbers of every format, for comparison.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <errbound/number_traits.hpp>
#include <limits>
#include <type_traits>

namespace errbound::validation {

inline constexpr int exact_bits = 4 * std::numeric_limits<double>::digits;

/// (leading + rest[0] + rest[1] + ...)·2^exponent, up to exact_bits bits; or an infinity or NaN in
/// `leading`. A double is `leading` only. Equal values have equal parts.
struct exact_value {
    double leading = 0;
    std::array<double, 3> rest{};
    int exponent = 0;

    constexpr exact_value() = default;
    constexpr exact_value(double x) : leading(x) {}

    constexpr bool is_finite() const { return std::isfinite(leading); }
    constexpr bool is_double() const { return exponent == 0 && rest[0] == 0; }
    constexpr bool operator==(const exact_value&) const = default;
};

/// log10 |x| to double's accuracy. Precondition: x is finite and not zero.
inline double log10_of(const exact_value& x) {
    return std::log10(std::abs(x.leading)) + x.exponent * std::log10(2.0);
}

template <class T>
inline constexpr bool fits_double = [] {
    using traits = number_traits<T>;
    using doubles = number_traits<double>;
    return traits::digits <= doubles::digits && traits::max_exponent <= doubles::max_exponent &&
           traits::min_exponent >= doubles::min_exponent;
}();

/// Precondition: T has at most exact_bits bits.
template <class T>
exact_value exactly(const T& x) {
    using traits = number_traits<T>;
    const auto nearest = static_cast<double>(x);
    if constexpr (fits_double<T>) {
        return nearest;
    } else {
        static_assert(traits::digits <= exact_bits);
        // numeric_limits of MPFR's numbers lacks the largest one, so is_finite is too strict.
        if (!(T(x - x) == 0) || T(nearest) == x) return nearest;
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

/// Precondition: T holds x.
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
