// ./run bench --worst: the slowest known input of each public function, and the search for it.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <map>
#include <sstream>

#include "errbound/support/output_file.hpp"
#include "tests/bench/harness.hpp"
#include "tests/bench/worst_cases/worst_cases.hpp"

namespace {

using namespace worst_cases;

/// Rows by the names of a function and of a range.
using inputs = std::map<std::pair<std::string, std::string>, std::vector<double>>;

/// Lines "function; range; number number ...", hexadecimal.
inputs read(const std::filesystem::path& path) {
    inputs all;
    std::istringstream text(errbound::support::read_whole(path));
    for (std::string function, within, numbers, number; std::getline(text, function, ';') &&
                                                        std::getline(text, within, ';') &&
                                                        std::getline(text, numbers);) {
        auto& row = all[{function, within}];
        for (std::istringstream in(numbers); in >> number;)
            row.push_back(std::strtod(number.c_str(), nullptr));
    }
    return all;
}

std::string written(const inputs& all) {
    std::string text;
    for (const auto& [key, numbers] : all) {
        text += key.first + ";" + key.second + ";";
        for (const double x : numbers) {
            char number[32];
            std::snprintf(number, sizeof number, "%a ", x);
            text += number;
        }
        text.back() = '\n';
    }
    return text;
}

/// A table row for each function, from its stored inputs.
std::vector<std::vector<bench::cell>> timed(const std::vector<subject>& subjects, const inputs& all,
                                            int times) {
    std::vector<std::vector<bench::cell>> rows;
    for (const subject& s : subjects)
        for (const range& within : ranges) {
            const auto found = all.find({s.name, within.name});
            if (found == all.end() || found->second.size() != s.numbers)
                throw std::runtime_error("no input is stored for " + s.name + ", " + within.name +
                                         ": --search finds one");
            const std::vector<double>& numbers = found->second;
            const std::size_t stack = stack_of([&] { s.call(numbers.data()); });
            rows.push_back({bench::word(s.name), bench::word(within.name),
                            bench::number(1e6 * seconds_of(s, numbers, times), 2),
                            bench::number(static_cast<double>(stack) / 1024, 1)});
        }
    return rows;
}

}  // namespace

int main(int argc, char** argv) try {
    CLI::App app{"The slowest known input of each public function: its time and stack."};
    app.name("./run bench --worst");
    bool quick = false;
    double search = 0;
    std::uint64_t seed = 1;
    std::string only;
    std::filesystem::path path = WORST_CASES;
    app.add_flag("--quick", quick, "Fewer repeats: tests that everything runs");
    app.add_option(
           "--search", search,
           "First search this many seconds for each function and range; store slower inputs")
        ->check(CLI::PositiveNumber);
    app.add_option("--seed", seed, "Seed of the search");
    app.add_option("--function", only, "Only functions whose name contains this");
    app.add_option("--inputs", path, "File of stored inputs");
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    }
    std::vector<subject> subjects = of_queries();
    for (subject& s : of_predicates()) subjects.push_back(std::move(s));
    for (subject& s : of_roots()) subjects.push_back(std::move(s));
    std::erase_if(subjects, [&](const subject& s) { return s.name.find(only) == s.name.npos; });

    inputs all;
    if (std::filesystem::exists(path)) all = read(path);
    for (const subject& s : subjects)
        for (const range& within : ranges) {
            if (search == 0) break;
            std::vector<std::vector<double>> known;
            for (const auto& [key, numbers] : all) known.push_back(numbers);
            all[{s.name, within.name}] = slowest(s, within, known, search, seed);
            errbound::support::write_whole(path, written(all));
        }
    bench::report().table("worst", {}, "the slowest known input of each function",
                          {{"function", "function", true},
                           {"coordinates", "coordinates", true},
                           {"microseconds", "us"},
                           {"stack_kib", "stack, KiB"}},
                          timed(subjects, all, quick ? 1 : 9));
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "bench: %s\n", error.what());
    return 1;
}
