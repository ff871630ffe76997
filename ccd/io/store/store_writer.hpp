// What a store of queries has in it, written a chunk at a time.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string_view>

namespace ccd::io {

/// Of queries_of_a_chunk queries, but for the last.
struct store_chunk {
    std::span<const std::array<std::uint64_t, 6>> points;   ///< six doubles' bits each
    std::span<const std::array<std::uint32_t, 4>> queries;  ///< rows of `points`
    std::span<const std::uint8_t> truth;                    ///< of each query; empty: none
};

/// Memory: that of HDF5, some megabytes, and 24 bytes a chunk.
class store_writer {
  public:
    /// A store in a temporary file. Throws std::runtime_error: built without HDF5.
    store_writer(std::string_view kind, bool with_truth);
    ~store_writer();
    store_writer(store_writer&&) noexcept;
    store_writer& operator=(store_writer&&) noexcept;

    /// Throws errbound::support::file_error where the file cannot be written.
    void add(const store_chunk& chunk, bool is_last);
    /// The store, once its last chunk is in it; it goes away with this.
    const std::filesystem::path& path() const;

  private:
    class unfinished;
    std::unique_ptr<unfinished> store_;
};

}  // namespace ccd::io
