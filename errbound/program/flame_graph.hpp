// Explanations as flame graphs.
#pragma once

#include <errbound/explain/explanation.hpp>
#include <string>
#include <vector>

namespace errbound::explaining {

/// An SVG picture, one graph below the other. The bottom bar is a result's whole error; scopes
/// stand on it and operations on scopes, each as wide as its part of the error. Tooltips show place
/// and amount. Bars thinner than a fifth of a pixel are omitted.
std::string flame_graphs(const std::vector<explanation>& results);

}  // namespace errbound::explaining
