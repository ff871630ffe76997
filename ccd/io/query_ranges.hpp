// Files of stored queries, read one range at a time.
#pragma once

#include <ccd/io/query_file.hpp>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ccd/io/store/store_reader.hpp"

namespace ccd::io {

/// Rows of whole queries, but for the last range of a CSV file that is truncated.
struct query_range {
    std::uint64_t begin = 0, end = 0;  ///< bytes; of a store: queries
    std::uint64_t rows = 0;            ///< before it
};

struct query_index {
    std::vector<query_range> ranges;  ///< at least one
    std::uint64_t columns = 0;        ///< of the first row; of a store: 0
};

/// Where each range of so many queries is, told by line ends alone. Throws
/// errbound::support::file_error: no file that can be read in parts.
query_index index_queries(const std::filesystem::path& path, std::size_t queries_of_a_range);

/// Reads ranges of a file. The truth beside it is read once, if it is needed.
class range_reader {
  public:
    range_reader(std::filesystem::path path, std::optional<ccd::kind> kind, bool round,
                 query_index index);

    /// The queries of a range, with their truth, as read_queries returns them. Throws as that does,
    /// with the file's line numbers.
    query_file read(std::size_t range);

  private:
    query_file read_from_store(const query_range& range);
    void add_truth(const query_range& range, query_file& to);

    std::filesystem::path path_;
    ccd::kind kind_;
    bool round_;
    query_index index_;
    bool has_looked_for_truth_ = false;
    std::optional<std::vector<bool>> truth_;  // that lies beside it
    std::optional<store_reader> store_;       // once it is open
};

/// As parse_queries, of rows that follow `rows` others of so many columns.
query_file parse_rows(std::string_view text, const std::string& name, ccd::kind kind, bool round,
                      std::uint64_t rows, std::uint64_t columns);

/// As read_queries has them: the kind of a file's queries (of a store its own, which `kind` must
/// not contradict), and where the truth beside it is.
/// Throws errbound::support::file_error.
ccd::kind kind_of_file(const std::filesystem::path& path, std::optional<ccd::kind> kind);
std::filesystem::path truth_beside(const std::filesystem::path& path);

}  // namespace ccd::io
