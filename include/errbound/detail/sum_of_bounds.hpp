// The bound of a sum: its rounding error and the operands' bounds. The factor 1 + 8ε for a bound's
// roundings also enlarges the operands' bounds: n times in a sum of n terms. If these are below 2^k
// times the sum's own error, 2^k = 2^-10/ε, the factor adds at most 2^-7 of that error. Otherwise
// bounds are added upwards. Types of 40 bits or more use only the factor.
#pragma once

#include <algorithm>
#include <errbound/detail/power_of_two.hpp>
#include <errbound/detail/rounded.hpp>
#include <errbound/number_traits.hpp>

namespace errbound::detail {

/// At least x + y, for x, y >= 0, in any rounding direction; equal to x + y if T holds that number.
/// For x >= y, fl(x + y) − x is exact. Proof: proofs/floats/Upper.v, sum_above_sound,
/// sum_above_exact, sum_above_least.
template <class T>
constexpr T sum_above(const T& x, const T& y) {
    const T sum = x + y;
    const bool rounded_down = sum - (x < y ? y : x) < (y < x ? y : x);
    return rounded_down ? rounded_product(sum, T(1 + number_traits<T>::epsilon())) : sum;
}

/// A bound of own + (x + y), for own, x, y >= 0, that is at most `enlarged`. Precondition:
/// `enlarged` is such a bound: the computed sum times the factor above. Proof:
/// proofs/floats/Upper.v, sum_of_bounds_sound, sum_of_bounds_at_most.
template <class T>
constexpr T sum_of_bounds(const T& enlarged, const T& own, const T& x, const T& y) {
    constexpr int digits = number_traits<T>::digits;
    if constexpr (digits < 40 && has_subnormals<T>) {
        constexpr double few = power_of_two((std::max)(digits - 11, 0));
        if (rounded_product(own, T(few)) < x + y) {
            const T careful = sum_above<T>(own, sum_above<T>(x, y));
            return careful < enlarged ? careful : enlarged;
        }
    }
    return enlarged;
}

}  // namespace errbound::detail
