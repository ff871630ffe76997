#pragma once

#include <filesystem>
#include <string>

namespace simulation {

/// Summarises frames.csv. Throws file_error for other files.
std::string summary_of(const std::filesystem::path& table);

}  // namespace simulation
