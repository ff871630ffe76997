// What one rank finds wrong, thrown on all.
#pragma once

#include <mpi.h>

#include <exception>
#include <stdexcept>
#include <string>

namespace ccd::mpi::detail {

/// Calls check() on every rank. If it throws on some, throws std::invalid_argument on all, with the
/// message of the first of these ranks.
template <class Check>
void agree(MPI_Comm comm, const Check& check) {
    int rank = 0, size = 1;
    MPI_Comm_rank(comm, &rank);
    MPI_Comm_size(comm, &size);
    std::string message;
    int failed = size;
    try {
        check();
    } catch (const std::exception& error) {
        failed = rank;
        message = "rank " + std::to_string(rank) + ": " + error.what();
    }
    int first = size;
    MPI_Allreduce(&failed, &first, 1, MPI_INT, MPI_MIN, comm);
    if (first == size) return;
    int length = static_cast<int>(message.size());
    MPI_Bcast(&length, 1, MPI_INT, first, comm);
    message.resize(static_cast<std::size_t>(length));
    MPI_Bcast(message.data(), length, MPI_CHAR, first, comm);
    throw std::invalid_argument(message);
}

}  // namespace ccd::mpi::detail
