// Files of explanations, as errbound/explain/explanation.hpp writes them.
#pragma once

#include <errbound/explain/explanation.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace errbound::explaining {

/// Returns a file's results; `name` is for messages. Throws errbound::support::file_error.
std::vector<explanation> parse_explanations(std::string_view text, const std::string& name);

}  // namespace errbound::explaining
