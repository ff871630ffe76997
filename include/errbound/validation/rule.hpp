// A bound rule as validation sees it: its name, its promises, and its code as functions.
#pragma once

#include <ccd/query.hpp>
#include <errbound/validation/expression.hpp>
#include <errbound/validation/query_check.hpp>
#include <errbound/validation/rule_list.hpp>
#include <errbound/validation/tiny_check.hpp>
#include <string_view>

namespace errbound::validation {

/// Made by rule_of; a rule that is not in errbound/validation/rule_list.hpp can be validated as
/// well.
struct rule {
    std::string_view name;
    bool promises = false;  ///< a bound at all
    bool has_division = false;
    void (*evaluate_double)(const expression&, claim*) = nullptr;
    void (*evaluate_float)(const expression&, claim*) = nullptr;
    void (*check_vertex_face)(const ccd::vertex_face<double>&, shadow_session&) = nullptr;
    void (*check_edge_edge)(const ccd::edge_edge<double>&, shadow_session&) = nullptr;
    void (*check_tiny)(std::size_t format, tiny_findings&) = nullptr;
};

/// The rule's name and promises, and what it says of expressions.
template <class Rule>
constexpr void set_expression_checks(rule& r) {
    r.name = Rule::name;
    r.promises = promises_bound<Rule>;
    r.has_division = has_division<Rule>;
    r.evaluate_double = evaluate<Rule, double>;
    r.evaluate_float = evaluate<Rule, float>;
}
template <class Rule>
constexpr void set_query_checks(rule& r) {
    r.check_vertex_face = check_query<Rule, ccd::vertex_face>;
    r.check_edge_edge = check_query<Rule, ccd::edge_edge>;
}
template <class Rule>
constexpr void set_tiny_checks(rule& r) {
    r.check_tiny = check_tiny<Rule>;
}

template <class Rule>
constexpr rule rule_of() {
    rule r;
    set_expression_checks<Rule>(r);
    set_query_checks<Rule>(r);
    set_tiny_checks<Rule>(r);
    return r;
}

}  // namespace errbound::validation
