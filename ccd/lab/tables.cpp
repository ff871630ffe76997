#include "ccd/lab/tables.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <errbound/support/error.hpp>
#include <limits>
#include <system_error>

#include "errbound/support/system/system.hpp"

namespace ccd::lab {

using errbound::support::file_error;
using errbound::support::grouped;

void tally::add(outcome answer, bool collides) {
    const bool reported = answer != outcome::separate;
    ++queries;
    colliding += collides;
    collisions += reported;
    uncertain += answer == outcome::uncertain;
    false_positives += reported && !collides;
    false_negatives += !reported && collides;
}

tally& tally::operator+=(const tally& more) {
    queries += more.queries;
    colliding += more.colliding;
    collisions += more.collisions;
    uncertain += more.uncertain;
    false_positives += more.false_positives;
    false_negatives += more.false_negatives;
    return *this;
}

double quantile(std::span<const double> sorted, double p) {
    if (sorted.empty()) return std::numeric_limits<double>::quiet_NaN();
    const auto last = static_cast<double>(sorted.size());
    return sorted[static_cast<std::size_t>(std::clamp(std::ceil(p * last), 1.0, last)) - 1];
}

std::string digits(double x) {
    char text[48];
    if (x == 0) return "0";
    if (x >= 1000 && x < 1e9) return grouped(static_cast<std::size_t>(std::round(x)));
    if (x < 1e-3 || x >= 1e9) {
        std::snprintf(text, sizeof text, "%.2e", x);
    } else {
        const int after = x >= 100 ? 0 : x >= 10 ? 1 : x >= 1 ? 2 : 3;
        std::snprintf(text, sizeof text, "%.*f", after, x);
    }
    return text;
}

errbound::support::table cells_of(const rows& all, const std::vector<std::string>& heading,
                                  const std::vector<std::string>& columns) {
    const auto cell_of = [](const row& value) -> std::string {
        if (value.is_string()) return value.get<std::string>();
        if (value.is_number_integer()) return grouped(value.get<std::size_t>());
        return value.is_number() ? digits(value.get<double>()) : "-";
    };
    errbound::support::table cells{heading};
    for (const row& r : all) {
        cells.emplace_back();
        for (const std::string& column : columns)
            cells.back().push_back(r.contains(column) ? cell_of(r[column]) : "-");
    }
    return cells;
}

std::string markdown_of(const errbound::support::table& cells, std::size_t left) {
    const auto line = [](const std::vector<std::string>& row) {
        std::string text = "|";
        for (const std::string& cell : row) text += " " + cell + " |";
        return text + "\n";
    };
    std::vector<std::string> rule(cells.front().size(), "---:");
    std::fill_n(rule.begin(), left, "---");
    std::string text;
    for (std::size_t i = 0; i < cells.size(); ++i) {
        text += line(cells[i]);
        if (i == 0) text += line(rule);
    }
    return text + "\n";
}

std::string fingerprint_of(std::string_view bytes) {
    std::uint64_t hash = 0xcbf29ce484222325;
    for (const char byte : bytes) hash = (hash ^ static_cast<unsigned char>(byte)) * 0x100000001b3;
    char text[17];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
    return text;
}

void make_folder(const std::filesystem::path& folder) {
    namespace system = errbound::support::system;
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error || !std::filesystem::is_directory(folder))
        throw file_error(folder.string() + ": cannot be made a folder" +
                         (error ? " (" + error.message() + ")" : std::string()));
    if (!system::may_write_in(system::native_name(folder)))
        throw file_error(folder.string() + ": cannot be written to");
}

std::string text_of(const row& json, int indent) {
    return json.dump(indent, ' ', false, row::error_handler_t::replace);
}

}  // namespace ccd::lab
