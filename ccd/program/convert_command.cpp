// `ccd convert`: converts queries between CSV and HDF5 stores.
#include <array>
#include <atomic>
#include <boost/crc.hpp>
#include <ccd/io/query_store.hpp>
#include <ccd/methods/transform.hpp>
#include <csignal>
#include <iostream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include "ccd/io/query_ranges.hpp"
#include "ccd/lab/queries.hpp"
#include "ccd/lab/timing.hpp"
#include "ccd/program/command.hpp"
#include "ccd/program/options.hpp"
#include "errbound/support/error.hpp"
#include "errbound/support/output_file.hpp"
#include "errbound/support/progress_line.hpp"
#include "errbound/support/scratch_file.hpp"
#include "errbound/support/signals.hpp"
#include "errbound/support/system/system.hpp"
#include "errbound/support/table.hpp"

namespace ccd::program {
namespace {

using errbound::support::file_error;
using errbound::support::usage_error;

struct read_file {
    std::string name;
    std::uint64_t queries = 0, bytes = 0;
    double seconds = 0;
};

class query_content {
  public:
    void add(const io::query_file& queries) {
        size_ += queries.size();
        std::visit(
            [&](const auto& all) {
                static_assert(std::is_trivially_copyable_v<std::remove_cvref_t<decltype(all[0])>>);
                for (std::size_t i = 0; i < all.size(); ++i) {
                    sum_.process_bytes(&all[i], sizeof all[i]);
                    if (queries.truth) sum_.process_byte((*queries.truth)[i] ? 1 : 0);
                }
            },
            queries.queries);
    }
    std::uint64_t size() const { return size_; }
    bool operator==(const query_content& other) const {
        return size_ == other.size_ && sum_.checksum() == other.sum_.checksum();
    }

  private:
    std::uint64_t size_ = 0;
    // CRC-64 of ECMA-182: two different random lists have equal sums with probability 2^-64.
    boost::crc_optimal<64, 0x42f0e1eba9ea3693, 0, 0, false, false> sum_;
};

std::string rows_of(const io::query_file& queries) {
    std::string text;
    std::visit(
        [&](const auto& all) {
            for (std::size_t i = 0; i < all.size(); ++i) {
                const char* const truth = !queries.truth ? "" : (*queries.truth)[i] ? ",1" : ",0";
                text += lab::csv(points_of(all[i]), truth);
            }
        },
        queries.queries);
    return text;
}

class converted {
  public:
    explicit converted(bool to_store) : to_store_(to_store) {}

    void add(const io::query_file& queries, const std::string& file) {
        if (!kind_) {
            kind_ = queries.kind();
            has_truth_ = queries.truth.has_value();
            if (to_store_)
                packer_ = io::make_query_packer(*kind_, has_truth_);
            else
                rows_.emplace();
        }
        if (queries.kind() != *kind_)
            throw file_error(file + ": kind of queries is " + std::string(name(queries.kind())) +
                             "; expected " + std::string(name(*kind_)) + ", as in the first file");
        if (queries.truth.has_value() != has_truth_)
            throw file_error(file + ": truth is " + (has_truth_ ? "missing" : "given") +
                             "; expected " + (has_truth_ ? "truth" : "none") +
                             ", as in the first file");
        content_.add(queries);
        if (to_store_)
            packer_->add(queries);
        else
            rows_->append(rows_of(queries));
    }
    const std::filesystem::path& finish() { return to_store_ ? packer_->finish() : rows_->path(); }
    kind kind_of_all() const { return *kind_; }
    const query_content& content() const { return content_; }

  private:
    bool to_store_, has_truth_ = false;
    std::optional<kind> kind_;
    query_content content_;
    std::unique_ptr<io::query_packer> packer_;
    std::optional<errbound::support::scratch_file> rows_;
};

class convert final : public command {
  public:
    explicit convert(CLI::App& program)
        : command(program, "convert", "Convert stored queries from CSV to HDF5, and back") {
        add(line_, "FILE", files_,
            "Files of queries in the formats of `ccd query`, then the output: OUT.h5 or OUT.hdf5, "
            "an\nHDF5 store, or OUT.csv, rows of hexadecimal floats")
            .required()
            .at_least(2);
        add_kind_option(line_, kind_);
        add_round_option(line_, round_);
        add_output(line_, "--json", json_, "Write the table as JSON; -: standard output");
    }

    exit_status run() override {
        const std::filesystem::path out = files_.back();
        files_.pop_back();
        const std::string ending = out.extension().string();
        const bool to_store = ending == ".h5" || ending == ".hdf5";
        if (!to_store && ending != ".csv")
            throw usage_error("output is '" + out.string() +
                              "'; expected a name that ends in .h5, .hdf5 or .csv");
        if (to_store && !io::has_query_stores())
            throw usage_error("output is '" + out.string() +
                              "'; expected .csv, since this was built without HDF5");
        errbound::support::require_good_outputs({out, json_}, files_);
        int ended_by = 0;
        {
            // Signals and failing pipes must not leave temporary files behind.
            const errbound::support::awaited_signals signals;
            const errbound::support::system::failing_pipes pipes;
            stop_ = &signals.arrived();
            if (make(out, to_store)) return done;
            ended_by = signals.arrived();
        }
        std::raise(ended_by);
        return stopped;
    }

  private:
    /// False if a signal stopped it.
    bool make(const std::filesystem::path& out, bool to_store) const {
        converted all(to_store);
        std::vector<read_file> table;
        for (const std::filesystem::path& file : files_) {
            const auto read = for_each_range(
                file, file.string(), find_kind(kind_), round_,
                [&](const io::query_file& queries) { all.add(queries, file.string()); });
            if (!read) return false;
            table.push_back(*read);
        }
        const std::filesystem::path made = all.finish();
        query_content content;
        const auto read =
            for_each_range(made, out.string(), all.kind_of_all(), false,
                           [&](const io::query_file& queries) { content.add(queries); });
        if (!read) return false;
        if (!(content == all.content()))
            throw std::runtime_error(out.string() +
                                     ": queries read back differ; expected those of the input");
        table.push_back(*read);
        std::vector<errbound::support::output> outputs{{.path = out, .from = made}};
        if (json_) outputs.push_back({*json_, json_of(table)});
        errbound::support::write_whole(outputs);
        errbound::support::stream_for_people({json_}) << text_of(table);
        return true;
    }

    /// Reads a file in ranges. Returns nothing if a signal stopped it.
    template <class Take>
    std::optional<read_file> for_each_range(const std::filesystem::path& file, std::string name,
                                            std::optional<kind> kind, bool round,
                                            const Take& take) const {
        read_file read{std::move(name)};
        io::range_reader reader(file, kind, round, 65536);
        errbound::support::progress_line progress;
        for (;;) {
            if (*stop_ != 0) return std::nullopt;
            progress.show(reader.share(), read.name);
            const auto start = lab::clock::now();
            const std::optional<io::query_file> queries = reader.next();
            read.seconds += lab::seconds_since(start);
            if (!queries) break;
            read.queries += queries->size();
            take(*queries);
        }
        read.bytes = std::filesystem::file_size(file);
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
        using errbound::support::fixed, errbound::support::grouped;
        errbound::support::table rows = {{"file", "queries", "bytes", "a query", "ns to read one"}};
        for (const read_file& f : table) {
            const auto n = static_cast<double>(f.queries);
            rows.push_back({f.name, grouped(f.queries), grouped(f.bytes),
                            fixed(static_cast<double>(f.bytes) / n, "%.1f"),
                            fixed(1e9 * f.seconds / n, "%.1f")});
        }
        return errbound::support::text_of(rows, 1);
    }

    std::vector<std::filesystem::path> files_;
    std::string kind_;
    bool round_ = false;
    std::optional<std::filesystem::path> json_;
    const std::atomic<int>* stop_ = nullptr;
};

}  // namespace

const command_maker convert_command = make_command<convert>;

}  // namespace ccd::program
