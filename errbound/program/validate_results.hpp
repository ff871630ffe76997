// Output of `errbound validate`.
#pragma once

#include <errbound/validation/validation.hpp>
#include <string>
#include <vector>

#include "errbound/program/validate_options.hpp"

namespace errbound::validation {

struct found_part {
    std::string name;  ///< "expressions", "tiny", "functions" or the file
    report found;
};

/// Writes the requested files, then tables. Returns violations_found if a promise was broken.
/// Throws errbound::support::file_error.
exit_status write_results(const std::vector<found_part>& parts, const validate_arguments& to);

}  // namespace errbound::validation
