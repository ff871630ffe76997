// `ccd stress`: its options and what it does, for the program over ranks, too.
#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
#include <string>

#include "ccd/program/command.hpp"
#include "ccd/program/options.hpp"
#include "ccd/stress/output.hpp"

namespace ccd::program {

class stress_run : public command {
  public:
    explicit stress_run(CLI::App& program);
    exit_status run() override;

  protected:
    /// What the options ask. Throws usage_error.
    stress::plan checked_plan() const;
    /// Throws usage_error, errbound::support::file_error.
    void require_good_outputs() const;

    stress::outputs out_;

  private:
    stress::plan plan_;
    std::string families_;
    bool quick_ = false;
    std::size_t queries_ = 1000;
    methods_option methods_{line_};
};

}  // namespace ccd::program
