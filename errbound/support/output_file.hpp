// Output files are whole or untouched.
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
    std::filesystem::path from{};  ///< a file to copy instead, unless empty
};

/// `-` and /dev/stdout are 1, /dev/stderr 2, /dev/fd/N and /proc/self/fd/N are N.
std::optional<int> descriptor_of(const std::filesystem::path& path);

/// Writes all bytes to an open descriptor, also after partial and interrupted writes. `shown`: the
/// file's name in messages. Throws file_error.
void write_all(int descriptor, std::string_view bytes, const std::filesystem::path& shown);

/// Throws file_error if write_whole would fail for missing folders or rights, or an invalid name.
void require_writable(const std::filesystem::path& path);

/// Writes the outputs in order and stops at the first failure. Each file is whole or untouched: a
/// temporary file next to it is renamed. A killed process can leave `.errbound-PID-N.tmp`. Replaced
/// files keep permissions and symbolic links. Pipes, devices and open descriptors are written
/// directly. Throws file_error (full disk, file size limit, missing rights).
void write_whole(const std::vector<output>& outputs);
void write_whole(const std::filesystem::path& path, std::string_view text);

/// Throws file_error (missing, a directory, unreadable).
std::string read_whole(const std::filesystem::path& path);

}  // namespace errbound::support
