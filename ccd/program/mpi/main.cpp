// The program `ccd_mpi`: commands of `ccd` over the ranks of MPI.
//
//   mpirun -n 4 ccd_mpi step FRAME0 FRAME1 --pairs pairs.csv
//   mpirun -n 4 ccd_mpi query FILE... --journal kept
//
// Exit status 0 done, 1 bad input or, in stress, a method that broke its promise, 2 bad usage, 3
// ended by a signal, with a journal to go on from. Rank 0 prints.
#include <mpi.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "ccd/io/store/store_reader.hpp"
#include "ccd/program/command.hpp"
#include "ccd/program/mpi/commands.hpp"
#include "errbound/study/program.hpp"
#include "errbound/support/command_line.hpp"

namespace ccd::program {
namespace {

exit_status run_command_line(int argc, char** argv) {
    CLI::App app{
        "Exact continuous collision detection over the ranks of MPI.\n"
        "Exit status: 0 done, 1 bad input, 2 bad usage, 3 ended by a signal, with a journal to go "
        "on\nfrom; of stress also 1: a promise was broken.",
        "ccd_mpi"};
    app.require_subcommand(0, 1);
    app.set_version_flag("--version", std::string("ccd_mpi ") + ERRBOUND_VERSION);
    const std::unique_ptr<command> commands[] = {distributed_step_command(app),
                                                 distributed_query_command(app),
                                                 distributed_stress_command(app)};
    int rank = 0;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    try {
        app.parse(argc, argv);
        for (const auto& c : commands)
            if (c->was_given()) return c->run();
        throw errbound::support::usage_error("found no command, ccd_mpi --help lists them");
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() != 0) throw errbound::support::usage_error(error.what());
        if (rank == 0) app.exit(error);  // prints what --help and --version ask for
        return done;
    }
}

}  // namespace
}  // namespace ccd::program

int main(int argc, char** argv) {
    ccd::io::leave_stores_at_exit();
    return errbound::study::run_over_ranks("ccd_mpi", argc, argv, ccd::program::run_command_line);
}
