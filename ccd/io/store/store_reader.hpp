// Reader of stores of queries: HDF5 files, read a range at a time. Their layout: docs/program.md.
#pragma once

#include <ccd/io/query_file.hpp>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace ccd::io {

/// Number of queries of a chunk. Each chunk has its own points.
inline constexpr std::uint64_t queries_of_a_chunk = 65536;

/// True if a file that begins with these bytes is a store.
constexpr bool is_store(std::string_view first_bytes) {
    return first_bytes.starts_with("\x89HDF\r\n\x1a\n");
}

/// Keeps the HDF5 library from running code at exit, where version 1.10 prints complaints after it
/// has met a damaged file. For programs without other uses of HDF5, before anything else.
void leave_stores_at_exit();

/// An open store. Calls from several threads wait for each other.
/// Throws errbound::support::file_error, with the store's name, if the file is damaged.
class store_reader {
  public:
    virtual ~store_reader() = default;
    virtual ccd::kind kind() const = 0;
    virtual std::uint64_t size() const = 0;
    /// Queries [begin, end). Precondition: begin <= end <= size().
    virtual query_file read(std::uint64_t begin, std::uint64_t end) const = 0;
};

/// Opens a file, or copies the bytes of one. Throws errbound::support::file_error if that is no
/// store, or if this was built without HDF5.
std::unique_ptr<store_reader> open_store(const std::filesystem::path& path);
std::unique_ptr<store_reader> open_store(std::string_view bytes, const std::string& name);

}  // namespace ccd::io
