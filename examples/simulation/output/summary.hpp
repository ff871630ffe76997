// A run told in a few lines, from its table of frames.
#pragma once

#include <filesystem>
#include <string>

namespace simulation {

/// Of frames.csv. Throws file_error if it is none.
std::string summary_of(const std::filesystem::path& table);

}  // namespace simulation
