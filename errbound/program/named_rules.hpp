// The rules of an option --rules. Internal.
#pragma once

#include <errbound/validation/validation.hpp>
#include <string>
#include <vector>

#include "errbound/support/command_line.hpp"

namespace errbound::validation {

/// The rules of a list N[,N...], or all. Throws support::usage_error.
inline std::vector<rule> rules_named(const std::string& names) {
    if (names == "all") return {rules().begin(), rules().end()};
    return support::all_named("--rules", names, [](const std::string& name) {
        return support::entry_named("--rules", name, rules(), &rule::name);
    });
}

/// The same without rules that have no error().
inline std::vector<rule> rules_with_errors(const std::string& names) {
    std::vector<rule> all = rules_named(names);
    std::erase_if(all, [](const rule& r) { return r.error_is == error_meaning::nothing; });
    return all;
}

}  // namespace errbound::validation
