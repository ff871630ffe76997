// The bound rules that a report compares.
#pragma once

#include <errbound/tracked.hpp>
#include <type_traits>

namespace ccd::report {

/// Calls visit(std::type_identity<Rule>()) for every rule with a bound.
template <class Visit>
void for_each_rule(const Visit& visit) {
    visit(std::type_identity<errbound::safe>());
    visit(std::type_identity<errbound::tight>());
}

}  // namespace ccd::report
