// Chunks of work, computed by the ranks of MPI in rounds of some seconds.
#pragma once

#include <mpi.h>

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "errbound/study/journal.hpp"

namespace errbound::study {

/// What each rank can compute.
struct work {
    /// A chunk's result, the same on every rank. Called from several threads at once if there are
    /// several.
    std::function<std::string(std::uint64_t chunk)> result_of;
    int threads = 1;  ///< of each rank; 0: one per core
};

enum class ending { done, stopped };

/// Takes a round's results, on rank 0, in the order of their chunks.
using keeper = std::function<void(std::vector<chunk_result>)>;

/// Computes the chunks that are named on rank 0, those listed first before others. A rank does no
/// more chunks of a round once that has taken two seconds, or `stop` is not 0; stopped on one rank,
/// the work ends after the round on all. Collective; the ending is the same on all ranks. Throws
/// std::runtime_error on all ranks, with the message of the least chunk of the round that failed,
/// or of `keep`; the round's other results have then been kept.
ending in_rounds(MPI_Comm comm, std::vector<std::uint64_t> chunks, const work& what,
                 const keeper& keep, const std::atomic<int>& stop);

/// Rank 0's text, on all.
std::string broadcast(MPI_Comm comm, std::string text);

/// Calls act() on rank 0. What it throws is thrown on all, with its message: support::usage_error
/// and std::bad_alloc as such, all else as std::runtime_error.
void on_root(MPI_Comm comm, const std::function<void()>& act);

}  // namespace errbound::study
