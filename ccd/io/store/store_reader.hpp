// Reads stores of queries a range at a time. Layout: docs/program.md.
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

constexpr bool is_store(std::string_view first_bytes) {
    return first_bytes.starts_with("\x89HDF\r\n\x1a\n");
}

/// Keeps HDF5 1.10 from printing complaints at exit after a damaged file. Programs without other
/// uses of HDF5 call it before anything else.
void leave_stores_at_exit();

/// Calls from several threads wait for each other. Throws errbound::support::file_error if the file
/// is damaged.
class store_reader {
  public:
    virtual ~store_reader() = default;
    virtual ccd::kind kind() const = 0;
    virtual std::uint64_t size() const = 0;
    /// Precondition: begin <= end <= size().
    virtual query_file read(std::uint64_t begin, std::uint64_t end) const = 0;
};

/// Throws errbound::support::file_error if the file is not a store, or in a build without HDF5.
std::unique_ptr<store_reader> open_store(const std::filesystem::path& path);
std::unique_ptr<store_reader> open_store(std::string_view bytes, const std::string& name);

}  // namespace ccd::io
