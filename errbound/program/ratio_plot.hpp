#pragma once

#include <string>
#include <utility>
#include <vector>

namespace errbound::explaining {

/// A line of a plot: ratios by series; NaN or infinite: no mark.
using ratio_line = std::pair<std::string, std::vector<double>>;

/// Returns an SVG picture: for each line a mark per series, at the ratio on a logarithmic axis,
/// with tooltips.
std::string ratio_plot(const std::string& axis, const std::vector<std::string>& series,
                       const std::vector<ratio_line>& lines);

}  // namespace errbound::explaining
