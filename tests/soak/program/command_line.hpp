// The options of the soak and their execution.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>

#include "tests/soak/long_run.hpp"

namespace soak {

class command_line {
  public:
    /// Which part, and how much of it.
    struct choice {
        std::uint64_t count = 20'000'000;
        soak::part (*part)() = nullptr;
    };

    command_line();

    /// Throws CLI::ParseError.
    void parse(int argc, char** argv);
    const CLI::App& app() const { return app_; }

    /// Runs the part to its end or to a signal; returns the exit status. Throws std::runtime_error.
    int run() const;

  private:
    CLI::App app_{"What is exact against a reference, or against itself."};
    choice chosen_;
    soak::part part_;
    run_options options_;
    std::optional<std::uint64_t> seed_, first_;
    bool resume_ = false, anew_ = false;
};

}  // namespace soak
