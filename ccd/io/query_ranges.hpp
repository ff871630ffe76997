// Files of stored queries, read one range at a time.
#pragma once

#include <ccd/io/query_file.hpp>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ccd/io/store/store_reader.hpp"

namespace ccd::io {

inline constexpr std::size_t rows_per_query = 8;

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

/// Reads a regular file of queries, a range at a time.
class range_reader {
  public:
    /// Throws errbound::support::file_error, as next().
    range_reader(std::filesystem::path path, std::optional<ccd::kind> kind, bool round,
                 std::size_t queries_of_a_range);

    /// Returns the next range of queries as read_queries does, with line numbers of the whole file;
    /// nothing at the end. The first call always returns a range.
    std::optional<query_file> next();
    double share() const;  ///< of the file that was read, from 0 to 1

  private:
    bool has_range();
    query_file next_of_text();

    std::filesystem::path path_;
    ccd::kind kind_;
    bool round_, at_end_ = false;
    std::uint64_t queries_of_a_range_;
    std::uint64_t size_, read_ = 0;  ///< bytes; of a store: queries
    std::unique_ptr<store_reader> store_;
    std::optional<truth_file> truth_;  ///< once it is needed
    std::ifstream file_;
    std::uint64_t rows_ = 0, columns_ = 0;  ///< of the text before
    std::string text_;                      ///< read, and not yet returned
    std::size_t scanned_ = 0, lines_ = 0, end_ = 0;
};

/// Same as parse_queries, for rows that follow `rows` other rows of `columns` columns.
query_file parse_rows(std::string_view text, const std::string& name, ccd::kind kind, bool round,
                      std::uint64_t rows, std::uint64_t columns);

/// The kind that read_queries uses. Throws errbound::support::file_error.
ccd::kind kind_of_file(const std::filesystem::path& path, std::optional<ccd::kind> kind);

}  // namespace ccd::io
