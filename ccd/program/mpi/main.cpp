// The program `ccd_mpi`: steps of meshes over the ranks of MPI.
//
//   mpirun -n 4 ccd_mpi step FRAME0 FRAME1 --pairs pairs.csv
//
// Exit status 0 done, 1 bad input, 2 bad usage. Rank 0 prints.
#include <mpi.h>

#include <chrono>
#include <exception>
#include <thread>

#include "ccd/program/command.hpp"
#include "errbound/support/program.hpp"

namespace ccd::program {
namespace {

using errbound::support::usage_error;

int run_command_line(int argc, char** argv, int rank) {
    const errbound::support::program_text text{
        "ccd_mpi",
        "Exact continuous collision detection over the ranks of MPI.\n"
        "Exit status: 0 done, 1 bad input, 2 bad usage.",
        ERRBOUND_VERSION};
    const errbound::support::command_maker commands[] = {distributed_step_command};
    return errbound::support::run_command(text, argc, argv, commands, rank == 0);
}

/// Waits for all ranks and returns true. Most errors are thrown on all ranks. If a rank fails alone
/// (no memory, another command line), the others may wait elsewhere without end. The failed rank
/// then returns false after some seconds.
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

/// The lowest failing rank rethrows its error; the others return its status.
int run_on_rank(MPI_Comm all, int argc, char** argv, bool& met) {
    int rank = 0, size = 1;
    MPI_Comm_rank(all, &rank);
    MPI_Comm_size(all, &size);
    std::exception_ptr failure;
    int status = 0;
    try {
        status = run_command_line(argc, argv, rank);
    } catch (const usage_error&) {
        failure = std::current_exception();
        status = 2;
    } catch (...) {
        failure = std::current_exception();
        status = 1;
    }
    met = all_meet(all, status != 0);
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
        "ccd_mpi", [&] { return ccd::program::run_on_rank(all, argc, argv, met); });
    if (!met) MPI_Abort(MPI_COMM_WORLD, status);
    MPI_Comm_free(&all);
    MPI_Finalize();
    return status;
}
