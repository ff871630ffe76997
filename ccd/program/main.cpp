// The program `ccd`: reads the command line. Exit status 0 done, 1 bad input (or a method that
// broke its promise, in `ccd stress` and `ccd report`, or a CUDA device that is missing or failed),
// 2 bad usage.
#include <CLI/CLI.hpp>
#include <errbound/support/error.hpp>
#include <exception>
#include <iostream>
#include <string>

#include "ccd/program/command.hpp"
#include "ccd/program/device_run.hpp"
#include "errbound/support/command_line.hpp"

namespace ccd::program {
namespace {

exit_status run(CLI::App& app, int argc, char** argv) {
    const std::unique_ptr<command> commands[] = {query_command(app), step_command(app),
                                                 stress_command(app), report_command(app),
                                                 methods_command(app)};
    app.parse(argc, argv);
    for (const auto& c : commands)
        if (c->was_given()) return c->run();
    return done;
}

exit_status main_with_status(int argc, char** argv) {
    CLI::App app{
        "Exact continuous collision detection.\n"
        "Exit status: 0 done, 1 bad input, 2 bad usage; of stress and report also 1: a promise was "
        "broken.",
        "ccd"};
    app.require_subcommand(1);
    app.set_version_flag("--version", std::string("ccd ") + ERRBOUND_VERSION);
    const auto failed = [](exit_status status, const char* what) {
        std::cerr << "ccd: " << what << '\n';
        return status;
    };
    exit_status status = done;
    try {
        status = run(app, argc, argv);
    } catch (const CLI::ParseError& error) {
        if (app.exit(error) != 0) return bad_usage;
    } catch (const errbound::support::usage_error& error) {
        return failed(bad_usage, error.what());
    } catch (const errbound::support::file_error& error) {
        return failed(bad_input, error.what());
    } catch (const device_error& error) {
        return failed(bad_input, error.what());
    } catch (const std::bad_alloc&) {
        return failed(bad_input, "out of memory");
    }
    return std::cout.flush() ? status : failed(bad_input, "standard output cannot be written");
}

}  // namespace
}  // namespace ccd::program

int main(int argc, char** argv) {
    return ccd::program::main_with_status(argc, argv);
}
