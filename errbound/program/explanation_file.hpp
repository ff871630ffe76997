// Files of explanations, as errbound/explain/explanation.hpp writes them.
#pragma once

#include <errbound/explain/explanation.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace errbound::explaining {

/// The results in a file's text; `name` is for messages. Throws errbound::support::file_error with
/// the position.
std::vector<explanation> parse_explanations(std::string_view text, const std::string& name);

}  // namespace errbound::explaining
