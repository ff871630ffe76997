#include "ccd/io/query_ranges.hpp"

#include <algorithm>
#include <array>
#include <errbound/support/error.hpp>
#include <system_error>
#include <utility>

namespace ccd::io {
namespace {

using errbound::support::file_error;

std::uint64_t size_of_file(const std::filesystem::path& path) {
    std::error_code error;
    const auto type = std::filesystem::status(path, error).type();
    if (type == std::filesystem::file_type::not_found)
        throw file_error(path.string() + ": file does not exist; expected a readable file");
    if (type != std::filesystem::file_type::regular)
        throw file_error(path.string() +
                         ": path is not a regular file; expected one, to read ranges");
    return std::filesystem::file_size(path);
}

}  // namespace

range_reader::range_reader(std::filesystem::path path, std::optional<ccd::kind> kind, bool round,
                           std::size_t queries_of_a_range)
    : path_(std::move(path)),
      round_(round),
      queries_of_a_range_(queries_of_a_range),
      size_(size_of_file(path_)),
      file_(path_, std::ios::binary) {
    kind_ = kind_of_file(path_, kind);
    std::array<char, 8> first{};
    file_.read(first.data(), first.size());
    if (is_store({first.data(), first.size()})) {
        store_ = open_store(path_);
        size_ = store_->size();
    }
    file_.clear();
    file_.seekg(0);
}

std::optional<query_file> range_reader::next() {
    if (at_end_) return std::nullopt;
    if (!store_) return next_of_text();
    const std::uint64_t begin = read_;
    read_ += std::min(queries_of_a_range_, size_ - begin);
    at_end_ = read_ == size_;
    return store_->read(begin, read_);
}

double range_reader::share() const {
    return static_cast<double>(read_) / static_cast<double>(std::max<std::uint64_t>(size_, 1));
}

/// Sets end_ after the rows of a range. False if the text may hold nothing but blanks after these.
bool range_reader::has_range() {
    for (; scanned_ < text_.size(); ++scanned_) {
        const char c = text_[scanned_], before = scanned_ > 0 ? text_[scanned_ - 1] : ' ';
        const bool begins_line = before == '\n' || (before == '\r' && c != '\n');
        lines_ += begins_line;
        if (begins_line && lines_ == rows_per_query * queries_of_a_range_) end_ = scanned_;
        if (end_ > 0 && std::string_view(" \t\r\n\x1a").find(c) == std::string_view::npos)
            return true;
    }
    return false;
}

query_file range_reader::next_of_text() {
    while (!has_range() && !at_end_) {
        std::array<char, 1 << 16> block;
        file_.read(block.data(), block.size());
        text_.append(block.data(), static_cast<std::size_t>(file_.gcount()));
        at_end_ = file_.gcount() == 0;
    }
    if (at_end_ && !file_.eof()) throw file_error(path_.string() + ": cannot be read");
    const auto text = std::string_view(text_).substr(0, at_end_ ? text_.size() : end_);
    if (rows_ == 0)
        columns_ = 1 + static_cast<std::uint64_t>(
                           std::ranges::count(text.substr(0, text.find_first_of("\r\n")), ','));
    query_file result = parse_rows(text, path_.string(), kind_, round_, rows_, columns_);
    if (!result.truth) {
        if (!truth_) truth_.emplace(path_);
        truth_->add_to(result, rows_ / rows_per_query, at_end_);
    }
    rows_ += rows_per_query * result.size();
    read_ += text.size();
    text_.erase(0, text.size());
    scanned_ = lines_ = end_ = 0;
    return result;
}

}  // namespace ccd::io
