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

/// Runs the plan and writes its cells. Makes the folder before the run. Returns true if all
/// promises were kept. Otherwise the text names the broken ones, and the folder, or the current
/// one, has a query for each. Throws errbound::support::file_error.
bool run_and_write(const plan& what, const outputs& to, std::ostream& text);

}  // namespace ccd::stress
