// A bound rule for validation: its name, its promises, and its code as functions.
#pragma once

#include <array>
#include <cstddef>
#include <errbound/validation/expression.hpp>
#include <errbound/validation/rule_list.hpp>
#include <errbound/validation/tiny_check.hpp>
#include <string_view>

namespace errbound::validation {

using evaluation = void (*)(const expression_view&, claim*);

/// Made by rule_of, also for rules outside errbound/validation/rule_list.hpp. set_boost_checks
/// (errbound/validation/boost_numbers.hpp) adds Boost's number types.
struct rule {
    std::string_view name;
    error_meaning error_is = error_meaning::nothing;
    double claimed_rate = 0;  ///< for an estimate
    bool has_division = false;
    /// Evaluates expressions, by number_type; null for unsupported types.
    std::array<evaluation, number_type_count> evaluate{};
    void (*check_tiny)(std::size_t format, bool every_bound, tiny_findings&) = nullptr;

    bool promises() const { return error_is == error_meaning::bound; }
    bool supports(number_type type) const {
        return evaluate[static_cast<std::size_t>(type)] != nullptr;
    }
};

template <class Rule>
constexpr void set_expression_checks(rule& r) {
    r.name = Rule::name;
    r.error_is = meaning_of_error<Rule>;
    r.claimed_rate = claimed_rate<Rule>;
    r.has_division = has_division<Rule>;
    for (const named_number_type& number : number_types)
        if (!is_boost(number.type))
            r.evaluate[static_cast<std::size_t>(number.type)] =
                with_number_type(number.type, []<class T>() -> evaluation {
                    if constexpr (bound_rule<Rule, T>) return &evaluate<Rule, T>;
                    return nullptr;
                });
}
template <class Rule>
constexpr void set_tiny_checks(rule& r) {
    r.check_tiny = check_tiny<Rule>;
}

template <class Rule>
constexpr rule rule_of() {
    rule r;
    set_expression_checks<Rule>(r);
    set_tiny_checks<Rule>(r);
    return r;
}

}  // namespace errbound::validation
