// `errbound validate`, once its arguments are read.
#pragma once

#include <ccd/io/query_file.hpp>
#include <errbound/validation/validation.hpp>
#include <filesystem>
#include <optional>
#include <vector>

namespace errbound::validation {

struct validate_arguments {
    std::vector<rule> rules;
    bool expressions = false, tiny = false;  ///< whether to run them
    expression_options options;              ///< threads: of all parts
    std::vector<std::filesystem::path> queries;
    std::optional<ccd::kind> kind;  ///< none: from each path
    bool round = false;
    std::optional<std::filesystem::path> json, csv;
};

/// Prints what was found; writes nothing unless all files are good. Returns whether every promise
/// was kept. Throws errbound::support::file_error on bad input.
bool run_validate(const validate_arguments& arguments);

}  // namespace errbound::validation
