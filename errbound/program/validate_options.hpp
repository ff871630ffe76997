// The command line of `errbound validate`.
#pragma once

#include <CLI/CLI.hpp>
#include <ccd/kind.hpp>
#include <errbound/validation/validation.hpp>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace errbound::validation {

enum exit_status { done = 0, bad_input = 1, violations_found = 1 };

struct validate_arguments {
    std::vector<rule> rules;
    bool expressions = false, tiny = false;  ///< parts to run
    function_options functions;              ///< with the numbers and seed of expressions
    bool every_bound = false;                ///< for tiny
    expression_options options;              ///< threads: for all parts
    std::vector<std::filesystem::path> queries;
    std::optional<ccd::kind> kind;  ///< empty: from each path
    bool round = false;
    std::optional<std::filesystem::path> json, csv, functions_csv;
};

class validate_options {
  public:
    explicit validate_options(CLI::App& program);

    bool was_given() const { return line_.parsed(); }
    /// Checks the parsed line. Throws errbound::support::usage_error.
    validate_arguments checked();

  private:
    void add_expressions();
    void add_functions();
    /// Throws usage_error if an option has no effect.
    void require_use_of_options(const validate_arguments& all) const;

    CLI::App& line_;
    validate_arguments arguments_;
    std::string rules_, numbers_, kind_, functions_;
};

}  // namespace errbound::validation
