// MPI begun and ended, and what is thrown between.
#include "errbound/study/program.hpp"

#include <mpi.h>

#include <chrono>
#include <exception>
#include <thread>

#include "errbound/support/command_line.hpp"
#include "errbound/support/program.hpp"

namespace errbound::study {
namespace {

/// Waits until all ranks are here: what one throws is thrown on all. A rank that fails alone (no
/// memory, another command line) would leave the others waiting for it for ever: then false.
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
int run(const std::function<int()>& body, MPI_Comm all, bool& met) {
    std::exception_ptr failure;
    int status = 0;
    try {
        status = body();
    } catch (const support::usage_error&) {
        failure = std::current_exception();
        status = 2;
    } catch (...) {
        failure = std::current_exception();
        status = 1;
    }
    met = all_meet(all, status != 0);
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

int run_over_ranks(const std::string& name, int argc, char** argv,
                   const std::function<int(int, char**)>& body) {
    int provided = 0;
    MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &provided);
    MPI_Comm all;
    MPI_Comm_dup(MPI_COMM_WORLD, &all);
    bool met = true;
    const int status =
        support::run_program(name, [&] { return run([&] { return body(argc, argv); }, all, met); });
    if (!met) MPI_Abort(MPI_COMM_WORLD, status);
    MPI_Comm_free(&all);
    MPI_Finalize();
    return status;
}

}  // namespace errbound::study
