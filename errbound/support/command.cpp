#include "errbound/support/command.hpp"

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string_view>
#include <type_traits>

namespace errbound::support {

bool option::was_given() const {
    return of_->count() > 0;
}
option& option::required() {
    of_->required();
    return *this;
}
option& option::type(const std::string& name) {
    of_->type_name(name);
    return *this;
}
option& option::input() {
    of_->transform(input_named);
    return *this;
}
option& option::at_least(int values) {
    of_->expected(values, -1);
    return *this;
}
option& option::shows_default() {
    of_->capture_default_str();
    return *this;
}
option& option::among(const std::vector<std::string>& names) {
    of_->check(CLI::IsMember(names));
    return *this;
}
template <class T>
option& option::between(T least, T most) {
    if constexpr (std::is_floating_point_v<T>)
        check([](const std::string& text) {
            return text.find("nan") == text.npos ? "" : text + "; expected a number";
        });
    of_->check(CLI::Range(least, most));
    return *this;
}
template option& option::between(int, int);
template option& option::between(std::uint64_t, std::uint64_t);
template option& option::between(double, double);
option& option::check(std::function<std::string(const std::string&)> fault) {
    of_->check(std::move(fault));
    return *this;
}
option& option::ends_in(const std::string& ending, bool or_output) {
    type("OUT" + ending);
    return check([ending, or_output](const std::string& path) {
        if (path.ends_with(ending) || (or_output && path == "-")) return std::string();
        return "path is '" + path + "'; expected a name that ends in " + ending +
               (or_output ? ", or -" : "");
    });
}

template <class T>
option add(CLI::App& line, const std::string& name, T& value, const std::string& description) {
    return option(line.add_option(name, value, description));
}
template option add(CLI::App&, const std::string&, int&, const std::string&);
template option add(CLI::App&, const std::string&, unsigned long&, const std::string&);
template option add(CLI::App&, const std::string&, unsigned long long&, const std::string&);
template option add(CLI::App&, const std::string&, double&, const std::string&);
template option add(CLI::App&, const std::string&, std::optional<double>&, const std::string&);
template option add(CLI::App&, const std::string&, std::string&, const std::string&);
template option add(CLI::App&, const std::string&, std::vector<std::string>&, const std::string&);
template option add(CLI::App&, const std::string&, std::filesystem::path&, const std::string&);
template option add(CLI::App&, const std::string&, std::optional<std::filesystem::path>&,
                    const std::string&);
template option add(CLI::App&, const std::string&, std::vector<std::filesystem::path>&,
                    const std::string&);

option add_flag(CLI::App& line, const std::string& name, bool& value,
                const std::string& description) {
    return option(line.add_flag(name, value, description));
}
option add_output(CLI::App& line, const std::string& name,
                  std::optional<std::filesystem::path>& file, const std::string& description) {
    return add(line, name, file, description).type("OUT");
}

command::command(CLI::App& program, const std::string& name, const std::string& description)
    : line_(*program.add_subcommand(name, description)) {}

bool command::was_given() const {
    return line_.parsed();
}
bool command::was_given(const std::string& option) const {
    return line_.count(option) > 0;
}

namespace {

/// "--threads: Value -1 not in range [0 - 4096]" in this project's words.
std::string message_of(std::string text) {
    constexpr std::string_view value = ": Value ", range = " not in range ";
    const std::size_t at = text.find(value), of_range = text.find(range);
    if (at == text.npos || of_range == text.npos) return text;
    text.replace(of_range, range.size(), "; expected ");
    return text.replace(at, value.size(), " is ");
}

}  // namespace

int parse_and_run(CLI::App& app, int argc, char** argv, const std::function<int()>& body,
                  bool prints) {
    app.allow_windows_style_options(false);  // a path may begin with a slash
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() != 0) throw usage_error(message_of(error.what()));
        if (prints) app.exit(error);
        return done;
    }
    return body();
}

int run_command(const program_text& program, int argc, char** argv,
                std::span<const command_maker> makers, bool prints) {
    CLI::App app(program.description, program.name);
    app.set_version_flag("--version", program.name + ' ' + program.version);
    std::vector<std::unique_ptr<command>> commands;
    for (const command_maker& make : makers) commands.push_back(make(app));
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
