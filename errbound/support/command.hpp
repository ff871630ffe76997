// Command lines by CLI11. Only command.cpp includes its header, which takes seconds to compile.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "errbound/support/command_line.hpp"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace errbound::support {

/// run_program returns 2 for bad usage.
enum exit_status { done = 0, bad_input = 1, broken_promise = 1, stopped = 3, check_failed = 3 };

/// An option of a command line. Functions set what CLI11 checks and what --help prints.
class option {
  public:
    explicit option(CLI::Option* of) : of_(of) {}
    bool was_given() const;

    option& required();
    option& type(const std::string& name);
    option& input();  ///< a file; - is standard input
    option& at_least(int values);
    option& shows_default();
    option& among(const std::vector<std::string>& names);
    template <class T>
    option& between(T least, T most);  ///< int, std::uint64_t, double: not NaN
    /// `fault` returns "is VALUE; expected ...", another message, or nothing for a good value.
    option& check(std::function<std::string(const std::string&)> fault);
    /// A name with this ending; with `or_output` also -.
    option& ends_in(const std::string& ending, bool or_output = false);

  private:
    CLI::Option* of_;
};

/// Adds an option with a value, a flag, or an output file OUT.
template <class T>
option add(CLI::App& line, const std::string& name, T& value, const std::string& description);
option add_flag(CLI::App& line, const std::string& name, bool& value,
                const std::string& description);
option add_output(CLI::App& line, const std::string& name,
                  std::optional<std::filesystem::path>& file, const std::string& description);

class command {
  public:
    command(CLI::App& program, const std::string& name, const std::string& description);
    virtual ~command() = default;
    command(const command&) = delete;
    command& operator=(const command&) = delete;

    bool was_given() const;

    /// Throws usage_error (contradictory options), file_error, or a device's error.
    virtual exit_status run() = 0;

  protected:
    bool was_given(const std::string& option) const;

    CLI::App& line_;
};

/// Returns body(). For --help and --version returns 0, after printing the text if `prints` is true.
/// Throws usage_error.
int parse_and_run(CLI::App& app, int argc, char** argv, const std::function<int()>& body,
                  bool prints = true);

/// The texts of --help and --version.
struct program_text {
    std::string name, description, version;
};
using command_maker = std::unique_ptr<command> (*)(CLI::App& program);
template <class Command>
std::unique_ptr<command> make_command(CLI::App& program) {
    return std::make_unique<Command>(program);
}

/// Parses the line and runs its command. Throws usage_error if there is none.
int run_command(const program_text& program, int argc, char** argv,
                std::span<const command_maker> makers, bool prints = true);

}  // namespace errbound::support
