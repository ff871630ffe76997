#pragma once

#include <errbound/explain/explanation.hpp>
#include <string>
#include <vector>

namespace errbound::explaining {

/// Returns an SVG picture of one flame graph per result, with places and amounts as tooltips
/// (docs/how-wrong.md). Omits bars thinner than a fifth of a pixel.
std::string flame_graphs(const std::vector<explanation>& results);

}  // namespace errbound::explaining
