#include "errbound/support/command.hpp"

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string_view>
#include <type_traits>
#include <utility>

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
            return text.find("nan") == text.npos ? "" : "is " + text + "; expected a number";
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
        return "is '" + path + "'; expected a name that ends in " + ending +
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

/// CLI11's messages and this project's. Each * stands for any text; %i is the text of the i-th *.
constexpr std::pair<std::string_view, std::string_view> messages[] = {
    {"*: Value * not in range [* - *]", "%0 is %1; expected %2 to %3"},
    {"*: Value * not in range *", "%0 is %1; expected %2"},
    {"*: * not in {*}", "%0 is '%1'; expected one of %2"},
    {"*: At Most 1 required but received *", "%0 is given %1 times; expected once"},
    {"*: At Most * required but received *", "%0 has %2 values; expected at most %1"},
    {"*: At least * required but received *", "%0 has %2 values; expected at least %1"},
    {"*: * required *:* missing", "value of %0 is missing; expected %3"},
    {"*: * required * missing", "value of %0 is missing; expected %2"},
    {"Could not convert: * = *", "%0 is '%1'; expected "},
    {"* is required", "%0 is missing"},
    {"* requires *", "%0 is given without %1; expected both"},
    {"* excludes *", "%0 is given with %1; expected only one of them"},
    {"Requires at most 1 * from [*]", "several of %1 are given; expected at most one"},
};

/// The texts of the pattern's * in `text`, or nothing if it does not match.
std::vector<std::string_view> matched(std::string_view text, std::string_view pattern) {
    std::vector<std::string_view> found;
    for (std::size_t star = 0; (star = pattern.find('*')) != pattern.npos;) {
        if (!text.starts_with(pattern.substr(0, star))) return {};
        text.remove_prefix(star);
        pattern.remove_prefix(star + 1);
        const std::string_view next = pattern.substr(0, pattern.find('*'));
        const std::size_t end = next.empty() ? text.size() : text.find(next);
        if (end == text.npos) return {};
        found.push_back(text.substr(0, end));
        text.remove_prefix(end);
    }
    return text == pattern ? found : std::vector<std::string_view>();
}

/// The values of an option whose text CLI11 could not convert.
std::string values_of(const CLI::Option* option) {
    const std::string type = option == nullptr ? "" : option->get_type_name();
    if (type.empty()) return "no value";
    return type == "FLOAT" ? "a number" : type == "UINT" ? "an integer >= 0" : "an integer";
}

/// An unknown option comes first, since other arguments may be missing because of it.
std::string message_of(const CLI::App& app, const CLI::ParseError& error) {
    std::vector<const CLI::App*> lines{&app};
    for (const CLI::App* parsed : app.get_subcommands()) lines.push_back(parsed);
    std::string help;
    for (const CLI::App* line : lines) {
        help += line->get_name() + ' ';
        for (const std::string& argument : line->remaining())
            if (argument.size() > 1 && argument[0] == '-' && argument != "--")
                return "option is '" + argument + "'; expected one that " + help + "--help lists";
    }
    help += "--help lists the arguments";
    const std::vector<std::string> extra = app.remaining(true);
    if (!extra.empty()) return "argument '" + extra.front() + "' is one too many; " + help;
    std::string text = error.what();
    if (text.find("; expected ") != text.npos) {  // a check of this project
        const std::size_t colon = text.find(": ");
        if (colon != text.npos && colon == text.find(": is ")) text.erase(colon, 1);
        return text;
    }
    for (const auto& [theirs, ours] : messages) {
        const auto found = matched(text, theirs);
        if (found.empty()) continue;
        std::string message;
        for (std::size_t i = 0; i < ours.size(); ++i)
            if (ours[i] == '%')
                message += found[static_cast<std::size_t>(ours[++i] - '0')];
            else
                message += ours[i];
        if (message.ends_with("expected "))
            message += values_of(lines.back()->get_option_no_throw(std::string(found[0])));
        return message.find("; ") == message.npos ? message + "; " + help : message;
    }
    return text;
}

}  // namespace

int parse_and_run(CLI::App& app, int argc, char** argv, const std::function<int()>& body,
                  bool prints) {
    app.allow_windows_style_options(false);  // a path may begin with a slash
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() != 0) throw usage_error(message_of(app, error));
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
