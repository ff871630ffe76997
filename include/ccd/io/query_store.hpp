// Stored queries in a binary, checksummed, chunked form (target errbound::ccd_io): an HDF5 file,
// which read_queries (ccd/io/query_file.hpp) reads as it does CSV. Its layout: docs/program.md.
#pragma once

#include <array>
#include <ccd/io/query_file.hpp>
#include <cstddef>
#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

namespace ccd::io {

/// Whether this was built with HDF5. Without it, stores are neither made nor read.
bool has_query_stores();

/// Makes a store. Memory: 16 bytes a query, and 48 for each point that is new in its chunk; bytes()
/// adds the file's, which it also writes to the folder for temporary files.
class query_packer {
  public:
    query_packer(ccd::kind kind, bool with_truth) : kind_(kind), with_truth_(with_truth) {}

    /// Appends queries. Throws std::invalid_argument: another kind, truth missing or not expected,
    /// a coordinate that is not finite.
    void add(const query_file& queries);
    std::uint64_t size() const { return queries_.size(); }

    /// The file, the same for the same queries. Throws std::runtime_error: no queries, no room for
    /// temporary files, or built without HDF5.
    std::string bytes() const;

  private:
    using row = std::array<std::uint64_t, 6>;  // bits of a point at t = 0 and t = 1
    struct hash {
        std::size_t operator()(const row& r) const;
    };
    void add(const row* points);

    ccd::kind kind_;
    bool with_truth_;
    std::vector<row> points_;
    std::vector<std::array<std::uint32_t, 4>> queries_;  // by row, from the chunk's first point on
    std::vector<std::uint64_t> first_point_;             // of each chunk
    std::vector<std::uint8_t> truth_;
    std::unordered_map<row, std::uint32_t, hash> of_chunk_;
};

}  // namespace ccd::io
