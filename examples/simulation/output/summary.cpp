#include "examples/simulation/output/summary.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <errbound/support/error.hpp>
#include <limits>
#include <map>
#include <sstream>
#include <vector>

#include "errbound/support/decimal.hpp"
#include "errbound/support/output_file.hpp"
#include "examples/simulation/output/run_folder.hpp"

namespace simulation {
namespace {

std::vector<std::string> cells_of(const std::string& line) {
    std::vector<std::string> cells;
    std::istringstream rest(line);
    for (std::string cell; std::getline(rest, cell, ',');) cells.push_back(cell);
    return cells;
}

double number_of(const std::string& cell, const std::string& place) {
    if (cell.empty()) return std::nan("");
    const auto read = errbound::support::parse_decimal<double>(cell);
    if (read.status != errbound::support::decimal_status::ok)
        throw errbound::support::file_error(place + "cell is '" + cell + "'; expected a number");
    return read.value;
}

std::map<std::string, std::vector<double>> columns_of(const std::filesystem::path& path) {
    std::istringstream table(errbound::support::read_whole(path));
    std::string line;
    std::getline(table, line);
    if (line + '\n' != csv_heading())
        throw errbound::support::file_error(path.string() + ": line 1 is '" + line +
                                            "'; expected a table of frames");
    const std::vector<std::string> names = cells_of(line);
    std::map<std::string, std::vector<double>> columns;
    for (int number = 2; std::getline(table, line); ++number) {
        const std::vector<std::string> cells = cells_of(line);
        const std::string place = path.string() + ": line " + std::to_string(number) + ": ";
        if (cells.size() != names.size())
            throw errbound::support::file_error(place + "number of cells is " +
                                                std::to_string(cells.size()) + "; expected " +
                                                std::to_string(names.size()));
        for (std::size_t i = 0; i < names.size(); ++i)
            columns[names[i]].push_back(number_of(cells[i], place));
    }
    return columns;
}

double sum(const std::vector<double>& x) {
    double total = 0;
    for (const double value : x) total += std::isnan(value) ? 0 : value;
    return total;
}

}  // namespace

std::string summary_of(const std::filesystem::path& table) {
    auto columns = columns_of(table);
    const auto frames = static_cast<double>(columns["frame"].size());
    if (frames == 0) return "no frames\n";
    const auto mean = [&](const char* name) { return sum(columns[name]) / frames; };
    char text[1200];
    std::snprintf(text, sizeof text,
                  "%.0f frames, in the mean: solver %.1f ms, detection %.1f ms, response %.1f ms; "
                  "%.2f looks, %.0f contacts at the first look, %.0f pairs near at the start\n"
                  "frames without convergence: %.0f\n"
                  "pairs that passed through each other, by exact: %.0f%s\n",
                  frames, 1e3 * mean("solver_seconds"), 1e3 * mean("detection_seconds"),
                  1e3 * mean("response_seconds"), mean("iterations"), mean("contacts"),
                  mean("near_at_start"), frames - sum(columns["converged"]),
                  sum(columns["passed_through"]),
                  sum(columns["passed_through"]) == 0 ? ": certified free" : "");
    return text;
}

}  // namespace simulation
