// The program `ccd_mpi`: `ccd step` over the ranks of MPI.
//
//   mpirun -n 4 ccd_mpi step FRAME0 FRAME1 --pairs pairs.csv
//
// Exit status 0 done, 1 bad input, 2 bad usage. Rank 0 prints.
#include <mpi.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <exception>
#include <iostream>
#include <sstream>
#include <string>
#include <thread>

#include "ccd/program/command.hpp"
#include "ccd/program/mpi/commands.hpp"
#include "errbound/support/command_line.hpp"
#include "errbound/support/program.hpp"

namespace ccd::program {
namespace {

exit_status run_command_line(int argc, char** argv) {
    CLI::App app{
        "Exact continuous collision detection of meshes, over the ranks of MPI.\n"
        "Exit status: 0 done, 1 bad input, 2 bad usage.",
        "ccd_mpi"};
    app.require_subcommand(0, 1);
    app.set_version_flag("--version", std::string("ccd_mpi ") + ERRBOUND_VERSION);
    const auto step = distributed_step_command(app);
    int rank = 0;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    try {
        app.parse(argc, argv);
        if (!step->was_given()) throw CLI::RequiredError("A subcommand");
        return step->run();
    } catch (const CLI::ParseError& error) {
        std::ostringstream silent;
        std::ostream& out = rank == 0 ? std::cout : silent;
        std::ostream& err = rank == 0 ? std::cerr : silent;
        return app.exit(error, out, err) == 0 ? done : bad_usage;
    }
}

/// Waits until all ranks are here: what one throws is thrown on all. A rank that throws alone (no
/// memory, a fault of the program) would leave the others waiting for it for ever: then false.
bool all_meet(MPI_Comm all, bool failed) {
    MPI_Request request{};
    MPI_Ibarrier(all, &request);
    using clock = std::chrono::steady_clock;
    const auto limit = clock::now() + std::chrono::seconds(5);
    for (int met = 0;;) {
        MPI_Test(&request, &met, MPI_STATUS_IGNORE);
        if (met) return true;
        if (failed && clock::now() > limit) return false;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
}

/// What is thrown on all ranks is told by the first alone.
int run(int argc, char** argv, MPI_Comm all, bool& met) {
    std::exception_ptr failure;
    int status = done;
    try {
        status = run_command_line(argc, argv);
    } catch (const errbound::support::usage_error&) {
        failure = std::current_exception();
        status = bad_usage;
    } catch (...) {
        failure = std::current_exception();
        status = bad_input;
    }
    met = all_meet(all, failure != nullptr);
    int rank = 0, size = 1;
    MPI_Comm_rank(all, &rank);
    MPI_Comm_size(all, &size);
    int first = rank;
    if (met) {
        const int own = failure ? rank : size;
        MPI_Allreduce(&own, &first, 1, MPI_INT, MPI_MIN, all);
    }
    if (failure && rank == first) std::rethrow_exception(failure);
    return status;
}

}  // namespace
}  // namespace ccd::program

int main(int argc, char** argv) {
    int provided = 0;
    MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &provided);
    MPI_Comm all;
    MPI_Comm_dup(MPI_COMM_WORLD, &all);
    bool met = true;
    const int status = errbound::support::run_program(
        "ccd_mpi", [&] { return ccd::program::run(argc, argv, all, met); });
    if (!met) MPI_Abort(MPI_COMM_WORLD, status);
    MPI_Comm_free(&all);
    MPI_Finalize();
    return status;
}
