// `errbound validate` over ranks.
#pragma once

#include <mpi.h>

#include <filesystem>
#include <optional>

#include "errbound/program/validate_options.hpp"

namespace errbound::validation {

/// What run_validate does, with each rank taking chunks of evidence, and its results: the same for
/// every number of ranks. Rank 0 reads and writes files. Collective; the status is the same on all
/// ranks, and what is thrown is thrown on all.
exit_status validate_over_ranks(MPI_Comm comm, const validate_arguments& arguments,
                                const std::optional<std::filesystem::path>& journal);

}  // namespace errbound::validation
