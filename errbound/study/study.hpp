// Studies: chunks of work that the ranks of MPI share, and that a journal keeps.
//
// What a study finds depends on its chunks alone: not on the number of ranks, on who computed what,
// or on how often it was ended and taken up again.
#pragma once

#include <mpi.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "errbound/study/journal.hpp"
#include "errbound/study/rounds.hpp"

namespace errbound::study {

/// What is studied.
struct subject {
    std::string program;       ///< for what is said to people
    std::string identity;      ///< one line that says all that results depend on
    std::uint64_t chunks = 0;  ///< numbered from 0
    study::work work;          ///< whose results are of one line each
};

/// Called on rank 0 after each round.
using progress = std::function<void(std::size_t done, std::size_t all)>;

class study {
  public:
    /// Opens the journal, if there is to be one, on rank 0. Collective. Throws on all ranks, with
    /// the message of what `journal` throws.
    study(MPI_Comm comm, subject what, std::optional<std::filesystem::path> journal);

    /// Computes what is not in the journal; collective. With one, SIGINT and SIGTERM end it after
    /// the round: then false on all ranks, and rank 0 has said how to go on. Throws as in_rounds.
    bool complete(const progress& show = {});

    /// Every chunk's result, in their order, on rank 0; none on other ranks.
    const std::vector<std::string>& results() const { return results_; }

    /// Writes what was found, by a call on rank 0, whose status is returned on all ranks; then the
    /// journal is removed. Collective; throws on all ranks what `write` throws.
    int conclude(const std::function<int()>& write);

  private:
    void open();
    void take(chunk_result found);

    MPI_Comm comm_;
    int rank_ = 0;
    subject what_;
    std::optional<std::filesystem::path> path_;
    std::unique_ptr<journal> journal_;  // on rank 0, as all that follows
    std::vector<std::string> results_;
    std::vector<bool> is_done_;
    std::size_t done_ = 0;
};

}  // namespace errbound::study
