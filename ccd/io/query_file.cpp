#include <array>
#include <ccd/io/query_file.hpp>
#include <cctype>
#include <errbound/support/error.hpp>
#include <fstream>
#include <nlohmann/json.hpp>

#include "ccd/io/query_ranges.hpp"
#include "ccd/io/store/store_reader.hpp"
#include "ccd/io/stored_kinds.hpp"
#include "ccd/io/text.hpp"
#include "errbound/support/output_file.hpp"

namespace ccd::io {
namespace fs = std::filesystem;
namespace {

using errbound::support::file_error;
using errbound::support::read_whole;

constexpr std::size_t max_columns = 7;

constexpr const char* row_forms =
    "6 integers (numerator, denominator of x, y, z) or 3 decimal or hexadecimal floats, then "
    "optionally truth (0 or 1)";

/// `count` includes columns that are not stored.
struct columns {
    std::array<std::string_view, max_columns> values;
    std::size_t count = 0;
};

columns split(std::string_view line) {
    columns result;
    for (bool more = true; more; ++result.count) {
        const std::size_t comma = line.find(',');
        if (result.count < max_columns)
            result.values[result.count] = trimmed(line.substr(0, comma));
        more = comma != std::string_view::npos;
        if (more) line.remove_prefix(comma + 1);
    }
    return result;
}

class query_parser {
  public:
    /// `text` follows `rows` other rows of `columns` columns.
    query_parser(std::string_view text, const std::string& name, ccd::kind kind, bool round,
                 std::size_t rows = 0, std::size_t columns = 0)
        : lines_(content(text, name, rows), name, rows),
          round_(round),
          columns_(rows > 0 ? columns : 0) {
        visit_stored_kind(kind, [this]<ccd::kind K>() {
            result_.queries.emplace<std::vector<typename kind_traits<K>::template query<double>>>();
        });
    }

    query_file parse() {
        while (const std::optional<std::string_view> line = lines_.next()) read_row(*line);
        const std::size_t last = lines_.line() - 1;
        if (row_ != 0)
            fail_at(lines_.name(), last,
                    "number of rows of the query from line " + std::to_string(last - row_ + 1) +
                        " on is " + std::to_string(row_) + "; expected 8 (truncated)");
        if (has_truth()) result_.truth = std::move(truth_);
        return std::move(result_);
    }

  private:
    static std::string_view content(std::string_view text, const std::string& name,
                                    std::size_t rows) {
        if (rows == 0) text = without_byte_order_mark(text, name);
        text = without_end_mark(text);
        text = text.substr(0, text.find_last_not_of(" \t\r\n") + 1);
        if (text.empty()) throw file_error(name + ": file is empty; expected rows of " + row_forms);
        return text;
    }

    bool is_rational() const { return columns_ >= 6; }
    bool has_truth() const { return columns_ == 4 || columns_ == 7; }

    void read_row(std::string_view line) {
        if (trimmed(line).empty()) lines_.fail("line is blank; expected a row");
        const columns row = split(line);
        if (columns_ == 0) {
            if (row.count != 3 && row.count != 4 && row.count != 6 && row.count != 7)
                lines_.fail("line is " + excerpt(line) + " (columns: " + std::to_string(row.count) +
                            "); expected " + row_forms);
            columns_ = row.count;
        } else if (row.count != columns_) {
            lines_.fail("number of columns is " + std::to_string(row.count) + "; expected " +
                        std::to_string(columns_) + " as in the first row");
        }
        points_[row_] = {coordinate(row, 0), coordinate(row, 1), coordinate(row, 2)};
        if (has_truth()) read_truth(row.values[columns_ - 1]);
        if (++row_ == rows_per_query) add_query();
    }

    double coordinate(const columns& row, std::size_t axis) const {
        const std::string name(1, "xyz"[axis]);
        if (!is_rational()) {
            const std::string_view token = row.values[axis];
            const number result = parse_double(token, round_);
            if (result.status == number_status::ok) return result.value;
            fail_at_number(result.status, name, excerpt(token));
        }
        const std::string_view n = row.values[2 * axis], d = row.values[2 * axis + 1];
        const number result = parse_quotient(n, d, round_);
        if (result.status == number_status::ok) return result.value;
        if (result.status == number_status::malformed) {
            const bool n_is_wrong = parse_quotient(n, "1", true).status == result.status;
            lines_.fail((n_is_wrong ? "numerator of " : "denominator of ") + name + " is " +
                        excerpt(n_is_wrong ? n : d) + "; expected an integer");
        }
        // Each side has its own quotes, so that a long one does not hide the other.
        fail_at_number(result.status, name, excerpt(n) + "/" + excerpt(d));
    }

    /// Callers build `found` only for an error, because it costs more than parsing.
    [[noreturn]] void fail_at_number(number_status status, const std::string& name,
                                     const std::string& found) const {
        lines_.fail(describe(status, name, found) +
                    (status == number_status::inexact ? " (or --round)" : ""));
    }

    void read_truth(std::string_view token) {
        if (token != "0" && token != "1")
            lines_.fail("truth is " + excerpt(token) + "; expected 0 or 1");
        const bool value = token == "1";
        if (row_ == 0) {
            truth_.push_back(value);
        } else if (truth_.back() != value) {
            lines_.fail("truth is " + std::string(token) + "; expected " + (value ? "0" : "1") +
                        " as in the first row of this query");
        }
    }

    void add_query() {
        const auto& p = points_;
        const moving_point<double> first{p[0], p[4]}, second{p[1], p[5]}, third{p[2], p[6]},
            fourth{p[3], p[7]};
        std::visit(
            [&](auto& all) {
                all.push_back({first, second, third, fourth});
            },
            result_.queries);
        row_ = 0;
    }

    line_reader lines_;
    bool round_;
    query_file result_;
    std::vector<bool> truth_;
    std::array<point<double>, rows_per_query> points_;
    std::size_t columns_;  ///< of every row; 0 before the first
    std::size_t row_ = 0;  ///< within the query
};

/// Collects booleans during the parse. A parsed document's destructor would allocate memory, and
/// end the program if there is none.
class truth_reader final : public nlohmann::json_sax<nlohmann::json> {
  public:
    explicit truth_reader(const std::string& name) : name_(name) {}

    std::vector<bool> result() { return std::move(result_); }

    bool boolean(bool value) override {
        if (!in_array_) refuse("boolean");
        result_.push_back(value);
        return true;
    }
    bool start_array(std::size_t) override {
        if (in_array_) refuse("array");
        return in_array_ = true;
    }
    bool end_array() override { return true; }

    bool null() override { refuse("null"); }
    bool number_integer(number_integer_t) override { refuse("number"); }
    bool number_unsigned(number_unsigned_t) override { refuse("number"); }
    bool number_float(number_float_t, const string_t&) override { refuse("number"); }
    bool string(string_t&) override { refuse("string"); }
    bool binary(binary_t&) override { refuse("binary"); }
    bool start_object(std::size_t) override { refuse("object"); }
    bool key(string_t&) override { refuse("object"); }
    bool end_object() override { refuse("object"); }

    bool parse_error(std::size_t position, const std::string&,
                     const nlohmann::json::exception& error) override {
        if (dynamic_cast<const nlohmann::json::parse_error*>(&error) == nullptr)
            throw file_error(name_ +
                             ": a number is out of range; expected a JSON array of booleans");
        throw file_error(name_ + ": text at byte " + std::to_string(position) +
                         " is not JSON; expected a JSON array of booleans");
    }

  private:
    [[noreturn]] void refuse(const char* found) const {
        if (!in_array_)
            throw file_error(name_ + ": type is " + found + "; expected a JSON array of booleans");
        throw file_error(name_ + ": type of element " + std::to_string(result_.size()) + " is " +
                         found + "; expected true or false");
    }

    const std::string& name_;
    std::vector<bool> result_;
    bool in_array_ = false;
};

}  // namespace

std::vector<std::string> kind_names() {
    std::vector<std::string> names;
    for (const kind k : stored_kinds) names.emplace_back(short_name(k));
    return names;
}

std::optional<ccd::kind> kind_from_path(const fs::path& path) {
    const std::string stem = path.stem().string();
    for (const kind k : stored_kinds)
        // "227vf" and "vf" name a kind, "coffee" does not.
        if (stem.ends_with(short_name(k)) &&
            (stem.size() == 2 || !std::isalpha(static_cast<unsigned char>(stem[stem.size() - 3]))))
            return k;
    std::optional<kind> result;  // of the innermost folder that names a kind
    for (const fs::path& part : path)
        if (const auto k = find_kind(part.stem().string())) result = k;
    return result;
}

query_file parse_queries(std::string_view text, const std::string& name, ccd::kind kind,
                         bool round) {
    return query_parser(text, name, kind, round).parse();
}

query_file parse_rows(std::string_view text, const std::string& name, ccd::kind kind, bool round,
                      std::uint64_t rows, std::uint64_t columns) {
    return query_parser(text, name, kind, round, rows, columns).parse();
}

namespace {

bool is_store_file(const fs::path& path) {
    std::error_code error;
    if (!fs::is_regular_file(path, error)) return false;
    std::array<char, 8> first{};
    std::ifstream(path, std::ios::binary).read(first.data(), first.size());
    return is_store({first.data(), first.size()});
}

ccd::kind kind_in(const store_reader& store, const std::string& name,
                  const std::optional<ccd::kind>& expected) {
    if (expected && *expected != store.kind())
        throw file_error(name + ": kind of queries is " + std::string(ccd::name(store.kind())) +
                         "; expected " + std::string(ccd::name(*expected)));
    return store.kind();
}

}  // namespace

ccd::kind kind_of_file(const fs::path& path, std::optional<ccd::kind> kind) {
    if (is_store_file(path)) return kind_in(*open_store(path), path.string(), kind);
    if (!kind) kind = kind_from_path(path);
    if (!kind)
        throw file_error(path.string() +
                         ": path has no kind of query; expected a folder 'vertex-face', "
                         "'edge-edge', 'vf' or 'ee', a name that ends in 'vf' or 'ee', or --kind");
    return *kind;
}

truth_file::truth_file(const fs::path& queries)
    : queries_(queries.string()),
      path_(queries.parent_path() / ".." / "mma_bool" /
            (queries.stem().string() + "_mma_bool.json")) {
    std::error_code error;
    if (fs::exists(path_, error)) truth_ = parse_truth(read_whole(path_), path_.string());
}

void truth_file::add_to(query_file& queries, std::uint64_t first, bool is_last) const {
    if (!truth_ || queries.truth) return;
    const std::size_t end = first + queries.size();
    if (is_last ? truth_->size() != end : truth_->size() < end)
        throw file_error(path_.string() + ": number of truth values is " +
                         std::to_string(truth_->size()) + "; expected " +
                         (is_last ? "" : "at least ") + std::to_string(end) +
                         ", one for each query of " + queries_);
    queries.truth.emplace(truth_->begin() + static_cast<std::ptrdiff_t>(first),
                          truth_->begin() + static_cast<std::ptrdiff_t>(end));
}

query_file parse_stored_queries(std::string_view bytes, const std::string& name,
                                std::optional<ccd::kind> kind, bool round) {
    if (!is_store(bytes)) return parse_queries(bytes, name, kind_of_file(name, kind), round);
    const auto store = open_store(bytes, name);
    kind_in(*store, name, kind);
    return store->read(0, store->size());
}

query_file read_queries(const fs::path& path, std::optional<ccd::kind> kind, bool round,
                        file_range range) {
    const auto end_in = [&](std::uint64_t size) {
        if (range.first > 0 && range.first >= size)
            throw file_error(path.string() + ": number of queries is " + std::to_string(size) +
                             "; expected more than the first " + std::to_string(range.first) +
                             ", which are skipped");
        return range.first + std::min(range.count, size - range.first);
    };
    if (is_store_file(path)) {  // only the range is read
        const auto store = open_store(path);
        kind_in(*store, path.string(), kind);
        return store->read(range.first, end_in(store->size()));
    }
    const std::string text = read_whole(path);
    query_file result = parse_stored_queries(text, path.string(), kind, round);
    if (!result.truth && !is_store(text)) truth_file(path).add_to(result, 0, true);
    const auto keep = [first = static_cast<std::ptrdiff_t>(range.first),
                       end = static_cast<std::ptrdiff_t>(end_in(result.size()))](auto& all) {
        all.erase(all.begin() + end, all.end());
        all.erase(all.begin(), all.begin() + first);
    };
    std::visit(keep, result.queries);
    if (result.truth) keep(*result.truth);
    return result;
}

std::vector<bool> parse_truth(std::string_view text, const std::string& name) {
    truth_reader reader(name);
    nlohmann::json::sax_parse(text, &reader);
    return reader.result();
}

}  // namespace ccd::io
