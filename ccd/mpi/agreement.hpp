#pragma once

#include <mpi.h>

#include <ccd/execution.hpp>
#include <exception>
#include <new>
#include <stdexcept>
#include <string>

namespace ccd::mpi::detail {

/// If ranks fail for different reasons, the first of this list takes precedence.
enum class failure : int { refused, stopped, out_of_memory, other, none };

inline failure failure_of(const std::exception& error) {
    if (dynamic_cast<const std::invalid_argument*>(&error)) return failure::refused;
    if (dynamic_cast<const ccd::stopped*>(&error)) return failure::stopped;
    if (dynamic_cast<const std::bad_alloc*>(&error)) return failure::out_of_memory;
    return failure::other;
}

[[noreturn]] inline void fail(failure why, const std::string& message) {
    if (why == failure::refused) throw std::invalid_argument(message);
    if (why == failure::stopped) throw ccd::stopped();
    if (why == failure::out_of_memory) throw std::bad_alloc();
    throw std::runtime_error(message);
}

/// Calls check(). If it throws on some ranks, all ranks throw the exception that takes precedence,
/// with its message: std::invalid_argument, ccd::stopped, std::bad_alloc, or else
/// std::runtime_error.
template <class Check>
void agree(MPI_Comm comm, const Check& check) {
    int rank = 0;
    MPI_Comm_rank(comm, &rank);
    std::string message;
    struct {
        int why, rank;
    } own{static_cast<int>(failure::none), rank}, first{};
    try {
        check();
    } catch (const std::exception& error) {
        own.why = static_cast<int>(failure_of(error));
        message = "rank " + std::to_string(rank) + ": " + error.what();
    }
    MPI_Allreduce(&own, &first, 1, MPI_2INT, MPI_MINLOC, comm);
    const auto why = static_cast<failure>(first.why);
    if (why == failure::none) return;
    int length = static_cast<int>(message.size());
    MPI_Bcast(&length, 1, MPI_INT, first.rank, comm);
    message.resize(static_cast<std::size_t>(length));
    MPI_Bcast(message.data(), length, MPI_CHAR, first.rank, comm);
    fail(why, message);
}

}  // namespace ccd::mpi::detail
