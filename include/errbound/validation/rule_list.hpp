// The list of bound rules for validation, tests and reports: a new rule is one line here.
#pragma once

#include <errbound/rules/affine.hpp>
#include <errbound/rules/relative.hpp>
#include <errbound/rules/stochastic.hpp>
#include <errbound/tracked.hpp>

namespace errbound {

/// Only types, for for_each_rule.
template <class... Rules>
struct rule_types {};

using all_rules =
    rule_types<none, safe, tight, sharp, interval, residual, affine, relative, stochastic>;

template <class... Rules, class F>
constexpr void for_each_rule(rule_types<Rules...>, const F& f) {
    (f.template operator()<Rules>(), ...);
}

/// True if the rule bounds quotients. (`divide` may exist only for its message: has_division =
/// false.)
template <class Rule>
inline constexpr bool has_division = [] {
    if constexpr (requires { Rule::has_division; })
        return Rule::has_division;
    else
        return requires {
            &Rule::template divide<double>;
        };
}();

}  // namespace errbound
