// Command lines by CLI11, for programs with and without commands.
#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <regex>
#include <span>
#include <string>

#include "errbound/support/command_line.hpp"

namespace errbound::support {

/// run_program returns 2 for bad usage.
enum exit_status { done = 0, bad_input = 1, broken_promise = 1, stopped = 3, check_failed = 3 };

/// Returns body(), or 0 after printing --help or --version, unless `prints` is false. Throws
/// usage_error.
template <class Body>
int parse_and_run(CLI::App& app, int argc, char** argv, const Body& body, bool prints = true) {
    app.allow_windows_style_options(false);  // a path may begin with a slash
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        static const std::regex out_of_range("(\\S+): Value (\\S+) not in range (.*)");
        if (error.get_exit_code() != 0)
            throw usage_error(
                std::regex_replace(error.what(), out_of_range, "$1 is $2; expected $3"));
        if (prints) app.exit(error);
        return done;
    }
    return body();
}

class command {
  public:
    command(CLI::App& program, const std::string& name, const std::string& description)
        : line_(*program.add_subcommand(name, description)) {}
    virtual ~command() = default;
    command(const command&) = delete;
    command& operator=(const command&) = delete;

    bool was_given() const { return line_.parsed(); }

    /// Throws usage_error (contradictory options), file_error, or a device's error.
    virtual exit_status run() = 0;

  protected:
    CLI::App& line_;
};

/// Parses the line and runs its command. Throws usage_error if there is none.
inline int run_command(CLI::App& app, int argc, char** argv,
                       std::span<const std::unique_ptr<command>> commands, bool prints = true) {
    app.require_subcommand(0, 1);
    if (argc > 1 && argv[1][0] != '-')
        entry_named("command", argv[1], app.get_subcommands({}), &CLI::App::get_name);
    const auto run = [&]() -> int {
        for (const auto& c : commands)
            if (c->was_given()) return c->run();
        throw usage_error("command is missing; " + app.get_name() + " --help lists the commands");
    };
    return parse_and_run(app, argc, argv, run, prints);
}

}  // namespace errbound::support
