// A report as a line of text, for journals and other ranks: all of it comes back.
#pragma once

#include <errbound/validation/validation.hpp>
#include <string>

namespace errbound::validation {

std::string report_line(const report& found);

/// Throws std::exception: what no report gives.
report report_from(const std::string& line);

}  // namespace errbound::validation
