// A bound rule as validation sees it: its name, its promises, and its code as functions.
#pragma once

#include <ccd/query.hpp>
#include <string_view>

#include "errbound/validation/expression.hpp"
#include "errbound/validation/query_check.hpp"
#include "errbound/validation/rule_list.hpp"
#include "errbound/validation/tiny_check.hpp"

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

template <class Rule>
constexpr rule rule_of() {
    return {Rule::name,
            promises_bound<Rule>,
            has_division<Rule>,
            evaluate<Rule, double>,
            evaluate<Rule, float>,
            check_query<Rule, ccd::vertex_face>,
            check_query<Rule, ccd::edge_edge>,
            check_tiny<Rule>};
}

}  // namespace errbound::validation
