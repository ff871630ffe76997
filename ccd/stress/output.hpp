// What a stress run found, as tables and files.
#pragma once

#include <filesystem>
#include <iosfwd>
#include <optional>
#include <vector>

#include "ccd/stress/stress.hpp"

namespace ccd::stress {

/// Where the results go beside the text.
struct outputs {
    std::optional<std::filesystem::path> folder;  ///< for stress.csv and stress.md
    std::optional<std::filesystem::path> json;
};

/// Runs the plan and writes what was found, as the two functions below.
bool run_and_write(const plan& what, const outputs& to, std::ostream& text);

/// Makes the folder. Throws errbound::support::file_error if it cannot be written to: known now,
/// not after the run.
void prepare(const outputs& to);

/// Writes the cells of the plan. Returns whether all promises were kept; else the text says which
/// not, and a query for each is in the folder, or the current one. Throws
/// errbound::support::file_error.
bool write(const std::vector<cell>& cells, const plan& what, const outputs& to, std::ostream& text);

}  // namespace ccd::stress
