// Boost.Multiprecision's numbers in validation: binary128 without subnormal numbers, and MPFR's.
// The only header of validation that needs Boost.
#pragma once

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/multiprecision/mpfr.hpp>
#include <errbound/validation/rule.hpp>

namespace errbound::validation {

/// Calls `f.operator()<T>()` for the type, in MPFR's exponent range. Precondition: is_boost(type).
template <class F>
decltype(auto) with_boost_number_type(number_type type, const F& f) {
    const exponents range = exponents::initial();
    if (type == number_type::cpp_bin_float_type)
        return f.template operator()<boost::multiprecision::cpp_bin_float_quad>();
    return f.template operator()<boost::multiprecision::mpfr_float_50>();
}

/// Adds these types to a rule that works without subnormal numbers.
template <class Rule>
constexpr void set_boost_checks(rule& r) {
    if constexpr (errbound::detail::holds_without_subnormals<Rule>) {
        const auto set = [&r]<number_type Type>() {
            r.evaluate[static_cast<std::size_t>(Type)] = [](const expression_view& e,
                                                            claim* claims) {
                with_boost_number_type(Type, [&]<class T>() { evaluate<Rule, T>(e, claims); });
            };
        };
        set.template operator()<number_type::cpp_bin_float_type>();
        set.template operator()<number_type::mpfr_float_type>();
    }
}

}  // namespace errbound::validation
