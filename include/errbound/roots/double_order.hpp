// Doubles numbered in order: neighbours differ by one.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <errbound/integers/dyadic.hpp>
#include <limits>

namespace errbound::roots {

/// The number of x; 0 for both zeros. Precondition: x is not NaN.
constexpr std::int64_t order_of(double x) {
    const auto size =
        static_cast<std::int64_t>(std::bit_cast<std::uint64_t>(x) & 0x7fff'ffff'ffff'ffffU);
    return x < 0 ? -size : size;
}
/// The double with that number; +0 for 0.
constexpr double double_of_order(std::int64_t number) {
    const double size =
        std::bit_cast<double>(static_cast<std::uint64_t>(number < 0 ? -number : number));
    return number < 0 ? -size : size;
}

/// The number of the greatest double <= x, possibly infinite.
template <exact_number Integer>
std::int64_t order_at_or_below(const dyadic<Integer>& x) {
    constexpr double most = (std::numeric_limits<double>::max)();
    std::int64_t number = order_of(std::clamp(x.to_double(), -most, most));
    const auto is_above = [&](std::int64_t n) {
        return n > order_of(most) ||
               (n >= -order_of(most) && x < dyadic<Integer>::from(double_of_order(n)));
    };
    while (is_above(number)) --number;
    while (!is_above(number + 1)) ++number;
    return number;
}
template <exact_number Integer>
std::int64_t order_at_or_above(const dyadic<Integer>& x) {
    return -order_at_or_below(-x);
}

}  // namespace errbound::roots
