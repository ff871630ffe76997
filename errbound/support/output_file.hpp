// Output files are written whole or not at all.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace errbound::support {

/// Writes `text` to a temporary file beside `path` and renames it. Throws file_error.
void write_whole(const std::filesystem::path& path, std::string_view text);

/// The whole file. Throws file_error (missing, a directory, unreadable).
std::string read_whole(const std::filesystem::path& path);

}  // namespace errbound::support
