// The program `ccd`. Exit status: 0 done; 1 bad input, a missing or failed CUDA device, or a broken
// guarantee (`ccd stress`, `ccd report`, `ccd validate`); 2 bad usage; 3 intersections or
// contacts (`ccd check`, `ccd audit`, `ccd bodies`).
#include "ccd/io/store/store_reader.hpp"
#include "ccd/program/command.hpp"
#include "errbound/support/program.hpp"

namespace ccd::program {
namespace {

int run_command_line(int argc, char** argv) {
    const errbound::support::program_text text{
        "ccd",
        "Exact continuous collision detection.\n"
        "Exit status: 0 done, 1 bad input, 2 bad usage; stress, report and validate also return 1 "
        "if a\nmethod or rule breaks its guarantee; check returns 3 if a mesh intersects itself, "
        "audit "
        "if\nelements intersect or touch, bodies if two bodies touch.",
        ERRBOUND_VERSION};
    const errbound::support::command_maker commands[] = {
        query_command,    step_command,   check_command,  audit_command,
        bodies_command,   stress_command, report_command,
#ifdef ERRBOUND_HAVE_MPFR
        validate_command,
#endif
        convert_command,  methods_command};
    return errbound::support::run_command(text, argc, argv, commands);
}

}  // namespace
}  // namespace ccd::program

int main(int argc, char** argv) {
    ccd::io::leave_stores_at_exit();
    return errbound::support::run_program(
        "ccd", [&] { return ccd::program::run_command_line(argc, argv); });
}
