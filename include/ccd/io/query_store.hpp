// Stored queries in a binary, checksummed, chunked form (target errbound::ccd_io): an HDF5 file,
// which read_queries (ccd/io/query_file.hpp) reads as it does CSV. Its layout: docs/program.md.
#pragma once

#include <ccd/io/query_file.hpp>
#include <cstdint>
#include <filesystem>
#include <memory>

namespace ccd::io {

/// Whether this was built with HDF5. Without it, stores are neither made nor read.
bool has_query_stores();

/// Makes a store of any number of queries, in the folder for temporary files
/// (std::filesystem::temp_directory_path()), where it takes up to 16 bytes a query more than in the
/// end. Memory: some 30 megabytes.
class query_packer {
  public:
    /// Throws std::runtime_error: built without HDF5.
    query_packer(ccd::kind kind, bool with_truth);
    ~query_packer();
    query_packer(query_packer&&) noexcept;
    query_packer& operator=(query_packer&&) noexcept;

    /// Appends queries; before finish() alone. Throws std::invalid_argument: another kind, truth
    /// missing or not expected, a coordinate that is not finite; errbound::support::file_error
    /// where there is no room. What has been added before is then undefined.
    void add(const query_file& queries);
    std::uint64_t size() const;

    /// The store: a file to be copied, which goes away with this; the same bytes for the same
    /// queries. Throws std::runtime_error: no queries; errbound::support::file_error as add.
    const std::filesystem::path& finish();

  private:
    class chunks;
    std::unique_ptr<chunks> chunks_;
};

}  // namespace ccd::io
