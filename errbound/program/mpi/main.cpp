// The program `errbound_mpi`: `errbound` over the ranks of MPI.
//
//   mpirun -n 4 errbound_mpi validate --expressions 1000000000 --journal kept
//
// Exit status 0 done, 1 bad input or violations found, 2 bad usage, 3 ended by a signal, with a
// journal to go on from. Rank 0 prints.
#include <mpi.h>

#include <CLI/CLI.hpp>
#include <string>

#include "ccd/io/store/store_reader.hpp"
#include "errbound/program/mpi/validate_over_ranks.hpp"
#include "errbound/study/options.hpp"
#include "errbound/study/program.hpp"
#include "errbound/support/command_line.hpp"

namespace errbound::validation {
namespace {

int run_command_line(int argc, char** argv) {
    CLI::App app{
        "Error bounds held against MPFR, over the ranks of MPI.\n"
        "Exit status: 0 done, 1 bad input or violations found, 2 bad usage, 3 ended by a signal, "
        "with a\njournal to go on from.",
        "errbound_mpi"};
    app.require_subcommand(0, 1);
    app.set_version_flag("--version", std::string("errbound_mpi ") + ERRBOUND_VERSION);
    constexpr int of_each_rank = 1;
    validate_options validate(app, of_each_rank);
    const study::journal_option journal(validate.line());
    try {
        app.parse(argc, argv);
        if (!validate.was_given())
            throw support::usage_error("found no command, errbound_mpi --help lists them");
        return validate_over_ranks(MPI_COMM_WORLD, validate.checked(), journal.path());
    } catch (const CLI::ParseError& error) {
        int rank = 0;
        MPI_Comm_rank(MPI_COMM_WORLD, &rank);
        if (error.get_exit_code() != 0) throw support::usage_error(error.what());
        if (rank == 0) app.exit(error);  // prints what --help and --version ask for
        return done;
    }
}

}  // namespace
}  // namespace errbound::validation

int main(int argc, char** argv) {
    ccd::io::leave_stores_at_exit();
    return errbound::study::run_over_ranks("errbound_mpi", argc, argv,
                                           errbound::validation::run_command_line);
}
