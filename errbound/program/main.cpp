// The program `errbound`. Exit status: 0 done, 1 bad input or violations found, 2 bad usage.
#include <memory>
#include <string>

#include "errbound/program/commands.hpp"
#include "errbound/support/program.hpp"

int main(int argc, char** argv) {
    return errbound::support::run_program("errbound", [&] {
        CLI::App app{
            "Error bounds compared with MPFR, errors of programs explained, bounds over all "
            "inputs, and published test vectors.\n"
            "Exit status: 0 done, 1 bad input or violations found, 2 bad usage.",
            "errbound"};
        app.set_version_flag("--version", std::string("errbound ") + ERRBOUND_VERSION);
        const std::unique_ptr<errbound::support::command> commands[] = {
            errbound::validate_command(app), errbound::explain_command(app),
            errbound::ranges_command(app), errbound::conformance_command(app)};
        return errbound::support::run_command(app, argc, argv, commands);
    });
}
