// The program `errbound`: reads the command line. Exit status 0 done, 1 bad input or violations
// found, 2 bad usage.
#include <CLI/CLI.hpp>
#include <string>

#include "ccd/io/store/store_reader.hpp"
#include "errbound/program/validate_command.hpp"
#include "errbound/support/command_line.hpp"
#include "errbound/support/program.hpp"

namespace errbound::validation {
namespace {

using errbound::support::all_named;
using errbound::support::entry_named;
using errbound::support::require_good_outputs;

enum exit_status { done = 0, bad_input = 1, violations_found = 1, bad_usage = 2 };

rule rule_named(const std::string& name) {
    return entry_named("--rules", name, rules(), &rule::name);
}

struct command_line {
    CLI::App app{
        "Error bounds held against MPFR.\n"
        "Exit status: 0 done, 1 bad input or violations found, 2 bad usage.",
        "errbound"};
    validate_arguments arguments;
    std::string rule_list, kind;
    CLI::App* validate = nullptr;

    command_line() {
        app.require_subcommand(0, 1);  // none is told from an unknown one, which is named
        app.set_version_flag("--version", std::string("errbound ") + ERRBOUND_VERSION);

        validate = app.add_subcommand(
            "validate",
            "Hold every bound rule's bounds and certain signs against MPFR, and report how tight "
            "they\nare. Random expressions, unless --tiny or --queries asks for those.");
        validate
            ->add_option("--expressions", arguments.options.expressions,
                         "Random expressions, at least so many per rule and number type")
            ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1} << 40))
            ->capture_default_str();
        validate->add_option("--seed", arguments.options.seed, "Same seed, same expressions")
            ->capture_default_str();
        validate
            ->add_option("--operations", arguments.options.operations,
                         "Operations in an expression, at most")
            ->check(CLI::Range(1, max_operations))
            ->capture_default_str();
        validate
            ->add_option("--queries", arguments.queries,
                         "Stored queries (ccd query --help says their form): their forms and BSC")
            ->type_name("FILE...")
            ->transform(errbound::support::input_named);
        validate->add_option("--kind", kind, "Kind of queries; else the path says")
            ->check(CLI::IsMember(ccd::io::kind_names()));
        validate->add_flag("--round", arguments.round,
                           "Round rationals that no double equals, instead of refusing them");
        validate->add_flag("--tiny", arguments.tiny, "Every case of number formats of 6 to 8 bits");
        validate->add_option("--rules", rule_list, "Rules R[,R...], else all")
            ->type_name("R[,R...]");
        validate->add_option("--threads", arguments.options.threads, "Threads; 0: one per core")
            ->check(CLI::Range(0, 4096));
        validate->add_option("--json", arguments.json, "Write all tables as JSON")
            ->type_name("OUT");
        validate->add_option("--csv", arguments.csv, "Write the table of tightness as CSV")
            ->type_name("OUT");
    }

    exit_status run() {
        if (validate->count("--rules") == 0)
            arguments.rules.assign(rules().begin(), rules().end());
        else
            arguments.rules = all_named(rule_list, rule_named);
        arguments.kind = ccd::find_kind(kind);
        arguments.expressions =
            validate->count("--expressions") > 0 || (!arguments.tiny && arguments.queries.empty());
        require_good_outputs({arguments.json, arguments.csv}, arguments.queries);
        return run_validate(arguments) ? done : violations_found;
    }
};

int run_command_line(int argc, char** argv) {
    command_line line;
    try {
        line.app.parse(argc, argv);
        if (!*line.validate) throw CLI::RequiredError("A subcommand");
        return line.run();
    } catch (const CLI::ParseError& error) {
        return line.app.exit(error) == 0 ? done : bad_usage;
    }
}

}  // namespace
}  // namespace errbound::validation

int main(int argc, char** argv) {
    ccd::io::leave_stores_at_exit();
    return errbound::support::run_program(
        "errbound", [&] { return errbound::validation::run_command_line(argc, argv); });
}
