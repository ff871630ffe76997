// `ccd stress`: every method on stiff and extreme queries, beside the exact answer.
#include <ccd/method.hpp>
#include <iostream>

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
    explicit stress_run(CLI::App& program)
        : command(program, "stress",
                  "Every method on stiff and extreme queries, family by family, each with a knob "
                  "that is\n"
                  "swept over its whole range; truth by unbounded integers") {
        line_.add_flag("--quick", quick_, "About a minute instead of ten");
        line_.add_option("--family", families_, "Families F[,F...], else all")
            ->type_name("F[,F...]");
        line_
            .add_option(
                "--queries", queries_,
                "So many of each family, kind and value of the knob; fewer where the truth\n"
                "takes tenths of a second")
            ->check(CLI::Range(1, 1000000));
        line_.add_option("--seed", plan_.seed, "Same seed, same queries")->capture_default_str();
        add_threads_option(
            line_, plan_.threads,
            "Threads that find the truth; 0: one per core. Methods are timed on one");
        line_
            .add_option("--out", out_.folder,
                        "Write DIR/stress.csv, a row per cell, and DIR/stress.md, the table")
            ->type_name("DIR");
        line_
            .add_option("--json", out_.json,
                        "Write the cells as JSON; a knob of null is exactly zero (CSV: -inf)")
            ->type_name("OUT");
    }

    exit_status run() override {
        for (const ccd::method m : methods_.methods())
            plan_.subjects.push_back(stress::subject_of(info(m)));
        if (line_.count("--family") > 0)
            plan_.families = errbound::support::all_named(families_, family_named);
        else
            for (const stress::family& entry : stress::families()) plan_.families.push_back(&entry);
        plan_.queries = quick_ && line_.count("--queries") == 0 ? 100 : queries_;
        plan_.seconds = quick_ ? 0.002 : 0.02;
        if (out_.json && out_.folder)
            errbound::support::require_good_outputs(
                {out_.json}, {*out_.folder / "stress.csv", *out_.folder / "stress.md"});
        return stress::run_and_write(plan_, out_, errbound::support::stream_for_people({out_.json}))
                   ? done
                   : broken_promise;
    }

  private:
    stress::plan plan_;
    stress::outputs out_;
    std::string families_;
    bool quick_ = false;
    std::size_t queries_ = 1000;
    methods_option methods_{line_};
};

}  // namespace

std::unique_ptr<command> stress_command(CLI::App& program) {
    return std::make_unique<stress_run>(program);
}

}  // namespace ccd::program
