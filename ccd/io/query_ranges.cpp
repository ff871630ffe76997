#include "ccd/io/query_ranges.hpp"

#include <algorithm>
#include <array>
#include <errbound/support/error.hpp>
#include <fstream>
#include <system_error>
#include <utility>

#include "errbound/support/output_file.hpp"

namespace ccd::io {
namespace {

using errbound::support::file_error;

class row_scanner {
  public:
    explicit row_scanner(std::uint64_t rows_of_a_range) : per_range_(rows_of_a_range) {}

    void take(std::string_view bytes) {
        for (const char c : bytes) {
            if (c == '\n' && after_cr_) {  // CR has ended the line
                ++offset_;
                line_begin_ = offset_;
                after_cr_ = false;
                continue;
            }
            if (line_begin_ == offset_) begin_line();
            after_cr_ = c == '\r';
            ++offset_;
            if (c == '\n' || c == '\r') {
                ++rows_;
                line_begin_ = offset_;
            } else if (c != ' ' && c != '\t' && c != '\x1a') {
                content_end_ = offset_;
            }
            if (rows_ == 0 && c == ',') ++index_.columns;
        }
    }

    query_index result() {
        auto& ranges = index_.ranges;
        while (ranges.size() > 1 && ranges.back().begin >= content_end_) ranges.pop_back();
        if (ranges.empty()) ranges.emplace_back();
        for (std::size_t i = 0; i + 1 < ranges.size(); ++i) ranges[i].end = ranges[i + 1].begin;
        ranges.back().end = content_end_;
        ++index_.columns;
        return std::move(index_);
    }

  private:
    void begin_line() {
        if (rows_ % per_range_ == 0) index_.ranges.push_back({offset_, offset_, rows_});
    }

    std::uint64_t per_range_, offset_ = 0, line_begin_ = 0, rows_ = 0, content_end_ = 0;
    bool after_cr_ = false;
    query_index index_;
};

std::vector<query_range> ranges_of(const store_reader& store, std::uint64_t queries_of_a_range) {
    std::vector<query_range> ranges;
    for (std::uint64_t begin = 0; begin < store.size(); begin += queries_of_a_range)
        ranges.push_back(
            {begin, std::min(store.size(), begin + queries_of_a_range), rows_per_query * begin});
    return ranges;
}

std::string read_bytes(const std::filesystem::path& path, std::uint64_t begin, std::uint64_t end) {
    std::ifstream in(path, std::ios::binary);
    std::string text(end - begin, '\0');
    in.seekg(static_cast<std::streamoff>(begin));
    in.read(text.data(), static_cast<std::streamsize>(text.size()));
    if (!in || static_cast<std::uint64_t>(in.gcount()) != text.size())
        throw file_error(path.string() + ": cannot be read from byte " + std::to_string(begin) +
                         " to " + std::to_string(end) + ", where it had queries before");
    return text;
}

}  // namespace

query_index index_queries(const std::filesystem::path& path, std::size_t queries_of_a_range) {
    std::error_code error;
    const auto type = std::filesystem::status(path, error).type();
    if (type == std::filesystem::file_type::not_found)
        throw file_error(path.string() + ": file does not exist; expected a readable file");
    if (type != std::filesystem::file_type::regular)
        throw file_error(path.string() +
                         ": path is not a regular file; expected one, to read ranges");
    std::ifstream in(path, std::ios::binary);
    row_scanner rows(rows_per_query * queries_of_a_range);
    std::array<char, 1 << 16> block;
    bool is_first = true;
    while (in.read(block.data(), block.size()), in.gcount() > 0) {
        const std::string_view bytes(block.data(), static_cast<std::size_t>(in.gcount()));
        if (std::exchange(is_first, false) && is_store(bytes))
            return {ranges_of(*open_store(path), queries_of_a_range)};
        rows.take(bytes);
    }
    if (!in.eof() || in.bad()) throw file_error(path.string() + ": cannot be read");
    return rows.result();
}

range_reader::range_reader(std::filesystem::path path, std::optional<ccd::kind> kind, bool round,
                           query_index index)
    : path_(std::move(path)),
      kind_(kind_of_file(path_, kind)),
      round_(round),
      index_(std::move(index)) {}

query_file range_reader::read(std::size_t range) {
    const query_range& where = index_.ranges.at(range);
    if (index_.columns == 0) return read_from_store(where);
    query_file result = parse_rows(read_bytes(path_, where.begin, where.end), path_.string(), kind_,
                                   round_, where.rows, index_.columns);
    if (result.truth) return result;
    if (!truth_) truth_.emplace(path_);
    truth_->add_to(result, where.rows / rows_per_query, where.end == index_.ranges.back().end);
    return result;
}

query_file range_reader::read_from_store(const query_range& range) {
    if (!store_) store_ = open_store(path_);
    if (range.end > store_->size())
        throw file_error(path_.string() + ": number of queries is " +
                         std::to_string(store_->size()) + "; expected at least " +
                         std::to_string(range.end) + " as before");
    return store_->read(range.begin, range.end);
}

}  // namespace ccd::io
