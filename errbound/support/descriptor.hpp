#pragma once

#include <filesystem>
#include <string_view>

namespace errbound::support {

/// Writes all bytes to an open descriptor, also after signals and partial writes.
/// `shown` is the file's name for messages. Throws file_error.
void write_all(int descriptor, std::string_view bytes, const std::filesystem::path& shown);

}  // namespace errbound::support
