// `ccd_mpi query`: what `ccd query` does, over ranks, each of which reads and decides ranges of
// queries.
#include "ccd/program/query_command.hpp"

#include <algorithm>
#include <cstddef>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>

#include "ccd/io/query_ranges.hpp"
#include "ccd/mpi/exchange.hpp"
#include "ccd/program/mpi/commands.hpp"
#include "errbound/study/options.hpp"
#include "errbound/support/command_line.hpp"

namespace ccd::program {
namespace {

using nlohmann::ordered_json;

/// As an array, in the order of ranges; null where there is no truth.
ordered_json packed(const query_result& r) {
    const auto or_null = [](const std::optional<std::size_t>& count) {
        return count ? ordered_json(*count) : ordered_json(nullptr);
    };
    return {r.queries,
            r.collisions,
            or_null(r.false_positives),
            or_null(r.false_negatives),
            r.verdicts,
            r.times,
            r.ns_per_query};
}

query_result unpacked(const ordered_json& from) {
    const auto count = [](const ordered_json& j) {
        return j.is_null() ? std::optional<std::size_t>() : j.get<std::size_t>();
    };
    query_result r;
    r.queries = from.at(0).get<std::size_t>();
    r.collisions = from.at(1).get<std::size_t>();
    r.false_positives = count(from.at(2));
    r.false_negatives = count(from.at(3));
    r.verdicts = from.at(4).get<std::string>();
    r.times = from.at(5).get<std::string>();
    r.ns_per_query = from.at(6).get<double>();
    return r;
}

void add(query_result& sum, const query_result& next) {
    const auto before = static_cast<double>(sum.queries), here = static_cast<double>(next.queries);
    sum.ns_per_query = (sum.ns_per_query * before + next.ns_per_query * here) / (before + here);
    sum.queries += next.queries;
    sum.collisions += next.collisions;
    const auto add_count = [](auto& to, const auto& count) {
        if (count) to = to.value_or(0) + *count;
    };
    add_count(sum.false_positives, next.false_positives);
    add_count(sum.false_negatives, next.false_negatives);
    sum.verdicts += next.verdicts;
    sum.times += next.times;
}

class distributed_query final : public query {
  public:
    explicit distributed_query(CLI::App& program) : query(program) {
        line_
            .add_option("--chunk", chunk_,
                        "Queries that are handed out, and kept in the journal, together")
            ->check(CLI::Range(std::size_t{1}, std::size_t{1} << 24))
            ->capture_default_str();
    }

    exit_status run() override {
        const asked_for asked = checked_options();
        mpi::detail::exchanger ranks(MPI_COMM_WORLD);
        read_indices(ranks);
        errbound::study::study study(MPI_COMM_WORLD,
                                     {.program = "ccd_mpi",
                                      .identity = identity_of(asked),
                                      .chunks = chunks_.size(),
                                      .work = {[&](std::uint64_t i) { return decided(i, asked); }}},
                                     journal_.path());
        return run_study(study, stopped, [&](const std::vector<std::string>& results) {
            write(summed(results, asked));
            return done;
        });
    }

  private:
    struct chunk {
        std::size_t file, range;
    };

    /// Rank 0 looks where the files' ranges are, and tells all.
    void read_indices(mpi::detail::exchanger& ranks) {
        std::vector<std::vector<io::query_range>> ranges(files_.size());
        errbound::study::on_root(MPI_COMM_WORLD, [&] {
            auto outputs = this->outputs();
            outputs.push_back(journal_.path());
            errbound::support::require_good_outputs(outputs, files_);
            for (const std::filesystem::path& file : files_) {
                io::kind_of_file(file, find_kind(kind_));
                indices_.push_back(io::index_queries(file, chunk_));
            }
        });
        indices_.resize(files_.size());
        for (std::size_t f = 0; f < files_.size(); ++f) {
            io::query_index& index = indices_[f];
            std::vector<std::uint64_t> numbers{index.columns, index.bytes, index.checksum};
            for (const io::query_range& r : index.ranges)
                numbers.insert(numbers.end(), {r.begin, r.end, r.rows});
            numbers = told_by_root(ranks, std::move(numbers));
            index = {{}, numbers[0], numbers[1], static_cast<std::uint32_t>(numbers[2])};
            for (std::size_t i = 3; i < numbers.size(); i += 3) {
                chunks_.push_back({f, index.ranges.size()});
                index.ranges.push_back({numbers[i], numbers[i + 1], numbers[i + 2]});
            }
        }
        readers_.resize(files_.size());
    }

    static std::vector<std::uint64_t> told_by_root(mpi::detail::exchanger& ranks,
                                                   std::vector<std::uint64_t> numbers) {
        if (ranks.rank() > 0) numbers.clear();
        return ranks.gather(numbers).items;
    }

    std::string identity_of(const asked_for& asked) const {
        ordered_json all{{"study", "ccd query"}, {"version", ERRBOUND_VERSION}, {"chunk", chunk_}};
        for (std::size_t f = 0; f < files_.size(); ++f)
            all["files"].push_back({{"name", files_[f].string()},
                                    {"bytes", indices_[f].bytes},
                                    {"checksum", indices_[f].checksum}});
        for (const ccd::method m : asked.methods) all["methods"].push_back(info(m).name);
        all["kind"] = kind_;
        all["round"] = round_;
        all["verdicts"] = asked.question.verdicts;
        all["times"] = asked.question.times;
        all["t_max"] = asked.question.t_max;
        all["separation"] = nullptr;
        if (asked.question.distance) all["separation"] = *asked.question.distance;
        all["device"] = asked.device.cuda;
        all["floats_first"] = asked.device.precision == cuda::precision::float32;
        return all.dump(-1, ' ', true, ordered_json::error_handler_t::replace);
    }

    std::string decided(std::uint64_t i, const asked_for& asked) {
        const auto [file, range] = chunks_[i];
        auto& reader = readers_[file];
        if (!reader)
            reader = std::make_unique<io::range_reader>(files_[file], find_kind(kind_), round_,
                                                        indices_[file]);
        const io::query_file queries = reader->read(range);
        constexpr double once = 0;  // of many ranges: their times are added
        auto results = ordered_json::array();
        for (const ccd::method m : asked.methods)
            results.push_back(packed(decide_queries(queries, files_[file].string(), m, asked.device,
                                                    asked.question, once)));
        return results.dump();
    }

    /// A result for each file and method, of all the file's ranges.
    std::vector<query_result> summed(const std::vector<std::string>& results,
                                     const asked_for& asked) const {
        std::vector<query_result> sums(files_.size() * asked.methods.size());
        for (std::size_t f = 0; f < files_.size(); ++f)
            for (std::size_t m = 0; m < asked.methods.size(); ++m) {
                query_result& sum = sums[f * asked.methods.size() + m];
                sum.file = files_[f].string();
                sum.kind = io::kind_of_file(files_[f], find_kind(kind_));
                sum.method = asked.methods[m];
            }
        for (std::size_t i = 0; i < chunks_.size(); ++i) {
            const ordered_json all = ordered_json::parse(results[i]);
            for (std::size_t m = 0; m < asked.methods.size(); ++m)
                add(sums[chunks_[i].file * asked.methods.size() + m], unpacked(all.at(m)));
        }
        return sums;
    }

    std::size_t chunk_ = 65536;
    errbound::study::journal_option journal_{line_};
    std::vector<io::query_index> indices_;  ///< of each file
    std::vector<std::unique_ptr<io::range_reader>> readers_;
    std::vector<chunk> chunks_;
};

}  // namespace

std::unique_ptr<command> distributed_query_command(CLI::App& program) {
    return std::make_unique<distributed_query>(program);
}

}  // namespace ccd::program
