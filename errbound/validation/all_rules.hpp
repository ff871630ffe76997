// The checks of all rules, each kind compiled in a file of its own: they are what takes long to
// compile. Internal.
#pragma once

#include <errbound/validation/rule.hpp>
#include <span>

namespace errbound::validation {

/// Of every rule of all_rules, in its order.
void set_query_checks(std::span<rule> rules);
void set_tiny_checks(std::span<rule> rules);
void set_boost_checks(std::span<rule> rules);

}  // namespace errbound::validation
