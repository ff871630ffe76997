#include <cstddef>
#include <errbound/validation/boost_numbers.hpp>

#include "errbound/validation/all_rules.hpp"

namespace errbound::validation {

void set_boost_checks(std::span<rule> rules) {
    std::size_t i = 0;
    for_each_rule(all_rules(), [&]<class Rule>() { set_boost_checks<Rule>(rules[i++]); });
}

}  // namespace errbound::validation
