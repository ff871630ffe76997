// ./run soak: `exact`, one by one and in batches, against the reference on millions of queries.
#include <unistd.h>

#include <CLI/CLI.hpp>
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
#include "tests/soak/long_run.hpp"

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
    progress_display(const soak::state& from, std::uint64_t blocks)
        : from_(from), blocks_(blocks), terminal_(isatty(STDOUT_FILENO) == 1) {}

    void operator()(const soak::state& now) {
        const double here = now.seconds - from_.seconds;
        if (here < shown_ + (terminal_ ? 0.5 : 30)) return;
        shown_ = here;
        const std::uint64_t done = soak::query_count(now.found.blocks);
        const std::uint64_t all = soak::query_count(blocks_);
        const auto done_here = static_cast<double>(done - soak::query_count(from_.found.blocks));
        const double rate = done_here / here;
        const double share = static_cast<double>(done) / static_cast<double>(all);
        std::string bar;
        if (terminal_) {
            constexpr std::size_t width = 30;
            bar.assign(static_cast<std::size_t>(share * width), '#');
            bar.resize(width, '.');
            bar = "\r[" + bar + "] ";
        }
        std::printf("%s%5.1f %%  %s of %s queries, %s a second, %s differ, %s left", bar.c_str(),
                    100 * share, grouped(done).c_str(), grouped(all).c_str(),
                    grouped(static_cast<std::uint64_t>(rate)).c_str(),
                    grouped(now.found.differing_queries).c_str(),
                    rate > 0 ? duration(static_cast<double>(all - done) / rate).c_str() : "?");
        std::fputs(terminal_ ? "\x1b[K" : "\n", stdout);  // the rest of an older, longer line
        std::fflush(stdout);
    }
    void end() const {
        if (terminal_ && shown_ > 0) std::puts("");
    }

  private:
    soak::state from_;
    std::uint64_t blocks_;
    bool terminal_;
    double shown_ = 0;  // seconds of this sitting
};

void report(const soak::state& s, const fs::path& folder) {
    errbound::support::table families{
        {"family", "vf queries", "vf collisions", "ee queries", "ee collisions"}};
    soak::kind_counts sum[2];
    const auto row = [&](std::string title, const soak::kind_counts& vf,
                         const soak::kind_counts& ee) {
        families.push_back({std::move(title), grouped(vf.queries), grouped(vf.collisions),
                            grouped(ee.queries), grouped(ee.collisions)});
    };
    for (std::size_t f = 0; f < soak::family_count; ++f) {
        for (std::size_t k = 0; k < 2; ++k) {
            sum[k].queries += s.found.families[k][f].queries;
            sum[k].collisions += s.found.families[k][f].collisions;
        }
        const auto& family = query_families::families[f];
        const unsigned thinning = soak::thinning(family);
        row(std::string(family.name) + (thinning > 1 ? ", 1 in " + std::to_string(thinning) : ""),
            s.found.families[0][f], s.found.families[1][f]);
    }
    row("all", sum[0], sum[1]);
    errbound::support::table deciders{{"against the reference", "compared", "differences"}};
    for (const auto& d : s.found.deciders) {
        deciders.push_back({d.name, grouped(d.compared), grouped(d.differences)});
    }
    std::puts(
        "\nfamilies: tests/support/query_families.hpp; 1 in N: a query takes tenths of a second");
    std::printf("\n%s\n%s\n", errbound::support::text_of(families, 1).c_str(),
                errbound::support::text_of(deciders, 1).c_str());
    std::printf("seed %ju: %s queries in %s, %s differ\n", std::uintmax_t{s.seed},
                grouped(sum[0].queries + sum[1].queries).c_str(), duration(s.seconds).c_str(),
                grouped(s.found.differing_queries).c_str());
    for (const auto which : ccd::stored_kinds) {
        const fs::path path = soak::differences_path(folder, which);
        if (fs::exists(path)) {
            std::printf("differing queries, the reference's answer as truth: ccd query %s\n",
                        path.c_str());
        }
    }
    if (s.found.differing_queries > s.found.differences.size()) {
        std::printf("only the first %s of them are kept\n",
                    grouped(s.found.differences.size()).c_str());
    }
    std::printf("state: %s\n", soak::state_path(folder).c_str());
}

/// The state to go on from.
soak::state begin(std::uint64_t seed, bool seed_given, bool resume, const fs::path& folder) {
    const fs::path path = soak::state_path(folder);
    if (!resume) {
        if (fs::exists(path)) {
            throw std::runtime_error(path.string() +
                                     ": found a run's state; go on with --resume, "
                                     "or remove the file to start anew");
        }
        return {.seed = seed};
    }
    soak::state s;
    const std::string text = errbound::support::read_whole(path);
    try {
        s = soak::from_json(text);
    } catch (const std::runtime_error& error) {
        throw std::runtime_error(path.string() + ": " + error.what());
    }
    if (seed_given && s.seed != seed) {
        throw std::runtime_error(path.string() + ": found seed " + std::to_string(s.seed) +
                                 ", expected the seed given, " + std::to_string(seed));
    }
    return s;
}

}  // namespace

int main(int argc, char** argv) try {
    CLI::App app{"The exact method, one by one and in batches, against the reference."};
    app.name("./run soak");
    std::uint64_t queries = 20'000'000, seed = 1;
    bool resume = false;
    soak::run_options options{.folder = "out/soak"};
    app.add_option("--queries", queries, "At least so many, a resumed run's earlier ones included")
        ->capture_default_str();
    CLI::Option* const seed_option =
        app.add_option("--seed", seed, "Same seed, same queries")->capture_default_str();
    app.add_flag("--resume", resume, "Go on where the last run stopped");
    app.add_option("--threads", options.threads, "0: one per core")->capture_default_str();
    app.add_option("--folder", options.folder, "For the state and differing queries")
        ->capture_default_str();
    app.footer(
        "Exit status: 0 no difference, 1 a difference or bad input, 2 bad usage, 3 stopped "
        "by a signal (go on with --resume).");
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    }

    struct sigaction action {};
    action.sa_handler = ask_to_stop;
    action.sa_flags = static_cast<int>(SA_RESETHAND);  // a second signal ends the program at once
    for (const int signal : {SIGINT, SIGTERM}) sigaction(signal, &action, nullptr);

    options.blocks = soak::blocks_for(queries);
    const soak::state from = begin(seed, seed_option->count() > 0, resume, options.folder);
    std::printf("seed %ju, %s of %s queries done\n", std::uintmax_t{from.seed},
                grouped(soak::query_count(from.found.blocks)).c_str(),
                grouped(soak::query_count(options.blocks)).c_str());
    std::fflush(stdout);

    progress_display display(from, options.blocks);
    const soak::state last = soak::run(from, options, soak::reference(), soak::exact_deciders(),
                                       stop, [&](const soak::state& now) { display(now); });
    display.end();
    report(last, options.folder);
    if (last.found.differing_queries > 0) return 1;
    if (last.found.blocks < options.blocks) {
        std::printf("stopped by signal %d; --resume goes on\n", static_cast<int>(caught_signal));
        return 3;
    }
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "soak: %s\n", error.what());
    return 1;
}
