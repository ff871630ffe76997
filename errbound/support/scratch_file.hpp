// Temporary files for data too large for memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace errbound::support {

/// A new file in the system's temporary folder, removed with this object.
class scratch_file {
  public:
    scratch_file();
    ~scratch_file();
    scratch_file(const scratch_file&) = delete;
    scratch_file& operator=(const scratch_file&) = delete;

    const std::filesystem::path& path() const { return path_; }

    void append(std::string_view bytes);  ///< throws file_error (a full disk)
    /// Reads exactly `size` bytes from `offset`. Throws file_error if there are fewer.
    void read(std::uint64_t offset, std::size_t size, void* to) const;

  private:
    std::filesystem::path path_;
    std::string name_;
    int descriptor_ = -1;
};

}  // namespace errbound::support
