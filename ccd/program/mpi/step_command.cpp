// `ccd_mpi step`: each rank reads a share of the files; rank 0 writes all pairs.
#include <algorithm>
#include <ccd/mpi.hpp>
#include <iostream>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "ccd/lab/timing.hpp"
#include "ccd/mpi/exchange.hpp"
#include "ccd/program/command.hpp"
#include "ccd/program/mpi/shared_frames.hpp"
#include "ccd/program/options.hpp"
#include "ccd/program/pair_lines.hpp"
#include "errbound/support/output_file.hpp"
#include "errbound/support/system/system.hpp"
#include "errbound/support/table.hpp"

namespace ccd::program {
namespace {

using errbound::support::fixed;
using errbound::support::grouped;
using errbound::support::usage_error;

struct rank_report {
    mpi::rank_work work;
    std::uint64_t decided = 0, vertices = 0;
    std::size_t memory = 0;
    double read_seconds = 0;
};

class distributed_step final : public command {
  public:
    explicit distributed_step(CLI::App& program)
        : command(program, "step", "Find the colliding pairs of one step of a mesh") {
        add(line_, "FRAME0", before_, "PLY or OBJ, readable on all ranks").required();
        add(line_, "FRAME1", after_, "PLY or OBJ, same topology").required();
        add(line_, "--method", method_, "The method; exact by default").type("M");
        add_output(line_, "--pairs", pairs_,
                   "Write the lines of ccd step --pairs, sorted; -: standard output");
        add_output(line_, "--toi", toi_,
                   "Write the same lines, each followed by ,low,high: the first contact is\n"
                   "between these times; -: standard output");
        add_threads_option(line_, threads_, "Threads of each rank; 0: one per core");
        add_flag(line_, "!--no-check-start", check_start_,
                 "Do not look for elements that intersect in FRAME0");
        add_flag(line_, "--candidates", candidates_, "Count candidates, in total and by rank");
        add_output(line_, "--json", json_,
                   "Write counts, seconds and the work of each rank as JSON");
    }

    exit_status run() override {
        mpi::detail::exchanger ranks(MPI_COMM_WORLD);
        step_options options = checked_options();
        const bool is_root = ranks.rank() == 0;
        ranks.agree([&] {
            if (is_root)
                errbound::support::require_good_outputs({pairs_, toi_, json_}, {before_, after_});
        });
        const auto start = lab::clock::now();
        const shared_frames frames = read_shared_frames(ranks, before_, after_);
        options.filter.skip_unused = unused_.skips(frames.unused, frames.vertices);
        rank_report own;
        own.vertices = frames.numbers.size();
        own.read_seconds = lab::seconds_since(start);
        const mpi::step_result found =
            mpi::step(MPI_COMM_WORLD, frames.part(), options, mpi::placement::root);
        own.work = found.work;
        if (found.decided) for_each_kind([&]<kind K>() { own.decided += found.decided->of<K>(); });
        own.memory = errbound::support::system::peak_memory_bytes();
        const auto all = ranks.gather(std::vector{own}).items;
        ranks.agree([&] {
            if (is_root) write(frames, options, found, all);
        });
        return done;
    }

  private:
    step_options checked_options() const {
        const ccd::method method = method_named(method_);
        if (toi_ && method != method::exact)
            throw usage_error("--method is " + method_ + "; expected exact with --toi");
        return {.method = method,
                .threads = threads_,
                .count_candidates = candidates_ || method != method::exact,
                .times = toi_.has_value(),
                .check_start = check_start_};
    }

    void write(const shared_frames& frames, const step_options& options,
               const mpi::step_result& found, const std::vector<rank_report>& ranks) const {
        const bool skipped = options.filter.skip_unused;
        std::vector<errbound::support::output> outputs;
        if (pairs_) outputs.push_back({*pairs_, lines_of_pairs(found.pairs)});
        if (toi_) outputs.push_back({*toi_, lines_of_pairs(found.pairs, &found.times)});
        nlohmann::ordered_json document = json_of(found, ranks);
        add_unused(document, frames.unused, skipped);
        if (json_) outputs.push_back({*json_, document.dump(2) + '\n'});
        errbound::support::write_whole(outputs);
        errbound::support::stream_for_people({pairs_, toi_, json_})
            << text_of_unused(frames.unused, frames.vertices, skipped) << text_of_step(found, ranks)
            << (check_start_ ? text_of_start(found.intersections_at_start) : "");
    }

    nlohmann::ordered_json json_of(const mpi::step_result& found,
                                   const std::vector<rank_report>& ranks) const {
        nlohmann::ordered_json document = json_of_counts(method_, found);
        if (toi_) document["first_contact"] = json_of_contact(found.first_contact);
        add_start(document, found.intersections_at_start);
        for (const rank_report& r : ranks)
            document["ranks"].push_back(
                {{"vertices_given", r.vertices},
                 {"elements_given", r.work.elements_given},
                 {"elements_held", r.work.elements_held},
                 {"bytes_sent", r.work.bytes_sent},
                 {"candidates",
                  found.candidates ? nlohmann::ordered_json(r.decided) : nlohmann::ordered_json()},
                 {"read_seconds", r.read_seconds},
                 {"step_seconds", r.work.seconds},
                 {"peak_memory_bytes", r.memory}});
        return document;
    }

    std::string text_of_step(const mpi::step_result& found,
                             const std::vector<rank_report>& ranks) const {
        errbound::support::table work = {{"rank", "elements read", "held", "bytes sent",
                                          "candidates", "read", "step", "peak memory"}};
        for (const rank_report& r : ranks)
            work.push_back({std::to_string(work.size() - 1), grouped(r.work.elements_given),
                            grouped(r.work.elements_held), grouped(r.work.bytes_sent),
                            found.candidates ? grouped(r.decided) : "-",
                            fixed(1e3 * r.read_seconds, "%.1f ms"),
                            fixed(1e3 * r.work.seconds, "%.1f ms"),
                            fixed(static_cast<double>(r.memory) / (1 << 20), "%.1f MiB")});
        const std::string first = text_of_contact(found.first_contact);
        return errbound::support::text_of(table_of_counts(method_, found), 1) + '\n' +
               errbound::support::text_of(work, 0) +
               (toi_ ? "\nfirst contact: " + first + '\n' : "");
    }

    std::filesystem::path before_, after_;
    std::string method_ = "exact";
    std::optional<std::filesystem::path> pairs_, toi_, json_;
    int threads_ = 0;
    bool candidates_ = false, check_start_ = true;
    unused_vertices_option unused_{line_};
};

}  // namespace

const command_maker distributed_step_command = make_command<distributed_step>;

}  // namespace ccd::program
