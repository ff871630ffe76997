// ./run soak: `exact`, one by one and in batches, on millions of queries: against the reference, or
// against itself on images of them; steps and advances of meshes against every pair; roots against
// FLINT.
#include "tests/soak/program/command_line.hpp"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "errbound/support/output_file.hpp"
#include "errbound/support/table.hpp"
#include "tests/soak/comparison.hpp"
#include "tests/soak/first_times.hpp"
#include "tests/soak/long_run.hpp"
#include "tests/soak/polynomials.hpp"
#include "tests/soak/steps/advances.hpp"
#include "tests/soak/steps/meshes.hpp"
#include "tests/soak/symmetries.hpp"

namespace {

namespace fs = std::filesystem;
using errbound::support::grouped;

std::atomic<bool> stop = false;
static_assert(std::atomic<bool>::is_always_lock_free, "set by a signal handler");
volatile std::sig_atomic_t caught_signal = 0;

void ask_to_stop(int signal) {
    caught_signal = signal;
    stop = true;
}

std::string duration(double seconds) {
    const auto minutes = static_cast<std::uint64_t>(seconds / 60);
    if (minutes >= 60) {
        return std::to_string(minutes / 60) + " h " + std::to_string(minutes % 60) + " min";
    }
    if (minutes >= 2) return std::to_string(minutes) + " min";
    return std::to_string(static_cast<std::uint64_t>(seconds)) + " s";
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
        const std::uint64_t done = of_.count(now.found.blocks);
        const std::uint64_t all = of_.count(blocks_);
        const auto done_here = static_cast<double>(done - of_.count(from_.found.blocks));
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
                grouped(of.count(s.found.blocks)).c_str(), of.unit.c_str(),
                duration(s.seconds).c_str(), grouped(s.found.different).c_str(),
                std::uintmax_t{s.found.checksum});
    for (const auto which : ccd::stored_kinds) {
        const fs::path path = folder / ("differences-" + std::string(short_name(which)) + ".csv");
        if (fs::exists(path)) {
            std::printf("differing queries, the reference's answer as truth: ccd query %s\n",
                        path.c_str());
        }
    }
    if (s.found.different > s.found.differences.size()) {
        std::printf("only the first %s of them are kept\n",
                    grouped(s.found.differences.size()).c_str());
    }
    std::printf("state, with all that differ: %s\n", soak::state_path(folder).c_str());
}

/// The state to go on from.
soak::state begin(const soak::part& of, std::uint64_t seed, bool seed_given, bool resume,
                  const fs::path& folder) {
    const fs::path path = soak::state_path(folder);
    if (!resume) {
        if (fs::exists(path)) {
            throw std::runtime_error(path.string() +
                                     ": found a run's state; go on with --resume, "
                                     "or forget it with --anew");
        }
        return {.seed = seed};
    }
    soak::state s;
    const std::string text = errbound::support::read_whole(path);
    try {
        s = soak::from_json(text, of);
    } catch (const std::runtime_error& error) {
        throw std::runtime_error(path.string() + ": " + error.what());
    }
    if (seed_given && s.seed != seed) {
        throw std::runtime_error(path.string() + ": found seed " + std::to_string(s.seed) +
                                 ", expected the seed given, " + std::to_string(seed));
    }
    return s;
}

std::vector<soak::decider> compared_with_reference() {
    std::vector<soak::decider> all = soak::exact_deciders();
    all.push_back(soak::unfiltered_integers());
    return all;
}

/// Runs the part to its end or to a signal; returns the exit status.
int carry_out(const soak::team& who, const soak::part& part, const soak::run_options& options,
              const soak::state& from) {
    struct sigaction action {};
    action.sa_handler = ask_to_stop;
    action.sa_flags = static_cast<int>(SA_RESETHAND);  // a second signal ends the program at once
    for (const int signal : {SIGINT, SIGTERM}) sigaction(signal, &action, nullptr);

    std::printf("%s, seed %ju: %s of %s %s done\n", part.name.c_str(), std::uintmax_t{from.seed},
                grouped(part.count(from.found.blocks)).c_str(),
                grouped(part.count(options.blocks)).c_str(), part.unit.c_str());
    std::fflush(stdout);
    progress_display display(part, from, options.blocks);
    const auto show = [&](const soak::state& now) { display(now); };
    const soak::state last = who.size == 1 ? soak::run(from, options, part, stop, show)
                                           : soak::run_shared(who, from, options, part, stop, show);
    if (who.rank != 0) return 0;
    display.end();
    report(part, last, options.folder);
    if (last.found.different > 0) return 1;
    if (last.found.blocks < options.blocks) {
        std::printf("stopped by signal %d; --resume goes on\n", static_cast<int>(caught_signal));
        return 3;
    }
    return 0;
}

/// Which part, and how much of it.
struct choice {
    std::uint64_t count = 20'000'000;
    soak::part (*part)() = [] {
        return soak::comparison_part(soak::reference(), compared_with_reference());
    };
};

void add_parts(CLI::App& app, choice& chosen) {
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

/// The state to go on from, as rank 0 reads it. Throws on all ranks what is wrong with it.
soak::state begin_shared(const soak::team& who, const soak::part& of,
                         const std::function<soak::state()>& begin) {
    if (who.size == 1) return begin();
    std::string text, failure;
    if (who.rank == 0) try {
            text = soak::to_json(begin(), of);
        } catch (const std::exception& error) {
            failure = error.what();
        }
    failure = who.share(failure);
    if (!failure.empty()) throw std::runtime_error(failure);
    return soak::from_json(who.share(text), of);
}

}  // namespace

int soak::run_program(int argc, char** argv, const team& who) try {
    CLI::App app{"What is exact against a reference, or against itself."};
    app.name("./run soak");
    choice chosen;
    std::uint64_t seed = 1;
    bool resume = false, anew = false;
    run_options options;
    add_parts(app, chosen);
    CLI::Option* const seed_option =
        app.add_option("--seed", seed, "Same seed, same questions")->capture_default_str();
    app.add_flag("--resume", resume, "Go on where the last run stopped");
    app.add_flag("--anew", anew, "Forget the last run")->excludes("--resume");
    app.add_option("--threads", options.threads, "Of each rank; 0: one per core")
        ->capture_default_str();
    app.add_option("--folder", options.folder,
                   "For the state and what differs; by default out/soak/PART");
    app.footer(
        "Exit status: 0 no difference, 1 a difference or bad input, 2 bad usage, 3 stopped "
        "by a signal (go on with --resume).");
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    }
    const struct part part = chosen.part();
    if (options.folder.empty()) options.folder = fs::path("out/soak") / part.name;
    options.blocks = part.blocks_for(chosen.count);
    const state from = begin_shared(who, part, [&] {
        if (anew) fs::remove(state_path(options.folder));
        return begin(part, seed, seed_option->count() > 0, resume, options.folder);
    });
    return carry_out(who, part, options, from);
} catch (const std::exception& error) {
    if (who.rank == 0) std::fprintf(stderr, "soak: %s\n", error.what());
    return 1;
}
