#include "errbound/support/table.hpp"

#include <algorithm>
#include <cstdio>

namespace errbound::support {

std::string printable(std::string_view text, std::string_view kept) {
    const auto byte = [text](std::size_t i) {
        return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u;
    };
    // U+0080 to U+009F are bytes 0xc2 and 0x80 to 0x9f of UTF-8.
    const auto is_wide = [&](std::size_t i) {
        return byte(i) == 0xc2 && byte(i + 1) >= 0x80 && byte(i + 1) < 0xa0;
    };
    const auto is_control = [&](std::size_t i) {
        return byte(i) < 0x20 || byte(i) == 0x7f || is_wide(i) || (i > 0 && is_wide(i - 1));
    };
    constexpr std::string_view digits = "0123456789abcdef";
    std::string result;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const unsigned c = byte(i);
        if (is_control(i) && kept.find(text[i]) == kept.npos)
            result.append({'\\', 'x', digits[c >> 4], digits[c & 15]});
        else
            result += text[i];
    }
    return result;
}

std::string text_of(const table& given, std::size_t left) {
    table rows = given;
    for (auto& row : rows)
        for (std::string& cell : row) cell = printable(cell);
    std::vector<std::size_t> widths(rows.empty() ? 0 : rows.front().size());
    for (const auto& row : rows) {
        for (std::size_t i = 0; i < widths.size(); ++i) {
            widths[i] = std::max(widths[i], row[i].size());
        }
    }
    std::string result;
    for (const auto& row : rows) {
        std::string line;
        for (std::size_t i = 0; i < widths.size(); ++i) {
            const std::string padding(widths[i] - row[i].size(), ' ');
            if (i > 0) line += "  ";
            line += i < left ? row[i] + padding : padding + row[i];
        }
        line.resize(line.find_last_not_of(' ') + 1);
        result += line + '\n';
    }
    return result;
}

std::string fixed(double value, const char* format) {
    char text[64];
    std::snprintf(text, sizeof text, format, value);
    return text;
}

std::string grouped(std::uint64_t n) {
    const std::string digits = std::to_string(n);
    std::string text;
    for (std::size_t i = 0; i < digits.size(); ++i) {
        if (i > 0 && (digits.size() - i) % 3 == 0) text += ',';
        text += digits[i];
    }
    return text;
}

}  // namespace errbound::support
