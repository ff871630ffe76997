// Files in the folder for temporary files, for what is too large to be kept in memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace errbound::support {

/// A file of a new name in std::filesystem::temp_directory_path(), which goes away with this.
class scratch_file {
  public:
    /// Throws file_error.
    scratch_file();
    ~scratch_file();
    scratch_file(const scratch_file&) = delete;
    scratch_file& operator=(const scratch_file&) = delete;

    const std::filesystem::path& path() const { return path_; }

    /// Throws file_error: no room, say.
    void append(std::string_view bytes);
    /// Exactly `size` bytes from `offset` on, to `to`. Throws file_error where there are fewer.
    void read(std::uint64_t offset, std::size_t size, void* to) const;

  private:
    std::filesystem::path path_;
    std::string name_;
    int descriptor_ = -1;
};

}  // namespace errbound::support
