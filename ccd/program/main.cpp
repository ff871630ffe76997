// The program `ccd`. Exit status: 0 done; 1 bad input, a missing or failed CUDA device, or a broken
// guarantee of a method (`ccd stress`, `ccd report`); 2 bad usage.
#include <CLI/CLI.hpp>
#include <string>

#include "ccd/io/store/store_reader.hpp"
#include "ccd/program/command.hpp"
#include "errbound/support/command_line.hpp"
#include "errbound/support/program.hpp"

namespace ccd::program {
namespace {

exit_status run(CLI::App& app, int argc, char** argv) {
    const std::unique_ptr<command> commands[] = {query_command(app),   step_command(app),
                                                 stress_command(app),  report_command(app),
                                                 convert_command(app), methods_command(app)};
    app.parse(argc, argv);
    for (const auto& c : commands)
        if (c->was_given()) return c->run();
    throw errbound::support::usage_error("command is missing; ccd --help lists the commands");
}

int run_command_line(int argc, char** argv) {
    CLI::App app{
        "Exact continuous collision detection.\n"
        "Exit status: 0 done, 1 bad input, 2 bad usage; stress and report also return 1 if a "
        "method breaks its guarantee.",
        "ccd"};
    app.require_subcommand(0, 1);            // CLI11 then reports an unknown command by name
    app.allow_windows_style_options(false);  // a path may begin with a slash
    app.set_version_flag("--version", std::string("ccd ") + ERRBOUND_VERSION);
    try {
        return run(app, argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() != 0) throw errbound::support::usage_error(error.what());
        app.exit(error);
        return done;
    }
}

}  // namespace
}  // namespace ccd::program

int main(int argc, char** argv) {
    ccd::io::leave_stores_at_exit();
    return errbound::support::run_program(
        "ccd", [&] { return ccd::program::run_command_line(argc, argv); });
}
