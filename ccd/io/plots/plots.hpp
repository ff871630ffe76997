// Tables in a folder, and the pictures that plot.py draws from them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace ccd::io {

extern const std::vector<std::string> method_columns;

/// Exit statuses of draw_pictures other than 0.
inline constexpr int no_matplotlib = 3, no_python = 127;

/// Writes plot.py into the folder and runs it. Returns its exit status. Throws
/// errbound::support::file_error.
int draw_pictures(const std::filesystem::path& folder);

}  // namespace ccd::io
