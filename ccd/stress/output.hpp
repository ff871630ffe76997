// What a stress run found, as tables and files.
#pragma once

#include <filesystem>
#include <iosfwd>
#include <optional>

#include "ccd/stress/stress.hpp"

namespace ccd::stress {

/// Where the results go beside the text.
struct outputs {
    std::optional<std::filesystem::path> folder;  ///< for stress.csv and stress.md
    std::optional<std::filesystem::path> json;
};

/// Runs the plan and writes what was found. Returns whether all promises were kept; else the text
/// says which not, and a query for each is in the folder, or the current one. Throws
/// errbound::support::file_error, before the run if the folder cannot be written to.
bool run_and_write(const plan& what, const outputs& to, std::ostream& text);

}  // namespace ccd::stress
