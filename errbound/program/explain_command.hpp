// `errbound explain`: prints and draws where results' errors come from.
#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

namespace errbound::explaining {

class explain_command {
  public:
    explicit explain_command(CLI::App& program);

    bool was_given() const { return line_.parsed(); }
    /// Runs the parsed command. Returns the exit status, 0. Throws errbound::support::usage_error,
    /// errbound::support::file_error.
    int run() const;

  private:
    CLI::App& line_;
    std::string file_, result_;
    std::size_t lines_ = 20;
    std::optional<std::filesystem::path> picture_;
};

}  // namespace errbound::explaining
