// What commands that are studies share.
#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "errbound/study/study.hpp"
#include "errbound/support/progress_line.hpp"

namespace errbound::study {

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
/// returns on all; `stopped` where it was ended before. Collective; throws on all ranks what is
/// thrown on one.
template <class Status, class Write>
Status run_study(study& all, Status stopped, const Write& write) {
    {
        support::progress_line line;
        const auto show = [&](std::size_t done, std::size_t of) { line.show(done, of, "chunks"); };
        if (!all.complete(show)) return stopped;
    }
    return static_cast<Status>(all.conclude([&] { return write(all.results()); }));
}

}  // namespace errbound::study
