// The command line of the soak: which part, how far it is, what it has found.
#include "tests/soak/program/command_line.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "errbound/support/command_line.hpp"
#include "errbound/support/output_file.hpp"
#include "errbound/support/signals.hpp"
#include "errbound/support/table.hpp"
#include "tests/soak/comparison.hpp"
#include "tests/soak/first_times.hpp"
#include "tests/soak/polynomials.hpp"
#include "tests/soak/steps/advances.hpp"
#include "tests/soak/steps/meshes.hpp"
#include "tests/soak/symmetries.hpp"

namespace soak {
namespace {

namespace fs = std::filesystem;
using errbound::support::grouped;

std::string duration(double seconds) {
    const auto minutes = static_cast<std::uint64_t>(seconds / 60);
    if (minutes >= 60) {
        return std::to_string(minutes / 60) + " h " + std::to_string(minutes % 60) + " min";
    }
    if (minutes >= 2) return std::to_string(minutes) + " min";
    return std::to_string(static_cast<std::uint64_t>(seconds)) + " s";
}

/// The number of questions in the first `blocks` blocks of a run.
std::uint64_t questions_of(const soak::part& of, std::uint64_t first, std::uint64_t blocks) {
    const std::uint64_t before = of.blocks_for(first);
    return of.count(before + blocks) - of.count(before);
}
std::uint64_t questions_of(const soak::part& of, const soak::state& s) {
    return questions_of(of, s.first, s.found.blocks);
}

/// A bar that moves on a terminal; elsewhere a line at half-minute intervals.
class progress_display {
  public:
    progress_display(const soak::part& of, const soak::state& from, std::uint64_t blocks)
        : of_(of), from_(from), blocks_(blocks), terminal_(isatty(STDOUT_FILENO) == 1) {}

    void operator()(const soak::state& now) {
        const double here = now.seconds - from_.seconds;
        if (here < shown_ + (terminal_ ? 0.5 : 30)) return;
        shown_ = here;
        const std::uint64_t done = questions_of(of_, now);
        const std::uint64_t all = questions_of(of_, from_.first, blocks_);
        const auto done_here = static_cast<double>(done - questions_of(of_, from_));
        const double rate = done_here / here;
        const double share = static_cast<double>(done) / static_cast<double>(all);
        std::string bar;
        if (terminal_) {
            constexpr std::size_t width = 30;
            bar.assign(static_cast<std::size_t>(share * width), '#');
            bar.resize(width, '.');
            bar = "\r[" + bar + "] ";
        }
        std::printf("%s%5.1f %%  %s of %s %s, %s a second, %s differ, %s left", bar.c_str(),
                    100 * share, grouped(done).c_str(), grouped(all).c_str(), of_.unit.c_str(),
                    grouped(static_cast<std::uint64_t>(rate)).c_str(),
                    grouped(now.found.different).c_str(),
                    rate > 0 ? duration(static_cast<double>(all - done) / rate).c_str() : "?");
        std::fputs(terminal_ ? "\x1b[K" : "\n", stdout);  // the rest of an older, longer line
        std::fflush(stdout);
    }
    void end() const {
        if (terminal_ && shown_ > 0) std::puts("");
    }

  private:
    const soak::part& of_;
    soak::state from_;
    std::uint64_t blocks_;
    bool terminal_;
    double shown_ = 0;  // seconds of this sitting
};

/// With each row's share of the first column, and the sum of all rows.
std::string text_of(const soak::count_table& counts) {
    std::vector<std::uint64_t> sums(counts.columns.size());
    for (const auto& row : counts.rows)
        for (std::size_t k = 0; k < sums.size(); ++k) sums[k] += row.counts[k];
    errbound::support::table text{{counts.title}};
    text[0].insert(text[0].end(), counts.columns.begin(), counts.columns.end());
    text[0].emplace_back("share");
    const auto add = [&](const std::string& name, const std::vector<std::uint64_t>& row) {
        auto& cells = text.emplace_back(std::vector<std::string>{name});
        for (const std::uint64_t n : row) cells.push_back(grouped(n));
        char share[32];
        std::snprintf(share, sizeof share, "%.2f %%",
                      100 * static_cast<double>(row[0]) /
                          static_cast<double>(std::max<std::uint64_t>(sums[0], 1)));
        cells.emplace_back(share);
    };
    for (const auto& row : counts.rows) add(row.name, row.counts);
    add("all", sums);
    return errbound::support::text_of(text, 1);
}

void report(const soak::part& of, const soak::state& s, const fs::path& folder) {
    for (const soak::count_table& table : s.found.tables)
        std::printf("\n%s", text_of(table).c_str());
    for (std::size_t i = 0; i < s.found.differences.size() && i < 10; ++i)
        std::printf("\n%s", s.found.differences[i].text.c_str());
    std::printf("\nseed %ju: %s %s in %s, %s differ, checksum %016jx\n", std::uintmax_t{s.seed},
                grouped(questions_of(of, s)).c_str(), of.unit.c_str(), duration(s.seconds).c_str(),
                grouped(s.found.different).c_str(), std::uintmax_t{s.found.checksum});
    for (const auto which : ccd::stored_kinds) {
        const fs::path path = folder / ("differences-" + std::string(short_name(which)) + ".csv");
        if (fs::exists(path)) {
            std::printf("differing queries, the reference's answer as truth: ccd query %s\n",
                        path.string().c_str());
        }
    }
    if (s.found.different > s.found.differences.size()) {
        std::printf("only the first %s of them are kept\n",
                    grouped(s.found.differences.size()).c_str());
    }
    std::printf("state, with all that differ: %s\n", soak::state_path(folder).string().c_str());
}

/// The state to go on from. Options that are given must agree with a resumed state.
soak::state begin(const soak::part& of, std::optional<std::uint64_t> seed,
                  std::optional<std::uint64_t> first, bool resume, const fs::path& folder) {
    const fs::path path = soak::state_path(folder);
    if (!resume) {
        if (fs::exists(path)) {
            throw std::runtime_error(path.string() +
                                     ": found a run's state; go on with --resume, "
                                     "or forget it with --anew");
        }
        return {.seed = seed.value_or(1), .first = first.value_or(0)};
    }
    soak::state s;
    const std::string text = errbound::support::read_whole(path);
    try {
        s = soak::from_json(text, of);
    } catch (const std::runtime_error& error) {
        throw std::runtime_error(path.string() + ": " + error.what());
    }
    const auto require_same = [&](const char* name, std::uint64_t found, auto given) {
        if (given && found != *given)
            throw std::runtime_error(path.string() + ": found " + name + " " +
                                     std::to_string(found) + ", expected the " + name + " given, " +
                                     std::to_string(*given));
    };
    require_same("seed", s.seed, seed);
    require_same("first", s.first, first);
    return s;
}

std::vector<soak::decider> compared_with_reference() {
    std::vector<soak::decider> all = soak::exact_deciders();
    all.push_back(soak::unfiltered_integers());
    return all;
}

void add_parts(CLI::App& app, command_line::choice& chosen) {
    CLI::Option* const queries =
        app.add_option("--queries", chosen.count,
                       "At least so many, a resumed run's earlier ones included")
            ->capture_default_str();
    CLI::Option_group& parts = *app.add_option_group("Instead");
    parts.require_option(0, 1);
    const auto of_queries = [&](const char* name, const char* what, soak::part (*part)()) {
        parts.add_flag_callback(
            name, [&chosen, part] { chosen.part = part; }, what);
    };
    const auto counted = [&](const char* name, const char* what, soak::part (*part)()) {
        const auto choose = [&chosen, part](std::uint64_t count) { chosen = {count, part}; };
        parts.add_option_function<std::uint64_t>(name, choose, what)
            ->type_name("N")
            ->excludes(queries);
    };
    of_queries("--symmetries",
               "Without a reference: images of a query, by all ways of asking, have one answer",
               [] { return soak::symmetry_part(soak::symmetric_deciders()); });
#ifdef ERRBOUND_HAS_ORACLE
    of_queries("--times", "First times of contact, against an oracle",
               [] { return soak::contact_time_part(soak::contact_deciders()); });
    of_queries("--separation", "First times within distances, against an oracle",
               [] { return soak::distance_time_part(soak::distance_deciders()); });
#endif
    counted("--meshes", "Steps of so many small meshes, by the reference on every pair",
            [] { return soak::mesh_part(); });
#ifdef ERRBOUND_HAS_ORACLE
    counted("--advances", "Advances of so many small meshes, by the oracle on every pair",
            [] { return soak::advance_part(); });
#endif
#ifdef ERRBOUND_HAS_FLINT
    counted("--polynomials", "So many polynomials' roots, against FLINT's counts",
            soak::polynomial_part);
#endif
}

}  // namespace

command_line::command_line() {
    chosen_.part = [] {
        return soak::comparison_part(soak::reference(), compared_with_reference());
    };
    app_.name("./run soak");
    add_parts(app_, chosen_);
    app_.add_option("--seed", seed_, "Same seed, same questions; 1 by default")
        ->check(errbound::support::checked_seed);
    app_.add_option(
            "--first", first_,
            "Skip the first N questions of the seed's sequence. Runs with --first 0, M, 2M, ...\n"
            "and M questions each partition one long run")
        ->check(CLI::Range(std::uint64_t{0}, std::uint64_t{1} << 40));
    app_.add_flag("--resume", resume_, "Go on where the last run stopped");
    app_.add_flag("--anew", anew_, "Forget the last run")->excludes("--resume");
    app_.add_option("--threads", options_.threads, "0: one per core")->capture_default_str();
    app_.add_option("--folder", options_.folder,
                    "For the state and what differs; by default out/soak/PART");
    app_.footer(
        "Exit status: 0 no difference, 1 a difference or bad input, 2 bad usage, 3 stopped "
        "by a signal (go on with --resume).");
}

void command_line::parse(int argc, char** argv) {
    app_.parse(argc, argv);
    part_ = chosen_.part();
    if (options_.folder.empty()) options_.folder = fs::path("out/soak") / part_.name;
}

int command_line::run() const {
    if (anew_) fs::remove(soak::state_path(options_.folder));
    const state from = begin(part_, seed_, first_, resume_, options_.folder);
    run_options options = options_;
    options.blocks = part_.blocks_for(from.first + chosen_.count) - part_.blocks_for(from.first);
    const errbound::support::awaited_signals signals("soak: asked to end; --resume goes on\n");
    std::printf("%s, seed %ju: %s of %s %s done\n", part_.name.c_str(), std::uintmax_t{from.seed},
                grouped(questions_of(part_, from)).c_str(),
                grouped(questions_of(part_, from.first, options.blocks)).c_str(),
                part_.unit.c_str());
    std::fflush(stdout);
    progress_display display(part_, from, options.blocks);
    const soak::state last = soak::run(from, options, part_, signals.arrived(),
                                       [&](const soak::state& now) { display(now); });
    display.end();
    report(part_, last, options_.folder);
    if (last.found.different > 0) return 1;
    if (last.found.blocks < options.blocks) {
        std::printf("stopped by signal %d; --resume goes on\n", signals.arrived().load());
        return 3;
    }
    return 0;
}

}  // namespace soak
