// Instances of the check of queries for every rule.
#include <cstddef>

#include "errbound/validation/all_rules.hpp"

namespace errbound::validation {

void set_query_checks(std::span<rule> rules) {
    std::size_t i = 0;
    for_each_rule(all_rules(), [&]<class Rule>() { set_query_checks<Rule>(rules[i++]); });
}

}  // namespace errbound::validation
