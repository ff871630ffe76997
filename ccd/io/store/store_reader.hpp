// Stores of queries: HDF5 files, read a range at a time.
//
// What is in one: docs/program.md. Where this is built without HDF5 they are recognised, and
// refused.
#pragma once

#include <ccd/io/query_file.hpp>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace ccd::io {

/// Queries of a chunk, which has points of its own.
inline constexpr std::uint64_t queries_of_a_chunk = 65536;

/// Whether a file that begins so is a store.
constexpr bool is_store(std::string_view first_bytes) {
    return first_bytes.starts_with("\x89HDF\r\n\x1a\n");
}

/// For programs that use no HDF5 of their own, before all else: the library does nothing at exit,
/// where 1.10 prints complaints if it has met a damaged file.
void leave_stores_at_exit();

/// Every call throws errbound::support::file_error where the file is damaged or no store, with
/// `name` in its message. One call at a time in a process: they wait for each other.
class store_reader {
  public:
    /// Of a file's bytes, copied; or of a file, which is read in parts.
    store_reader(std::string_view bytes, const std::string& name);
    explicit store_reader(const std::filesystem::path& path);
    ~store_reader();
    store_reader(store_reader&&) noexcept;
    store_reader& operator=(store_reader&&) noexcept;

    ccd::kind kind() const;
    std::uint64_t size() const;
    /// Queries [begin, end). Precondition: begin <= end <= size().
    query_file read(std::uint64_t begin, std::uint64_t end) const;

  private:
    class opened;
    std::unique_ptr<opened> opened_;
};

}  // namespace ccd::io
