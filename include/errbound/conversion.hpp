// Tracked numbers in another number type, with what that loses among their bounds.
//
//   const errbound::tracked<double> x = ...;
//   errbound::convert<float>(x);                        // by the same rule
//   errbound::convert<errbound::bfloat16, errbound::sharp>(x);  // by another
//
// A number is taken for what any rule says of it, |value() − x| <= error(), and handed to the rule
// of the result as `within`. What the result's type holds exactly is kept exactly, value and bound.
#pragma once

#include <errbound/tracked.hpp>
#include <type_traits>

namespace errbound {

namespace detail {

/// Whether every number of type Narrow is one of type Wide.
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
/// One that holds the numbers of both; float where neither does (float16 and bfloat16).
template <class From, class To>
using wider_of = decltype(type_of_both<From, To>());

/// At least x >= 0, x a number of the wider type; 0 only for 0. What overflows or is NaN is
/// infinite or NaN.
template <class To, class Wide>
constexpr To rounded_up(const Wide& x) {
    using traits = number_traits<To>;
    const To nearest = static_cast<To>(x);
    if (!traits::is_finite(nearest) || static_cast<Wide>(nearest) >= x) return nearest;
    // ε times it is at least its last place, or η is.
    return nearest + (rounded_product(nearest, traits::epsilon()) + traits::underflow_unit());
}

}  // namespace detail

/// x in the number type To, rounded once to nearest; unknown where that overflows.
///
/// With v = fl(x̂): |v − x| <= |v − x̂| + e, and v − x̂ is exact in a type that holds both: it is a
/// multiple of x̂'s last place and no larger than x̂, or all of x̂. Their sum is rounded once in that
/// type, (1 + 2ε)(1 − ε) >= 1 for ε <= 1/2, and up to To.
template <class To, class NewRule = void, class From, class Rule>
constexpr auto convert(const tracked<From, Rule>& x) {
    using number = tracked<To, std::conditional_t<std::is_void_v<NewRule>, Rule, NewRule>>;
    using wide = detail::wider_of<From, To>;
    using traits = number_traits<wide>;
    static_assert(
        detail::holds_numbers_of<wide, From> && detail::holds_numbers_of<wide, To>,
        "errbound: convert between types of which one holds the other's numbers, or float both's");
    const To v = static_cast<To>(x.value());
    const wide error = static_cast<wide>(x.error());
    if (!number_traits<To>::is_finite(v) || !(error >= 0))
        return number::within(v, number_traits<To>::infinity());
    const wide lost = traits::abs(static_cast<wide>(v) - static_cast<wide>(x.value()));
    if (lost == 0) return number::within(v, detail::rounded_up<To>(error));
    const wide sum = error + lost;
    return number::within(
        v, detail::rounded_up<To>(
               error == 0 ? lost : detail::rounded_product(sum, wide(1 + 2 * traits::epsilon()))));
}

}  // namespace errbound
