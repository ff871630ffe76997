// The base class of the program's commands.
#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

namespace ccd::program {

enum exit_status { done = 0, bad_input = 1, broken_promise = 1, stopped = 3 };

class command {
  public:
    command(CLI::App& program, const std::string& name, const std::string& description)
        : line_(*program.add_subcommand(name, description)) {}
    virtual ~command() = default;
    command(const command&) = delete;
    command& operator=(const command&) = delete;

    bool was_given() const { return line_.parsed(); }

    /// Prints to standard output and writes files.
    /// Throws usage_error (contradictory options), file_error, device_error.
    virtual exit_status run() = 0;

  protected:
    CLI::App& line_;
};

std::unique_ptr<command> query_command(CLI::App& program);
std::unique_ptr<command> step_command(CLI::App& program);
std::unique_ptr<command> stress_command(CLI::App& program);
std::unique_ptr<command> report_command(CLI::App& program);
std::unique_ptr<command> convert_command(CLI::App& program);
std::unique_ptr<command> methods_command(CLI::App& program);

}  // namespace ccd::program
