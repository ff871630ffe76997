// `errbound validate`, once its arguments are read.
#pragma once

#include <ccd/io/query_file.hpp>
#include <errbound/validation/validation.hpp>
#include <string>
#include <vector>

#include "errbound/program/validate_options.hpp"

namespace errbound::validation {

/// What a run looks at.
struct part {
    std::string name;  ///< "expressions", "tiny", "functions" or the file
    evidence what;
};

/// The files of queries. Throws errbound::support::file_error.
std::vector<ccd::io::query_file> read_files(const validate_arguments& arguments);

/// In the order of tables. They look at the queries of `files` as long as they are used.
std::vector<part> parts_of(const validate_arguments& arguments,
                           const std::vector<ccd::io::query_file>& files);

/// Prints and writes what was found; writes nothing unless all files are good. Throws
/// errbound::support::usage_error, errbound::support::file_error.
exit_status run_validate(const validate_arguments& arguments);

}  // namespace errbound::validation
