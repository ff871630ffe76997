// Boost.Multiprecision's numbers in validation: one of binary128's bits and exponents, but without
// subnormal numbers, and MPFR's. Needs Boost, which no other header of validation does.
#pragma once

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/multiprecision/mpfr.hpp>
#include <errbound/validation/rule.hpp>

namespace errbound::validation {

/// `f.operator()<T>()` of the type, in the range of exponents that MPFR's numbers need.
/// Precondition: is_boost(type).
template <class F>
decltype(auto) with_boost_number_type(number_type type, const F& f) {
    const exponents range = exponents::initial();
    if (type == number_type::cpp_bin_float_type)
        return f.template operator()<boost::multiprecision::cpp_bin_float_quad>();
    return f.template operator()<boost::multiprecision::mpfr_float_50>();
}

/// What the rule says of expressions in these types, if it serves numbers without subnormal ones.
template <class Rule>
constexpr void set_boost_checks(rule& r) {
    if constexpr (errbound::detail::holds_without_subnormals<Rule>) {
        const auto set = [&r]<number_type Type>() {
            r.evaluate[static_cast<std::size_t>(Type)] = [](const expression& e, claim* claims) {
                with_boost_number_type(Type, [&]<class T>() { evaluate<Rule, T>(e, claims); });
            };
        };
        set.template operator()<number_type::cpp_bin_float_type>();
        set.template operator()<number_type::mpfr_float_type>();
    }
}

}  // namespace errbound::validation
