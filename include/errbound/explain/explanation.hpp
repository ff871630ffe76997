// A number's error by sources: values, table, JSON for `errbound explain` (docs/how-wrong.md).
#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <errbound/explain/scope.hpp>
#include <errbound/printing.hpp>
#include <errbound/support/error.hpp>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace errbound {

struct contribution {
    std::vector<place> scopes;  ///< in which the operation ran, the outermost first
    /// "+", "-", "*", "/", "scale", "input" (a number within an error), "rounding to the type" (8
    /// and 16 bits), a function's name, or "the rest": sources too small to be kept.
    std::string operation;
    double amount = 0;  ///< part of the error's bound; infinite if the error became infinite here
    double known = 0;   ///< signed part of exact value − value; 0 by rules without signs
};

struct explanation {
    std::string name;  ///< of the result
    std::string rule;  ///< the rule that bounds its error
    double value = 0;  ///< rounded to nearest from a wider type, so value ± error is approximate
    double error = 0;  ///< rounded like value; infinite if there is no bound
    /// The largest first. Amounts add up to at least the error. The sum is larger by roundings (a
    /// few 2^-53 of it per source), or where signed parts cancel.
    std::vector<contribution> contributions;
};

namespace detail {

inline std::size_t character_length(std::string_view text) {
    const auto byte = [&](std::size_t i) {
        return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U;
    };
    const unsigned first = byte(0), second = byte(1);
    const std::size_t length = first < 0x80   ? 1
                               : first < 0xc2 ? 0
                               : first < 0xe0 ? 2
                               : first < 0xf0 ? 3
                               : first < 0xf5 ? 4
                                              : 0;
    for (std::size_t i = 1; i < length; ++i)
        if (byte(i) < 0x80 || byte(i) >= 0xc0) return 0;
    // Overlong forms, surrogates and codes beyond the last character.
    if ((first == 0xe0 && second < 0xa0) || (first == 0xed && second >= 0xa0) ||
        (first == 0xf0 && second < 0x90) || (first == 0xf4 && second >= 0x90))
        return 0;
    return length;
}

/// For terminals: replaces control characters and invalid UTF-8 by '?'.
inline std::string printable(std::string_view text) {
    std::string shown;
    while (!text.empty()) {
        const std::size_t length = character_length(text);
        const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
        const bool control = length == 1   ? byte(0) < 0x20 || byte(0) == 0x7f
                             : length == 2 ? byte(0) == 0xc2 && byte(1) < 0xa0
                                           : length == 0;
        if (control)
            shown += '?';
        else
            shown += text.substr(0, length);
        text.remove_prefix(std::max<std::size_t>(length, 1));
    }
    return shown;
}
/// Columns of a UTF-8 text, one per character.
inline std::size_t columns_of(std::string_view text) {
    return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
        return (static_cast<unsigned char>(c) & 0xc0) != 0x80;
    }));
}

/// A JSON string; invalid UTF-8 (possible in paths) becomes '?'.
inline std::string json_string(std::string_view text) {
    std::string quoted = "\"";
    while (!text.empty()) {
        const std::size_t length = character_length(text);
        const auto first = static_cast<unsigned char>(text.front());
        if (length == 0) {
            quoted += '?';
        } else if (first < 0x20) {
            std::array<char, 8> code{};
            std::snprintf(code.data(), code.size(), "\\u%04x", static_cast<unsigned>(first));
            quoted += code.data();
        } else {
            if (first == '"' || first == '\\') quoted += '\\';
            quoted += text.substr(0, length);
        }
        text.remove_prefix(std::max<std::size_t>(length, 1));
    }
    return quoted + '"';
}
/// The shortest decimal that reads back; null if not finite. (Readers may take -0 for an integer.)
inline std::string json_number(double x) {
    if (x == 0 && std::signbit(x)) return "-0.0";
    return std::isfinite(x) ? decimal(x) : "null";
}

/// Like json_number, with strings for infinities.
inline std::string json_value(double x) {
    if (std::isinf(x)) return x > 0 ? "\"inf\"" : "\"-inf\"";
    return json_number(x);
}

inline std::string json_of(const contribution& c) {
    std::string scopes;
    for (const place& s : c.scopes)
        scopes += (scopes.empty() ? "" : ", ") + ("{\"name\": " + json_string(s.name)) +
                  ", \"file\": " + json_string(s.file) + ", \"line\": " + std::to_string(s.line) +
                  '}';
    return "        {\"amount\": " + json_number(c.amount) +
           ", \"known\": " + json_number(c.known) + ", \"operation\": " + json_string(c.operation) +
           ", \"scopes\": [" + scopes + "]}";
}
inline std::string json_of(const explanation& e) {
    std::string contributions;
    for (const contribution& c : e.contributions)
        contributions += (contributions.empty() ? "\n" : ",\n") + json_of(c);
    return "    {\n      \"name\": " + json_string(e.name) +
           ",\n      \"rule\": " + json_string(e.rule) +
           ",\n      \"value\": " + json_value(e.value) +
           ",\n      \"error\": " + json_number(e.error) + ",\n      \"contributions\": [" +
           contributions + (contributions.empty() ? "]\n    }" : "\n      ]\n    }");
}

inline std::string scientific(double x) {
    return decimal(x, std::chars_format::scientific, 2);
}
inline std::string with_sign(double x) {
    const std::string text = scientific(x);
    return text[0] == '-' ? text : '+' + text;
}
inline std::string tenths(double x) {
    return decimal(x, std::chars_format::fixed, 1);
}
inline std::string percent(double share) {
    return tenths(100 * share) + " %";
}
/// naive > squares (variance.cpp:20)
inline std::string text_of(const std::vector<place>& scopes) {
    if (scopes.empty()) return "";
    std::string path;
    for (const place& s : scopes) path += (path.empty() ? "" : " > ") + s.name;
    const std::string& file = scopes.back().file;
    return printable(path + " (" + file.substr(file.find_last_of("/\\") + 1)) + ':' +
           std::to_string(scopes.back().line) + ')';
}

inline std::string heading_of(const explanation& e) {
    return printable(e.name) + " = " + value_and_radius(e.value, e.error) + ", by " +
           printable(e.rule);
}

/// Aligns columns: the last two left, the others right.
inline std::string aligned(const std::vector<std::vector<std::string>>& rows) {
    const std::size_t columns = rows.front().size();
    std::vector<std::size_t> widths(columns, 0);
    for (const auto& row : rows)
        for (std::size_t i = 0; i < columns; ++i)
            widths[i] = (std::max)(widths[i], columns_of(row[i]));
    std::string text;
    for (const auto& row : rows) {
        std::string line;
        for (std::size_t i = 0; i < columns; ++i) {
            const std::string spaces(widths[i] - columns_of(row[i]), ' ');
            line += "  " + (i + 2 < columns ? spaces + row[i] : row[i] + spaces);
        }
        text += line.substr(0, line.find_last_not_of(' ') + 1) + '\n';
    }
    return text;
}

/// Writes a temporary file next to `path` and renames it; pipes and devices directly.
inline void write_file(const std::filesystem::path& path, std::string_view text) {
    namespace fs = std::filesystem;
    std::error_code error;
    const fs::file_status replaced = fs::status(path, error);
    const bool replaces = fs::is_regular_file(replaced);
    const bool in_place = !replaces && replaced.type() != fs::file_type::not_found;
    const fs::path target = replaces ? fs::canonical(path, error) : path;
    bool written = !replaces || std::ofstream(target, std::ios::app).is_open();
    fs::path beside = target;
    if (!in_place)
        beside += ".errbound-" +
                  std::to_string(std::chrono::steady_clock::now().time_since_epoch().count()) +
                  ".tmp";
    if (written) {
        std::ofstream file(beside, std::ios::binary);
        file << text;
        file.close();
        written = !file.fail();
    }
    error.clear();
    if (written && replaces) fs::permissions(beside, replaced.permissions(), error);
    if (written && !in_place && !error) fs::rename(beside, target, error);
    written = written && !error;
    if (!written && !in_place) fs::remove(beside, error);
    if (!written)
        throw support::file_error(path.string() + ": cannot be written; expected a writable path");
}

}  // namespace detail

/// Each contribution's share of the error, from 0 to 1. Infinite contributions share equally.
inline std::vector<double> shares_of(const explanation& e) {
    double largest = 0, unknown = 0;
    for (const contribution& c : e.contributions) {
        largest = (std::max)(largest, c.amount);
        unknown += std::isfinite(c.amount) ? 0 : 1;
    }
    std::vector<double> shares;
    double all = 0;  // relative to the largest: the sum itself may overflow
    for (const contribution& c : e.contributions) {
        if (unknown > 0)
            shares.push_back(std::isfinite(c.amount) ? 0 : 1);
        else
            shares.push_back(largest > 0 ? c.amount / largest : 0);
        all += shares.back();
    }
    if (all > 0)
        for (double& share : shares) share /= all;
    return shares;
}

/// A table: the result, and a line for each source, at most `lines`.
inline std::string text_of(const explanation& e, std::size_t lines = 20) {
    std::string text = detail::heading_of(e) + '\n';
    if (e.contributions.empty()) return text + "  no error\n";
    const bool known = std::any_of(e.contributions.begin(), e.contributions.end(),
                                   [](const contribution& c) { return c.known != 0; });
    std::vector<std::vector<std::string>> rows{{"amount", "share", "operation", "scope"}};
    if (known) rows[0].insert(rows[0].begin() + 1, "signed");
    const std::vector<double> shares = shares_of(e);
    const std::size_t shown = (std::min)(lines, shares.size());
    for (std::size_t i = 0; i < shown; ++i) {
        const contribution& c = e.contributions[i];
        std::vector<std::string> row{
            std::isfinite(c.amount) ? detail::scientific(c.amount) : "unknown",
            detail::percent(shares[i]), detail::printable(c.operation), detail::text_of(c.scopes)};
        if (known) row.insert(row.begin() + 1, detail::with_sign(c.known));
        rows.push_back(row);
    }
    text += detail::aligned(rows);
    double sum = 0;
    for (const contribution& c : e.contributions) sum += c.amount;
    if (shown < shares.size()) text += "  and " + std::to_string(shares.size() - shown) + " more\n";
    if (std::isfinite(sum) && sum > 1.01 * e.error)
        text += "  the amounts add up to " + detail::scientific(sum) +
                "; errors cancel to at most " + detail::scientific(e.error) + "\n";
    return text;
}

/// JSON that `errbound explain` reads.
inline std::string json_of(const std::vector<explanation>& results) {
    std::string text;
    for (const explanation& e : results) text += (text.empty() ? "\n" : ",\n") + detail::json_of(e);
    return "{\n  \"format\": \"errbound explanation\",\n  \"version\": 1,\n  \"results\": [" +
           text + (text.empty() ? "]\n}\n" : "\n  ]\n}\n");
}

/// Writes json_of(results), whole or not at all. Throws errbound::support::file_error.
inline void write_explanations(const std::filesystem::path& path,
                               const std::vector<explanation>& results) {
    detail::write_file(path, json_of(results));
}

}  // namespace errbound
