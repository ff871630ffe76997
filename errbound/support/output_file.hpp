// Each output file is whole or untouched.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace errbound::support {

/// A file to write, and all that goes into it.
struct output {
    std::filesystem::path path;
    std::string text{};
    std::filesystem::path from{};  ///< a file whose bytes go into it instead, unless empty
};

/// The open descriptor that a path stands for: `-` and /dev/stdout are 1, /dev/stderr 2,
/// /dev/fd/N and /proc/self/fd/N are N.
std::optional<int> descriptor_of(const std::filesystem::path& path);

/// Throws file_error where write_whole certainly will, as far as can be told before there is
/// anything to write: missing folders and rights, names that are no file's.
void require_writable(const std::filesystem::path& path);

/// Writes the outputs in order, and stops at the first that fails. Each file is whole or untouched:
/// its bytes go to a temporary file beside it, which is then renamed. A killed process can leave
/// `.errbound-PID-N.tmp`. A file that is replaced keeps its permissions; a symbolic link stays one.
/// Pipes, devices and open descriptors are written directly. Throws file_error (full disk, limit on
/// a file's size, missing rights).
void write_whole(const std::vector<output>& outputs);
void write_whole(const std::filesystem::path& path, std::string_view text);

/// The whole file. Throws file_error (missing, a directory, unreadable).
std::string read_whole(const std::filesystem::path& path);

}  // namespace errbound::support
