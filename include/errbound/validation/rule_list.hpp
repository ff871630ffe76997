// The one list of bound rules that validation, its tests and reports go through: a new rule is
// one line here.
#pragma once

#include <errbound/rules/affine.hpp>
#include <errbound/rules/relative.hpp>
#include <errbound/rules/stochastic.hpp>
#include <errbound/tracked.hpp>

namespace errbound {

/// Types, nothing more: what for_each_rule calls its function with.
template <class... Rules>
struct rule_types {};

using all_rules =
    rule_types<none, safe, tight, sharp, interval, residual, affine, relative, stochastic>;

template <class... Rules, class F>
constexpr void for_each_rule(rule_types<Rules...>, const F& f) {
    (f.template operator()<Rules>(), ...);
}

/// Whether the rule bounds quotients: it has `divide` and does not say has_division = false (as a
/// rule does whose `divide` is there only to tell why there is none).
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
