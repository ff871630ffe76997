// What commands over ranks that are studies share.
#pragma once

#include <mpi.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>

#include "ccd/program/command.hpp"
#include "errbound/study/study.hpp"
#include "errbound/support/progress_line.hpp"

namespace ccd::program {

/// --journal.
class journal_option {
  public:
    explicit journal_option(CLI::App& line) {
        line.add_option("--journal", path_,
                        "Keep there what is done, until all is; where it is there, go on with it")
            ->type_name("FILE");
    }
    const std::optional<std::filesystem::path>& path() const { return path_; }

  private:
    std::optional<std::filesystem::path> path_;
};

/// Completes the study, shows how far it is, and calls write(results) on rank 0, whose status it
/// returns on all. Collective; throws on all ranks what is thrown on one.
template <class Write>
exit_status run_study(errbound::study::study& study, const Write& write) {
    {
        errbound::support::progress_line line;
        const auto show = [&](std::size_t done, std::size_t all) {
            line.show(done, all, "chunks");
        };
        if (!study.complete(show)) return stopped;
    }
    return static_cast<exit_status>(study.conclude([&] { return write(study.results()); }));
}

}  // namespace ccd::program
