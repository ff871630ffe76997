// Explanations as flame graphs.
#pragma once

#include <errbound/explain/explanation.hpp>
#include <string>
#include <vector>

namespace errbound::explaining {

/// An SVG picture, one graph below the other. A result's whole error is the bar at the bottom of
/// its graph; on a bar stand the scopes that were entered in it, and on a scope the operations in
/// it, each as wide as its part of the error. Pointing at a bar tells its place and amount. Bars
/// that are thinner than a fifth of a pixel are left out.
std::string flame_graphs(const std::vector<explanation>& results);

}  // namespace errbound::explaining
