// The program `errbound`. Exit status: 0 done, 1 bad input or violations found, 2 bad usage.
#include <CLI/CLI.hpp>
#include <string>

#include "ccd/io/store/store_reader.hpp"
#include "errbound/program/explain_command.hpp"
#include "errbound/program/validate_command.hpp"
#include "errbound/program/validate_options.hpp"
#include "errbound/support/command_line.hpp"
#include "errbound/support/program.hpp"

namespace errbound::validation {
namespace {

int run_command_line(int argc, char** argv) {
    CLI::App app{
        "Error bounds held against MPFR, and errors of programs explained.\n"
        "Exit status: 0 done, 1 bad input or violations found, 2 bad usage.",
        "errbound"};
    app.require_subcommand(0, 1);            // main reports a missing command; CLI11 an unknown one
    app.allow_windows_style_options(false);  // a path may begin with a slash
    app.set_version_flag("--version", std::string("errbound ") + ERRBOUND_VERSION);
    validate_options validate(app);
    explaining::explain_command explain(app);
    try {
        app.parse(argc, argv);
        if (explain.was_given()) return explain.run();
        if (!validate.was_given())
            throw support::usage_error("command is missing; errbound --help lists the commands");
        return run_validate(validate.checked());
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() != 0) throw support::usage_error(error.what());
        app.exit(error);  // prints --help or --version
        return done;
    }
}

}  // namespace
}  // namespace errbound::validation

int main(int argc, char** argv) {
    ccd::io::leave_stores_at_exit();
    return errbound::support::run_program(
        "errbound", [&] { return errbound::validation::run_command_line(argc, argv); });
}
