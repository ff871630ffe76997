// Temporary files for data that do not fit in memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace errbound::support {

/// A file with a new name in std::filesystem::temp_directory_path(). The destructor removes it.
class scratch_file {
  public:
    scratch_file();
    ~scratch_file();
    scratch_file(const scratch_file&) = delete;
    scratch_file& operator=(const scratch_file&) = delete;

    const std::filesystem::path& path() const { return path_; }

    /// Throws file_error, for example for a full disk.
    void append(std::string_view bytes);
    /// Reads exactly `size` bytes at `offset`. Throws file_error if there are fewer.
    void read(std::uint64_t offset, std::size_t size, void* to) const;

  private:
    std::filesystem::path path_;
    std::string name_;
    int descriptor_ = -1;
};

}  // namespace errbound::support
