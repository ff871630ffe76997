// The findings of `errbound validate` and `ccd validate`, as tables, JSON and CSV.
#pragma once

#include <errbound/validation/validation.hpp>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "errbound/support/command.hpp"
#include "errbound/support/rows.hpp"

namespace errbound::validation {

/// One kind of evidence.
struct part {
    std::string name;  ///< "expressions", "tiny", "functions" or the file
    evidence what;
};

struct result_files {
    std::optional<std::filesystem::path> json, csv, functions_csv;

    void add_options(CLI::App& line);
    std::vector<std::optional<std::filesystem::path>> all() const {
        return {json, csv, functions_csv};
    }
};

/// The columns of --csv without `part`. The column `clamped` names the quantiles that are only
/// bounds (distribution::is_clamped).
support::row row_of(const tightness& t);

/// Examines the parts, writes the requested files, then prints tables. Returns broken_promise if
/// there are violations. Throws errbound::support::file_error.
support::exit_status examine_parts(const std::vector<part>& parts, int threads,
                                   const result_files& to);

}  // namespace errbound::validation
