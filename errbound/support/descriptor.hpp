// Bytes to an open file.
#pragma once

#include <filesystem>
#include <string_view>

namespace errbound::support {

/// Writes all bytes to an open descriptor. `shown`: the file's name in messages. Throws file_error.
void write_all(int descriptor, std::string_view bytes, const std::filesystem::path& shown);

}  // namespace errbound::support
