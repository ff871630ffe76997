// What `errbound validate` found, written.
#pragma once

#include <errbound/validation/validation.hpp>
#include <string>
#include <vector>

#include "errbound/program/validate_options.hpp"

namespace errbound::validation {

/// What a part of the run found.
struct found_part {
    std::string name;  ///< "expressions", "tiny", "functions" or the file
    report found;
};

/// Writes the files that were asked for, then tables for people. Returns whether every promise was
/// kept. Throws errbound::support::file_error.
exit_status write_results(const std::vector<found_part>& parts, const validate_arguments& to);

}  // namespace errbound::validation
