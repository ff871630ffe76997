// The program `errbound_mpi`: `errbound` over the ranks of MPI.
//
//   mpirun -n 4 errbound_mpi validate --expressions 1000000000 --journal kept
//
// Exit status 0 done, 1 bad input or violations found, 2 bad usage, 3 ended by a signal, with a
// journal to go on from. Rank 0 prints.
#include <mpi.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <sstream>
#include <string>

#include "ccd/io/store/store_reader.hpp"
#include "errbound/program/mpi/validate_over_ranks.hpp"
#include "errbound/study/options.hpp"
#include "errbound/study/program.hpp"

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
        if (!validate.was_given()) throw CLI::RequiredError("A subcommand");
        return validate_over_ranks(MPI_COMM_WORLD, validate.checked(), journal.path());
    } catch (const CLI::ParseError& error) {
        int rank = 0;
        MPI_Comm_rank(MPI_COMM_WORLD, &rank);
        std::ostringstream silent;
        std::ostream& out = rank == 0 ? std::cout : silent;
        std::ostream& err = rank == 0 ? std::cerr : silent;
        return app.exit(error, out, err) == 0 ? done : bad_usage;
    }
}

}  // namespace
}  // namespace errbound::validation

int main(int argc, char** argv) {
    ccd::io::leave_stores_at_exit();
    return errbound::study::run_over_ranks("errbound_mpi", argc, argv,
                                           errbound::validation::run_command_line);
}
