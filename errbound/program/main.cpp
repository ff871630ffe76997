// The program `errbound`. Exit status: 0 done, 1 bad input or violations found, 2 bad usage.
#include "errbound/program/commands.hpp"
#include "errbound/support/program.hpp"

int main(int argc, char** argv) {
    return errbound::support::run_program("errbound", [&] {
        const errbound::support::program_text text{
            "errbound",
            "Error bounds compared with MPFR, errors of programs explained, bounds over all "
            "inputs, and published test vectors.\n"
            "Exit status: 0 done, 1 bad input or violations found, 2 bad usage.",
            ERRBOUND_VERSION};
        const errbound::support::command_maker commands[] = {
            errbound::validate_command, errbound::explain_command, errbound::ranges_command,
            errbound::conformance_command};
        return errbound::support::run_command(text, argc, argv, commands);
    });
}
