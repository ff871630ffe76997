// Bound rules on stored queries, compared with MPFR: the forms and BSC, operation by operation, in
// double. Only in a build with MPFR.
#pragma once

#include <errbound/validation/validation.hpp>
#include <span>
#include <string_view>
#include <vector>

#include "ccd/io/stored_kinds.hpp"
#include "ccd/lab/validation/query_check.hpp"

namespace ccd::lab {

template <class Query>
using query_checker = void (*)(const Query&, shadow_session&);

struct query_rule {
    std::string_view name;
    errbound::error_meaning error_is = errbound::error_meaning::nothing;
    double claimed_rate = 0;
    by_stored_kind<query_checker> check;
};
template <class Rule>
constexpr query_rule query_rule_of() {
    return {Rule::name,
            errbound::meaning_of_error<Rule>,
            errbound::claimed_rate<Rule>,
            {check_query<Rule, vertex_face>, check_query<Rule, edge_edge>}};
}

/// Every rule of errbound/validation/rule_list.hpp.
std::vector<query_rule> query_rules();

/// The queries must outlive the evidence. Cost: about a millisecond per query and rule.
template <class Query>
errbound::validation::evidence evidence_of_queries(std::span<const query_rule> rules,
                                                   std::span<const Query> queries);

}  // namespace ccd::lab
