#include <algorithm>
#include <filesystem>
#include <iostream>

#include "ccd/lab/machine.hpp"
#include "ccd/lab/report.hpp"
#include "ccd/lab/stress.hpp"
#include "ccd/program/command.hpp"
#include "ccd/program/options.hpp"
#include "errbound/support/progress_line.hpp"

namespace ccd::program {
namespace {

namespace fs = std::filesystem;

class stress_run final : public command {
  public:
    explicit stress_run(CLI::App& program)
        : command(program, "stress",
                  "Every method on stiff and extreme queries, family by family, each with a knob "
                  "that is\n"
                  "swept over its whole range; truth by unbounded integers") {
        add_flag(line_, "--quick", quick_, "About a minute instead of ten");
        add(line_, "--family", families_,
            "Families F[,F...], else all. A family's queries do not depend on\nthe others")
            .type("F[,F...]");
        add(line_, "--queries", plan_.queries,
            "Queries of each family, kind and value of the knob; fewer where the truth\n"
            "takes tenths of a second. 1000, or 100 with --quick")
            .between(1, 1000000);
        add(line_, "--seed", plan_.seed, "Same seed, same queries")
            .check(errbound::support::checked_seed)
            .shows_default();
        add_threads_option(
            line_, plan_.threads,
            "Threads that find the truth; 0: one per core. Methods are timed on one");
        add(line_, "--out", out_.folder, "Write DIR/stress.csv, a row per cell").type("DIR");
        add_output(line_, "--json", out_.json,
                   "Write the cells as JSON; a knob of null is exactly zero (CSV: -inf)");
    }

    exit_status run() override {
        for (const ccd::method m : methods_.methods())
            plan_.subjects.push_back(lab::subject_named(info(m).name));
        if (was_given("--family"))
            plan_.families =
                errbound::support::all_named("--family", families_, [](const std::string& name) {
                    return &errbound::support::entry_named("--family", name, lab::families(),
                                                           &lab::family::name);
                });
        else
            for (const lab::family& entry : lab::families()) plan_.families.push_back(&entry);
        if (!was_given("--queries")) plan_.queries = quick_ ? 100 : 1000;
        plan_.seconds = quick_ ? 0.002 : 0.02;

        std::vector<fs::path> others;
        if (out_.folder) others = {*out_.folder / "stress.csv"};
        errbound::support::require_good_outputs({out_.json}, std::move(others));
        std::ostream& text = errbound::support::stream_for_people({out_.json});
        return lab::run_and_write(plan_, out_, text) ? done : broken_promise;
    }

  private:
    lab::plan plan_;
    lab::stress_outputs out_;
    std::string families_;
    bool quick_ = false;
    methods_option methods_{line_};
};

class report_run final : public command {
  public:
    explicit report_run(CLI::App& program)
        : command(program, "report",
                  "Error against run time: tables and pictures of all methods and bound rules.\n"
                  "A stopped report continues") {
        settings_.out = "out/report";
        settings_.commit = lab::configured_commit();
        add(line_, "DATA", settings_.data,
            "Folders with stored queries (CSV; kind from the path) and scenes (folders of two\n"
            "meshes), searched recursively; else the bundled scene and generated queries");
        add(line_, "--out", settings_.out, "The report's folder, else out/report").type("DIR");
        add_flag(line_, "--quick", settings_.quick, "Fewer queries are timed");
        add(line_, "--sections", sections_,
            "Only these: methods, times, contacts, bounds, tightness (needs a build\n"
            "with MPFR), stress")
            .type("S[,S...]");
        add_threads_option(line_, settings_.threads,
                           "Threads that count errors; 0: one per core (times are taken on one)");
        add(line_, "--commit", settings_.commit,
            "Named in the report, else that of the configured build")
            .type("TEXT");
    }

    exit_status run() override {
        if (was_given("--sections"))
            settings_.sections =
                errbound::support::all_named("--sections", sections_, [](const std::string& name) {
                    return errbound::support::entry_named("--sections", name, lab::sections(),
                                                          &lab::section::name)
                        .name;
                });
        if (settings_.data.empty()) {
            settings_.data.push_back(bundled_scenes());
            settings_.made = true;
        }
        for (const ccd::method method : methods_.methods()) {
            if (std::ranges::find(settings_.methods, info(method).name) != settings_.methods.end())
                continue;
            settings_.methods.emplace_back(info(method).name);
            if (method == method::exact) settings_.methods.emplace_back(lab::batch_name);
        }

        errbound::support::progress_line progress;
        const lab::report_summary result = lab::make_report(
            settings_, [&](double share, const std::string& what) { progress.show(share, what); },
            [&](const std::string& line) {
                progress.clear();
                std::cout << line << std::endl;
            });
        progress.clear();

        const auto all = lab::totals(result.tables.at("methods"), [](const auto&) { return true; });
        std::cout << errbound::support::text_of(
                         errbound::support::cells_of(
                             all, {"method", "queries", "FP", "FN", "uncertain", "ns/query"},
                             {"method", "queries", "false_positives", "false_negatives",
                              "uncertain", "ns"}),
                         1)
                  << "report: " << (settings_.out / "report.md").string() << '\n';
        for (const std::string& failure : result.failures)
            std::cout << "FAILED: " << failure << '\n';
        return result.failures.empty() ? done : broken_promise;
    }

  private:
    lab::report_options settings_;
    std::string sections_;
    methods_option methods_{line_};
};

class methods_run final : public command {
  public:
    explicit methods_run(CLI::App& program)
        : command(program, "methods", "List all methods with their guarantees") {}

    exit_status run() override {
        errbound::support::table rows = {{"method", "promise", "source"}};
        for (const method_info& entry : ccd::methods())
            rows.push_back(
                {std::string(entry.name), std::string(entry.promise), std::string(entry.source)});
        std::cout << errbound::support::text_of(rows, 3);
        return done;
    }
};

}  // namespace

const command_maker stress_command = make_command<stress_run>;
const command_maker report_command = make_command<report_run>;
const command_maker methods_command = make_command<methods_run>;

}  // namespace ccd::program
