#include "errbound/support/rows.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>

namespace errbound::support {
namespace {

std::string cell_of(const row& value) {
    if (value.is_string()) return value.get<std::string>();
    if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
    if (value.is_number_unsigned() || (value.is_number_integer() && value >= 0))
        return grouped(value.get<std::uint64_t>());
    if (value.is_number_integer()) return std::to_string(value.get<std::int64_t>());
    return value.is_number() ? digits(value.get<double>()) : "-";
}

std::string field_of(const row& value) {
    if (value.is_null()) return "";
    if (!value.is_string()) return json_of(value, -1);
    const std::string text = value.get<std::string>();
    if (text.find_first_of(",\"\n") == std::string::npos) return text;
    std::string quoted = "\"";
    for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
    return quoted + '"';
}

}  // namespace

std::string digits(double x) {
    char text[48];
    if (x == 0) return "0";
    if (x >= 1000 && x < 1e9) return grouped(static_cast<std::uint64_t>(std::round(x)));
    if (x < 1e-3 || x >= 1e9) {
        std::snprintf(text, sizeof text, "%.2e", x);
    } else {
        const int after = x >= 100 ? 0 : x >= 10 ? 1 : x >= 1 ? 2 : 3;
        std::snprintf(text, sizeof text, "%.*f", after, x);
    }
    return text;
}

table cells_of(const rows& all, const std::vector<std::string>& heading,
               const std::vector<std::string>& columns) {
    table cells{heading};
    for (const row& r : all) {
        cells.emplace_back();
        for (const std::string& column : columns)
            cells.back().push_back(r.contains(column) ? cell_of(r[column]) : "-");
    }
    return cells;
}

std::vector<std::string> columns_of(const rows& all) {
    std::vector<std::string> columns;
    for (const row& r : all)
        for (const auto& [column, value] : r.items())
            if (std::ranges::find(columns, column) == columns.end()) columns.push_back(column);
    return columns;
}

std::string text_of(const rows& all) {
    if (all.empty()) return "";
    const std::vector<std::string> columns = columns_of(all);
    std::vector<std::string> heading = columns;
    for (std::string& name : heading) std::ranges::replace(name, '_', ' ');
    const auto is_text = [&](const std::string& column) {
        return all.front().contains(column) && all.front()[column].is_string();
    };
    const auto left = std::ranges::find_if_not(columns, is_text) - columns.begin();
    return text_of(cells_of(all, heading, columns), static_cast<std::size_t>(left));
}

std::string markdown_of(const table& cells, std::size_t left) {
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

std::string csv_of(const std::vector<std::string>& columns, const rows& all) {
    std::string text;
    for (const std::string& column : columns) text += (text.empty() ? "" : ",") + column;
    text += '\n';
    for (const row& r : all) {
        for (std::size_t i = 0; i < columns.size(); ++i)
            text += (i > 0 ? "," : "") + field_of(r.value(columns[i], row()));
        text += '\n';
    }
    return text;
}

std::string json_of(const row& value, int indent) {
    return value.dump(indent, ' ', false, row::error_handler_t::replace);
}

}  // namespace errbound::support
