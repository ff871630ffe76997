#include "tests/bench/harness.hpp"

#include <cstdio>
#include <stdexcept>

#include "errbound/support/table.hpp"

namespace bench {

cell word(std::string_view text) {
    return {std::string(text), text};
}

cell count(std::uint64_t n) {
    const std::string digits = std::to_string(n);
    std::string text;
    for (std::size_t i = 0; i < digits.size(); ++i) {
        if (i > 0 && (digits.size() - i) % 3 == 0) text += ',';
        text += digits[i];
    }
    return {text, n};
}

cell number(double x, int digits) {
    char text[64];
    std::snprintf(text, sizeof text, "%.*f", digits, x);
    return {text, x};
}

cell percent(double share) {
    char text[64];
    std::snprintf(text, sizeof text, "%.2f %%", 100 * share);
    return {text, share};
}

cell none() {
    return {"-", nullptr};
}

void report::table(std::string_view section, const nlohmann::json& about, const std::string& title,
                   const std::vector<column>& columns, const std::vector<std::vector<cell>>& rows) {
    errbound::support::table text(1);
    for (const column& c : columns) text[0].push_back(c.heading);
    nlohmann::json values = nlohmann::json::array();
    for (const auto& row : rows) {
        if (row.size() != columns.size()) throw std::logic_error("cells do not match columns");
        text.emplace_back();
        nlohmann::json entry = about;
        for (std::size_t i = 0; i < row.size(); ++i) {
            text.back().push_back(row[i].text);
            entry[columns[i].key] = row[i].value;
        }
        values.push_back(std::move(entry));
    }
    const auto left = static_cast<std::size_t>(std::ranges::count(columns, true, &column::left));
    std::printf("\n%s\n\n%s", title.c_str(), errbound::support::text_of(text, left).c_str());
    std::fflush(stdout);
    tables_.push_back({{"section", section}, {"title", title}, {"rows", std::move(values)}});
}

void report::say(const std::string& line) {
    std::printf("%s\n", line.c_str());
    std::fflush(stdout);
}

}  // namespace bench
