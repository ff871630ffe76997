// Files of stored queries, read one range at a time.
#pragma once

#include <ccd/io/query_file.hpp>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ccd/io/store/store_reader.hpp"

namespace ccd::io {

inline constexpr std::size_t rows_per_query = 8;

/// Rows of whole queries, except the last range of a truncated CSV file.
struct query_range {
    std::uint64_t begin = 0, end = 0;  ///< bytes; of a store: queries
    std::uint64_t rows = 0;            ///< before the range
};

struct query_index {
    std::vector<query_range> ranges;  ///< at least one
    std::uint64_t columns = 0;        ///< of the first row; of a store: 0
};

/// Finds line ends only. Throws errbound::support::file_error unless the file can be read in parts.
query_index index_queries(const std::filesystem::path& path, std::size_t queries_of_a_range);

/// The truth that may lie next to a file of queries (read_queries).
class truth_file {
  public:
    explicit truth_file(const std::filesystem::path& queries);

    /// Adds the truth to queries from `first` on; if `is_last`, the truth must end with them.
    /// Throws errbound::support::file_error unless the numbers of queries and truths match.
    void add_to(query_file& queries, std::uint64_t first, bool is_last) const;

  private:
    std::string queries_;
    std::filesystem::path path_;
    std::optional<std::vector<bool>> truth_;
};

class range_reader {
  public:
    range_reader(std::filesystem::path path, std::optional<ccd::kind> kind, bool round,
                 query_index index);

    /// Same as read_queries, with line numbers of the whole file.
    query_file read(std::size_t range);

  private:
    query_file read_from_store(const query_range& range);

    std::filesystem::path path_;
    ccd::kind kind_;
    bool round_;
    query_index index_;
    std::optional<truth_file> truth_;      ///< once it is needed
    std::unique_ptr<store_reader> store_;  ///< once it is open
};

/// Same as parse_queries, for rows that follow `rows` other rows of `columns` columns.
query_file parse_rows(std::string_view text, const std::string& name, ccd::kind kind, bool round,
                      std::uint64_t rows, std::uint64_t columns);

/// The kind that read_queries uses. Throws errbound::support::file_error.
ccd::kind kind_of_file(const std::filesystem::path& path, std::optional<ccd::kind> kind);

}  // namespace ccd::io
