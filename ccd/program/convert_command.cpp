// `ccd convert`: stored queries from CSV to a store and back.
#include <ccd/io/query_store.hpp>
#include <ccd/methods/transform.hpp>
#include <chrono>
#include <cstdio>
#include <iostream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "ccd/io/query_ranges.hpp"
#include "ccd/program/command.hpp"
#include "ccd/program/options.hpp"
#include "ccd/stress/generators/query_points.hpp"
#include "errbound/support/command_line.hpp"
#include "errbound/support/error.hpp"
#include "errbound/support/output_file.hpp"
#include "errbound/support/progress_line.hpp"
#include "errbound/support/table.hpp"

namespace ccd::program {
namespace {

using errbound::support::file_error;
using errbound::support::usage_error;

/// A file's size, and what it took to read its queries.
struct read_file {
    std::string name;
    std::uint64_t queries = 0, bytes = 0;
    double seconds = 0;
};

/// Rows of hexadecimal floats, and of truth where it is known.
void append_rows(std::string& text, const io::query_file& queries) {
    std::visit(
        [&](const auto& all) {
            for (std::size_t i = 0; i < all.size(); ++i) {
                const char* const truth = !queries.truth ? "" : (*queries.truth)[i] ? ",1" : ",0";
                text += stress::csv(points_of(all[i]), truth);
            }
        },
        queries.queries);
}

/// What the output is made of, as queries come in.
class converted {
  public:
    explicit converted(bool to_store) : to_store_(to_store) {}

    void add(const io::query_file& queries, const std::string& file) {
        if (!kind_) {
            kind_ = queries.kind();
            has_truth_ = queries.truth.has_value();
            if (to_store_) packer_.emplace(*kind_, has_truth_);
        }
        if (queries.kind() != *kind_)
            throw file_error(file + ": found queries of kind " + std::string(name(queries.kind())) +
                             ", expected " + std::string(name(*kind_)) + " as in the first file");
        if (queries.truth.has_value() != has_truth_)
            throw file_error(file + ": found queries " + (has_truth_ ? "without" : "with") +
                             " truth, expected " + (has_truth_ ? "it" : "none") +
                             " as in the first file");
        if (to_store_)
            packer_->add(queries);
        else
            append_rows(text_, queries);
    }
    std::string bytes() const { return to_store_ ? packer_->bytes() : text_; }
    kind kind_of_all() const { return *kind_; }

  private:
    bool to_store_, has_truth_ = false;
    std::optional<kind> kind_;
    std::optional<io::query_packer> packer_;
    std::string text_;
};

class convert final : public command {
  public:
    explicit convert(CLI::App& program)
        : command(program, "convert", "Stored queries from CSV to HDF5, and back") {
        line_
            .add_option(
                "FILE", files_,
                "Queries, as `ccd query` reads them, then the output: OUT.h5 or OUT.hdf5, a\n"
                "store of queries, or OUT.csv, rows of hexadecimal floats")
            ->required()
            ->expected(2, -1);
        line_
            .add_option("--kind", kind_,
                        "Kind of query; else the path says (vertex-face or vf, edge-edge or ee)")
            ->check(CLI::IsMember(io::kind_names()));
        line_.add_flag("--round", round_,
                       "Round rationals and hexadecimal floats that no double equals, instead of\n"
                       "refusing them");
        line_.add_option("--json", json_, "Write the table as JSON; -: standard output")
            ->type_name("OUT");
    }

    exit_status run() override {
        const std::filesystem::path out = files_.back();
        files_.pop_back();
        const std::string ending = out.extension().string();
        const bool to_store = ending == ".h5" || ending == ".hdf5";
        if (!to_store && ending != ".csv")
            throw usage_error("FILE: found the output '" + out.string() +
                              "', expected a name that ends in .h5, .hdf5 or .csv");
        if (to_store && !io::has_query_stores())
            throw usage_error("FILE: found '" + out.string() +
                              "', expected a .csv: this was built without HDF5");
        errbound::support::require_good_outputs({out, json_}, files_);
        converted all(to_store);
        std::vector<read_file> table;
        for (const std::filesystem::path& file : files_) table.push_back(take(file, all));
        const std::string bytes = all.bytes();
        table.push_back(read_back(out, bytes, all, table));
        std::vector<errbound::support::output> outputs{{out, bytes}};
        if (json_) outputs.push_back({*json_, json_of(table)});
        errbound::support::write_whole(outputs);
        errbound::support::stream_for_people({json_}) << text_of(table);
        return done;
    }

  private:
    static double seconds_since(std::chrono::steady_clock::time_point start) {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    }

    read_file take(const std::filesystem::path& file, converted& all) const {
        read_file read{file.string()};
        const io::query_index index = io::index_queries(file, 65536);
        io::range_reader reader(file, find_kind(kind_), round_, index);
        errbound::support::progress_line progress;
        for (std::size_t i = 0; i < index.ranges.size(); ++i) {
            progress.show(i, index.ranges.size(), read.name);
            const auto start = std::chrono::steady_clock::now();
            const io::query_file queries = reader.read(i);
            read.seconds += seconds_since(start);
            read.queries += queries.size();
            all.add(queries, read.name);
        }
        read.bytes = index.bytes;
        return read;
    }

    /// What was made has to be what was read.
    static read_file read_back(const std::filesystem::path& out, const std::string& bytes,
                               const converted& made, const std::vector<read_file>& from) {
        const auto start = std::chrono::steady_clock::now();
        const io::query_file queries =
            io::parse_stored_queries(bytes, out.string(), made.kind_of_all(), false);
        read_file read{out.string(), queries.size(), bytes.size(), seconds_since(start)};
        converted again(out.extension() != ".csv");
        again.add(queries, read.name);
        std::uint64_t expected = 0;
        for (const read_file& f : from) expected += f.queries;
        if (read.queries != expected || again.bytes() != bytes)
            throw std::runtime_error(out.string() + ": what was made reads back as something else");
        return read;
    }

    static std::string json_of(const std::vector<read_file>& table) {
        auto rows = nlohmann::ordered_json::array();
        for (const read_file& f : table)
            rows.push_back({{"file", f.name},
                            {"queries", f.queries},
                            {"bytes", f.bytes},
                            {"seconds", f.seconds}});
        return rows.dump(2, ' ', true, nlohmann::ordered_json::error_handler_t::replace) + "\n";
    }

    static std::string text_of(const std::vector<read_file>& table) {
        const auto digits = [](double x) {
            char text[32];
            std::snprintf(text, sizeof text, "%.1f", x);
            return std::string(text);
        };
        errbound::support::table rows = {{"file", "queries", "bytes", "a query", "ns to read one"}};
        for (const read_file& f : table) {
            const auto n = static_cast<double>(f.queries);
            rows.push_back({f.name, errbound::support::grouped(f.queries),
                            errbound::support::grouped(f.bytes),
                            digits(static_cast<double>(f.bytes) / n), digits(1e9 * f.seconds / n)});
        }
        return errbound::support::text_of(rows, 1);
    }

    std::vector<std::filesystem::path> files_;
    std::string kind_;
    bool round_ = false;
    std::optional<std::filesystem::path> json_;
};

}  // namespace

std::unique_ptr<command> convert_command(CLI::App& program) {
    return std::make_unique<convert>(program);
}

}  // namespace ccd::program
