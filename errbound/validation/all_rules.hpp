// The checks of all rules, each kind in a separate file, since they compile slowly. Internal.
#pragma once

#include <errbound/validation/rule.hpp>
#include <span>

namespace errbound::validation {

void set_tiny_checks(std::span<rule> rules);
void set_boost_checks(std::span<rule> rules);

}  // namespace errbound::validation
