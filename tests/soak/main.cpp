// ./run soak: `exact`, one by one and in batches, on millions of queries: against the reference, or
// against itself on images of them; steps and advances of meshes against every pair; roots against
// FLINT; predicates against oracles.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <string>

#include "errbound/support/command.hpp"
#include "errbound/support/program.hpp"
#include "errbound/support/progress_line.hpp"
#include "errbound/support/rows.hpp"
#include "errbound/support/signals.hpp"
#include "tests/soak/parts.hpp"
#ifdef ERRBOUND_HAS_ORACLE
#include "tests/soak/first_times.hpp"
#endif

namespace soak {
namespace {

namespace fs = std::filesystem;
using errbound::support::grouped;

std::string duration(double seconds) {
    const auto minutes = static_cast<std::uint64_t>(seconds / 60);
    if (minutes >= 60)
        return std::to_string(minutes / 60) + " h " + std::to_string(minutes % 60) + " min";
    if (minutes >= 2) return std::to_string(minutes) + " min";
    return std::to_string(static_cast<std::uint64_t>(seconds)) + " s";
}

/// A progress bar on a terminal; otherwise a line every half minute.
class progress_display {
  public:
    progress_display(const part& of, const run_options& options) : of_(of), options_(options) {}

    /// The number of questions in the first `blocks` blocks of the run.
    std::uint64_t questions(std::uint64_t blocks) const {
        return of_.count(options_.first + blocks) - of_.count(options_.first);
    }
    double seconds() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    }
    void operator()(const findings& now) {
        const bool is_terminal = errbound::support::system::is_terminal(2);
        const double here = seconds();
        if (here < shown_ + (is_terminal ? 0.5 : 30)) return;
        shown_ = here;
        const std::uint64_t done = questions(now.blocks),
                            all = questions(options_.end - options_.first);
        const double rate = static_cast<double>(done) / here;
        const double share = static_cast<double>(done) / static_cast<double>(all);
        const std::string text =
            grouped(done) + " of " + grouped(all) + " " + of_.unit + ", " +
            grouped(static_cast<std::uint64_t>(rate)) + " a second, " + grouped(now.different) +
            " differ, " + (rate > 0 ? duration(static_cast<double>(all - done) / rate) : "?") +
            " left";
        if (is_terminal) return bar_.show(share, text);
        std::printf("%5.1f %%  %s\n", 100 * share, text.c_str());
        std::fflush(stdout);
    }

  private:
    const part& of_;
    const run_options& options_;
    const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    errbound::support::progress_line bar_;
    double shown_ = 0;
};

/// The table with each row's share of the first column, and the sum of all rows.
std::string text_of(const count_table& counts) {
    errbound::support::rows all;
    std::vector<std::uint64_t> sums(counts.columns.size());
    for (const auto& row : counts.rows)
        std::ranges::transform(row.counts, sums, sums.begin(), std::plus());
    const auto add = [&](const std::string& name, const std::vector<std::uint64_t>& row) {
        auto& r = all.emplace_back(errbound::support::row{{counts.title + ":", name}});
        for (std::size_t k = 0; k < row.size(); ++k) r[counts.columns[k]] = row[k];
        if (!counts.largest)
            r["share_%"] = 100 * static_cast<double>(row[0]) /
                           static_cast<double>(std::max<std::uint64_t>(sums[0], 1));
    };
    for (const auto& row : counts.rows) add(row.name, row.counts);
    if (!counts.largest) add("all", sums);
    return errbound::support::text_of(all);
}

void report(const findings& found, const fs::path& folder) {
    for (const count_table& table : found.tables) std::printf("\n%s", text_of(table).c_str());
    for (std::size_t i = 0; i < found.differences.size() && i < 10; ++i)
        std::printf("\n%s", found.differences[i].text.c_str());
    for (const auto which : ccd::stored_kinds) {
        const fs::path path = folder / ("differences-" + std::string(short_name(which)) + ".csv");
        if (fs::exists(path))
            std::printf("differing queries, the reference's answer as truth: ccd query %s\n",
                        path.string().c_str());
    }
    if (found.different > found.differences.size())
        std::printf("only the first %s of them are kept\n",
                    grouped(found.differences.size()).c_str());
    if (found.different > 0)
        std::printf("all that differ: %s\n", (folder / "differences.txt").string().c_str());
}

struct command_line {
    std::uint64_t count = 20'000'000, first = 0;
    std::function<soak::part()> part;
    std::string predicate;
    run_options options;
};

void add_parts(CLI::App& app, command_line& given) {
    const CLI::Range counts(std::uint64_t{1}, std::uint64_t{1} << 40);
    CLI::Option* const queries =
        app.add_option("--queries", given.count, "At least that many, in whole blocks")
            ->capture_default_str()
            ->check(counts);
    CLI::Option_group& parts = *app.add_option_group("Instead");
    parts.require_option(0, 1);
    const auto of_queries = [&](const char* name, const char* what, auto part) {
        return parts.add_flag_callback(
            name, [&given, part] { given.part = part; }, what);
    };
    const auto counted = [&](const char* name, const char* what, auto part) {
        const auto choose = [&given, part](std::uint64_t count) {
            given.count = count;
            given.part = part;
        };
        parts.add_option_function<std::uint64_t>(name, choose, what)
            ->type_name("N")
            ->check(counts)
            ->excludes(queries);
    };
    of_queries("--symmetries",
               "Without a reference: images of a query, by all ways to decide, have one answer",
               [] { return symmetry_part(symmetric_deciders()); });
    counted("--meshes", "Steps of N small meshes, by the reference on every pair",
            [] { return mesh_part(); });
#ifdef ERRBOUND_HAS_ORACLE
    of_queries("--times", "First times of contact, against an oracle",
               [] { return contact_time_part(contact_deciders()); });
    of_queries("--separation", "First times within distances, against an oracle",
               [] { return distance_time_part(distance_deciders()); });
    counted("--advances", "Advances of N small meshes, by the oracle on every pair",
            [] { return advance_part(); });
#endif
#ifdef ERRBOUND_HAS_FLINT
    counted("--polynomials", "Roots of N polynomials, against FLINT's counts", polynomial_part);
#endif
#ifdef ERRBOUND_HAS_PREDICATES
    CLI::Option* const predicates =
        of_queries("--predicates",
                   "Signs of predicates against oracles, and bounds of their filters; --queries\n"
                   "inputs of each predicate and number type",
                   [&given] { return predicate_part(given.predicate); });
    app.add_option("--predicate", given.predicate, "Only predicates whose name holds this")
        ->needs(predicates);
#endif
}

void add_options(CLI::App& app, command_line& given) {
    add_parts(app, given);
    app.add_option("--seed", given.options.seed, "Same seed, same questions")
        ->capture_default_str()
        ->check(errbound::support::checked_seed);
    app.add_option(
           "--first", given.first,
           "Skip the first N questions of the seed's sequence. Runs with --first 0, M, 2M, ...\n"
           "and M questions each partition one long run")
        ->check(CLI::Range(std::uint64_t{0}, std::uint64_t{1} << 40));
    app.add_option("--threads", given.options.threads, "0: one per core")
        ->capture_default_str()
        ->check(CLI::Range(0, 4096));
    app.add_option("--folder", given.options.folder, "For what differs; by default out/soak/PART");
    app.footer(
        "Exit status: 0 no difference, 1 a difference or bad input, 2 bad usage, 3 stopped "
        "by a signal (the last line has the options that continue).");
}

/// Runs the part to its end or until a signal; returns the exit status. Throws std::runtime_error.
int run_part(command_line& given) {
    const part of = given.part();
    run_options& options = given.options;
    if (options.folder.empty()) options.folder = fs::path("out/soak") / of.name;
    options.first = of.blocks_for(given.first);
    options.end = of.blocks_for(given.first + given.count);
    if (options.first == options.end)
        throw errbound::support::usage_error("--first " + std::to_string(given.first) + " and " +
                                             std::to_string(given.count) + " " + of.unit +
                                             " hold no block; expected more " + of.unit);
    const errbound::support::awaited_signals signals("soak: stopping\n");
    progress_display display(of, options);
    std::printf("%s, seed %ju: %s %s\n", of.name.c_str(), std::uintmax_t{options.seed},
                grouped(display.questions(options.end - options.first)).c_str(), of.unit.c_str());
    std::fflush(stdout);
    const findings found = run(options, of, signals.arrived(), std::ref(display));
    report(found, options.folder);
    std::printf("\nseed %ju: %s %s in %s, %s differ, checksum %016jx\n",
                std::uintmax_t{options.seed}, grouped(display.questions(found.blocks)).c_str(),
                of.unit.c_str(), duration(display.seconds()).c_str(),
                grouped(found.different).c_str(), std::uintmax_t{found.checksum});
    const std::uint64_t next = options.first + found.blocks;
    if (next < options.end)
        std::printf("stopped by signal %d; what is left: --first %ju, and %ju %s\n",
                    signals.arrived().load(), std::uintmax_t{of.count(next)},
                    std::uintmax_t{of.count(options.end) - of.count(next)}, of.unit.c_str());
    return found.different > 0 ? 1 : next < options.end ? 3 : 0;
}

}  // namespace
}  // namespace soak

int main(int argc, char** argv) {
    CLI::App app{"Compares exact with a reference, or with itself.", "./run soak"};
    soak::command_line given;
    given.part = [] {
        auto deciders = soak::exact_deciders();
        deciders.push_back(soak::unfiltered_integers());
        return soak::comparison_part(soak::reference(), std::move(deciders));
    };
    soak::add_options(app, given);
    return errbound::support::run_program("soak", [&] {
        return errbound::support::parse_and_run(app, argc, argv,
                                                [&] { return soak::run_part(given); });
    });
}
