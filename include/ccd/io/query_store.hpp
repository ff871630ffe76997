// Writes stores of queries (target errbound::ccd_io): HDF5 files, chunked and checksummed, that
// read_queries (ccd/io/query_file.hpp) reads. Layout: docs/program.md.
#pragma once

#include <ccd/io/query_file.hpp>
#include <cstdint>
#include <filesystem>
#include <memory>

namespace ccd::io {

/// True if this was built with HDF5. Otherwise stores are neither written nor read.
bool has_query_stores();

/// Writes a store of any number of queries to a file in std::filesystem::temp_directory_path(),
/// with up to 16 further bytes a query until it is finished. Memory: some 30 megabytes.
class query_packer {
  public:
    virtual ~query_packer() = default;

    /// Appends queries. Precondition: finish() was not called. Throws std::invalid_argument if the
    /// kind differs, truth is missing or not expected, or a coordinate is not finite; throws
    /// errbound::support::file_error if there is no room. After an exception the store is
    /// unspecified.
    virtual void add(const query_file& queries) = 0;
    virtual std::uint64_t size() const = 0;

    /// Returns the store's file, which the destructor removes. Equal queries give equal bytes.
    /// Throws std::runtime_error if there are no queries, and errbound::support::file_error as add.
    virtual const std::filesystem::path& finish() = 0;
};

/// Begins a store of one kind, all with truth or all without. Throws std::runtime_error without
/// HDF5.
std::unique_ptr<query_packer> make_query_packer(ccd::kind kind, bool with_truth);

}  // namespace ccd::io
