// Files of explanations, as errbound/explain/explanation.hpp writes them.
#pragma once

#include <errbound/explain/explanation.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace errbound::explaining {

/// The results of a file's text, which messages call `name`. Throws errbound::support::file_error,
/// which names the place in the text, what was found and what was expected.
std::vector<explanation> parse_explanations(std::string_view text, const std::string& name);

}  // namespace errbound::explaining
