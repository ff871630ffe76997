// `errbound validate` on parsed arguments.
#pragma once

#include "errbound/program/validate_options.hpp"

namespace errbound::validation {

/// Runs the validation, prints the findings and writes the outputs; writes nothing unless all files
/// are good. Throws errbound::support::usage_error, errbound::support::file_error.
exit_status run_validate(const validate_arguments& arguments);

}  // namespace errbound::validation
