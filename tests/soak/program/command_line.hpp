// What the soak is told, for one process and over ranks.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <functional>
#include <string>

#include "tests/soak/long_run.hpp"

namespace soak {

/// soak::run, or what does the same.
using runner = std::function<decltype(soak::run)>;

class command_line {
  public:
    /// Which part, and how much of it.
    struct choice {
        std::uint64_t count = 20'000'000;
        soak::part (*part)() = nullptr;
    };

    /// `how` it is called; `threads` unless it is told.
    command_line(const std::string& how, unsigned threads);

    /// Throws CLI::ParseError.
    void parse(int argc, char** argv);
    const CLI::App& app() const { return app_; }

    const soak::part& part() const { return part_; }
    const run_options& options() const { return options_; }

    /// Runs the part to its end or to a signal; returns the exit status. Throws std::runtime_error.
    int run(const runner& run_part) const;

  private:
    CLI::App app_{"What is exact against a reference, or against itself."};
    choice chosen_;
    soak::part part_;
    run_options options_;
    std::uint64_t seed_ = 1;
    CLI::Option* seed_option_ = nullptr;
    bool resume_ = false, anew_ = false;
};

}  // namespace soak
