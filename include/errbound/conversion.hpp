// Converts tracked numbers to another number type. The bound includes the conversion's error.
//   const errbound::tracked<double> x = ...;
//   errbound::convert<float>(x);                                // same rule
//   errbound::convert<errbound::bfloat16, errbound::sharp>(x);  // another rule
// Uses only |value() − x| <= error(). A number that the new type holds keeps its value and bound.
#pragma once

#include <bit>
#include <cstdint>
#include <errbound/tracked.hpp>
#include <type_traits>

namespace errbound {

namespace detail {

template <class Wide, class Narrow>
inline constexpr bool holds_numbers_of = [] {
    using wide = number_traits<Wide>;
    using narrow = number_traits<Narrow>;
    return has_subnormals<Wide> && has_subnormals<Narrow> && wide::digits >= narrow::digits &&
           wide::max_exponent >= narrow::max_exponent &&
           wide::min_exponent - wide::digits <= narrow::min_exponent - narrow::digits;
}();

template <class From, class To>
constexpr auto type_of_both() {
    if constexpr (holds_numbers_of<From, To>)
        return From();
    else if constexpr (holds_numbers_of<To, From>)
        return To();
    else
        return float();
}
/// The type that holds both types' numbers; float if neither does (float16 and bfloat16).
template <class From, class To>
using wider_of = decltype(type_of_both<From, To>());

/// x, or the neighbouring double whose last bit is 1 if x is no double. Rounding that to nearest
/// with fewer than 52 bits rounds x (Boldo, Melquiond 2008).
template <class Wide>
constexpr double rounded_to_odd(const Wide& x) {
    const auto nearest = static_cast<double>(x);
    const auto back = static_cast<Wide>(nearest);
    const auto code = std::bit_cast<std::uint64_t>(nearest);
    if (!(back < x || back > x) || code % 2 == 1) return nearest;
    return std::bit_cast<double>((back < x) == (x > 0) ? code + 1 : code - 1);
}

/// x, rounded once to nearest. A small_float converts only from built-in types.
template <class To, class From>
constexpr To nearest_in(const From& x) {
    if constexpr (requires { static_cast<To>(x); })
        return static_cast<To>(x);
    else if constexpr (holds_numbers_of<To, From>)
        return static_cast<To>(static_cast<float>(x));
    else
        return static_cast<To>(rounded_to_odd(x));
}

/// At least x >= 0; 0 only for 0. Infinite or NaN if x overflows or is NaN.
template <class To, class Wide>
constexpr To rounded_up(const Wide& x) {
    using traits = number_traits<To>;
    const To nearest = nearest_in<To>(x);
    if (!traits::is_finite(nearest) || nearest_in<Wide>(nearest) >= x) return nearest;
    // ε·nearest or η is at least its last place.
    return nearest + (rounded_product(nearest, traits::epsilon()) + traits::underflow_unit());
}

}  // namespace detail

/// x in the number type To, rounded once to nearest. The error is infinite if that overflows. With
/// v = fl(x̂): |v − x| <= |v − x̂| + e. v − x̂ is exact in a type that holds both, because it is a
/// multiple of x̂'s last place no larger than x̂. The sum is rounded once there, (1 + 2ε)(1 − ε) >=
/// 1 for ε <= 1/2, and up to To.
template <class To, class NewRule = void, class From, class Rule>
constexpr auto convert(const tracked<From, Rule>& x) {
    using number = tracked<To, std::conditional_t<std::is_void_v<NewRule>, Rule, NewRule>>;
    using wide = detail::wider_of<From, To>;
    using traits = number_traits<wide>;
    static_assert(
        detail::holds_numbers_of<wide, From> && detail::holds_numbers_of<wide, To>,
        "errbound: convert needs a type that holds the other's numbers, or float must hold both");
    const To v = detail::nearest_in<To>(x.value());
    const wide error = detail::nearest_in<wide>(x.error());
    if (!number_traits<To>::is_finite(v) || !(error >= 0))
        return number::within(v, number_traits<To>::infinity());
    const wide lost =
        traits::abs(detail::nearest_in<wide>(v) - detail::nearest_in<wide>(x.value()));
    if (lost == 0) return number::within(v, detail::rounded_up<To>(error));
    const wide sum = error + lost;
    return number::within(
        v, detail::rounded_up<To>(
               error == 0 ? lost : detail::rounded_product(sum, wide(1 + 2 * traits::epsilon()))));
}

}  // namespace errbound
