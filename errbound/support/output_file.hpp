// Output files that are written whole or not at all.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace errbound::support {

struct output {
    std::filesystem::path path;
    std::string text{};
    std::filesystem::path from{};  ///< unless empty: a file with the contents, instead of text
};

/// Returns the open descriptor of a path: 1 for `-` and /dev/stdout, 2 for /dev/stderr, N for
/// /dev/fd/N and /proc/self/fd/N.
std::optional<int> descriptor_of(const std::filesystem::path& path);

/// Throws file_error if write_whole will certainly fail: missing folders or permissions, invalid
/// names.
void require_writable(const std::filesystem::path& path);

/// Writes the outputs in order. Each goes to a temporary file in its folder, which is then renamed,
/// so that files are whole or untouched. A killed process can leave `.errbound-PID-N.tmp`.
/// A replaced file keeps its permissions; a symbolic link stays one. Pipes, devices and open
/// descriptors are written directly. Throws file_error at the first failure (full disk, size limit,
/// missing permissions).
void write_whole(const std::vector<output>& outputs);
void write_whole(const std::filesystem::path& path, std::string_view text);

/// Returns the contents of a file. Throws file_error (missing, a directory, unreadable).
std::string read_whole(const std::filesystem::path& path);

}  // namespace errbound::support
