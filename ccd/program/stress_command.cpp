// `ccd stress`: compares every method with exact results on stiff and extreme queries.
#include <CLI/CLI.hpp>
#include <ccd/method.hpp>
#include <cstddef>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "ccd/program/command.hpp"
#include "ccd/program/options.hpp"
#include "ccd/stress/output.hpp"
#include "errbound/support/command_line.hpp"

namespace ccd::program {
namespace {

const stress::family* family_named(const std::string& name) {
    return &errbound::support::entry_named("--family", name, stress::families(),
                                           &stress::family::name);
}

class stress_run final : public command {
  public:
    explicit stress_run(CLI::App& program);
    exit_status run() override;

  private:
    stress::plan checked_plan() const;

    stress::plan plan_;
    stress::outputs out_;
    std::string families_;
    bool quick_ = false;
    std::size_t queries_ = 1000;
    methods_option methods_{line_};
};

stress_run::stress_run(CLI::App& program)
    : command(program, "stress",
              "Run every method on stiff and extreme queries. Each family of queries has a knob, "
              "which\n"
              "is swept over its whole range; unbounded integers compute the truth") {
    line_.add_flag("--quick", quick_, "About a minute instead of ten");
    line_
        .add_option("--family", families_,
                    "Families F[,F...]; all by default. A family's queries do not depend on\n"
                    "other families")
        ->type_name("F[,F...]");
    line_
        .add_option(
            "--queries", queries_,
            "Queries for each family, kind and value of the knob; fewer if the truth takes\n"
            "tenths of a second")
        ->check(CLI::Range(1, 1000000));
    line_.add_option("--seed", plan_.seed, "Same seed, same queries")
        ->check(errbound::support::checked_seed)
        ->capture_default_str();
    add_threads_option(line_, plan_.threads,
                       "Threads that compute the truth; 0: one per core. One thread times methods");
    line_
        .add_option("--out", out_.folder,
                    "Write DIR/stress.csv, a row per cell, and DIR/stress.md, the table")
        ->type_name("DIR");
    line_
        .add_option("--json", out_.json,
                    "Write the cells as JSON; a knob of null is exactly zero (CSV: -inf)")
        ->type_name("OUT");
}

exit_status stress_run::run() {
    const stress::plan plan = checked_plan();
    std::vector<std::filesystem::path> others;
    if (out_.folder) others = {*out_.folder / "stress.csv", *out_.folder / "stress.md"};
    errbound::support::require_good_outputs({out_.json}, std::move(others));
    return stress::run_and_write(plan, out_, errbound::support::stream_for_people({out_.json}))
               ? done
               : broken_promise;
}

stress::plan stress_run::checked_plan() const {
    stress::plan plan = plan_;
    for (const ccd::method m : methods_.methods())
        plan.subjects.push_back(stress::subject_of(info(m)));
    if (line_.count("--family") > 0)
        plan.families = errbound::support::all_named("--family", families_, family_named);
    else
        for (const stress::family& entry : stress::families()) plan.families.push_back(&entry);
    plan.queries = quick_ && line_.count("--queries") == 0 ? 100 : queries_;
    plan.seconds = quick_ ? 0.002 : 0.02;
    return plan;
}

}  // namespace

std::unique_ptr<command> stress_command(CLI::App& program) {
    return std::make_unique<stress_run>(program);
}

}  // namespace ccd::program
