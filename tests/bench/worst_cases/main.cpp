// ./run bench --worst: the slowest known input of each public function, and the search for it.
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <sstream>
#include <stdexcept>

#include "errbound/support/output_file.hpp"
#include "tests/bench/harness.hpp"
#include "tests/bench/worst_cases/worst_cases.hpp"

namespace {

using namespace worst_cases;

/// The inputs, by the names of a function and a range.
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

/// A row for each function and range, of its stored input.
bench::rows timed(const std::vector<subject>& subjects, const inputs& all, int times) {
    bench::rows table;
    for (const subject& s : subjects)
        for (const range& within : ranges) {
            const auto found = all.find({s.name, within.name});
            if (found == all.end() || found->second.size() != s.numbers)
                throw std::runtime_error("no input is stored for " + s.name + ", " + within.name +
                                         ": --search finds one");
            const std::vector<double>& numbers = found->second;
            const std::size_t stack = stack_of([&] { s.call(numbers.data()); });
            table.push_back({{"function", s.name},
                             {"coordinates", within.name},
                             {"us", 1e6 * seconds_of(s, numbers, times)},
                             {"stack_KiB", static_cast<double>(stack) / 1024}});
        }
    return table;
}

}  // namespace

int main(int argc, char** argv) {
    bench::program bench("./run bench --worst",
                         "The slowest known input of each public function: its time and stack.");
    double search = 0;
    std::uint64_t seed = 1;
    std::string only;
    std::filesystem::path path = WORST_CASES;
    bench.line
        .add_option("--search", search,
                    "Search that many seconds for a slower input of each function and range first, "
                    "and keep it")
        ->check(CLI::PositiveNumber);
    bench.line.add_option("--seed", seed, "Of the search");
    bench.line.add_option("--function", only, "Only functions whose name holds this");
    bench.line.add_option("--inputs", path, "The file of inputs");
    return bench.run(argc, argv, [&](bench::report& out) {
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
        out.table("worst", {}, "the slowest known input of each function",
                  timed(subjects, all, bench.quick ? 1 : 9));
    });
}
