// Decimals as tracked numbers: 0.1 as a tenth, not as the double nearest to it.
//   using namespace errbound::literals;
//   const auto tenth = 0.1_tracked;                             // tracked<double>, off by 2^-57.5
//   errbound::from_decimal<errbound::tracked<float>>("6.02e23");
//
// The value is the nearest number of the type, ties to even. The error is its distance from the
// decimal, rounded up: 0 if the type holds the decimal.
#pragma once

#include <errbound/environment.hpp>
#include <errbound/integers/decimal_number.hpp>
#include <errbound/tracked.hpp>
#include <string_view>

namespace errbound {

namespace detail {

/// Not constexpr: a call makes the literal ill-formed. Never defined.
void tracked_is_for_decimal_literals();

}  // namespace detail

/// The decimal number as Number: tracked float, double, long double, binary128 or small_float. Text
/// is as in C++, [-]123.25e-2, of any length, with decimal digits only. The error is infinite if
/// the text is no decimal or rounds to no finite number. A decimal below half of the smallest
/// number is 0 with that number as its error. The result does not depend on the rounding direction.
/// However, if the rule needs rounding to nearest, other directions give an infinite error at run
/// time. Cost: about that of strtod.
template <class Number>
constexpr Number from_decimal(std::string_view text) {
    using T = typename Number::value_type;
    const integers::decimal_text decimal(text);
    const auto nearest = decimal.well_formed() ? integers::nearest_decimal<T>(decimal)
                                               : integers::nearest_number<T>{};
    if (!nearest.finite) return Number::within(T(0), number_traits<T>::infinity());
    if (nearest.error == 0) return Number(nearest.value);
    if constexpr (!requires { requires Number::rule_type::holds_in_directed_rounding; })
        if (!std::is_constant_evaluated() && !detail::rounds_to_nearest<double>())
            return Number::within(nearest.value, number_traits<T>::infinity());
    return Number::within(nearest.value, nearest.error);
}

/// Suffixes: using namespace errbound::literals.
namespace literals {

/// 0.1_tracked is a tenth. Evaluated at compile time; 0x10 and the octal 010 do not compile.
consteval tracked<double> operator""_tracked(const char* text) {
    const std::string_view decimal(text);
    const bool octal = decimal.size() > 1 && decimal[0] == '0' &&
                       decimal.find_first_of(".eE") == std::string_view::npos;
    if (octal || !integers::decimal_text(decimal).well_formed())
        detail::tracked_is_for_decimal_literals();
    return from_decimal<tracked<double>>(decimal);
}

}  // namespace literals

}  // namespace errbound
