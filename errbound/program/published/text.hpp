// Words and numbers in published files. Internal.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace errbound::validation {

/// Words between spaces and commas; if `brackets`, all between brackets is one word.
std::vector<std::string_view> words_of(std::string_view text, bool brackets = false);
std::vector<std::string_view> split(std::string_view text, char at);

/// The double nearest to a decimal or hexadecimal number, or an infinity.
std::optional<double> number_in(std::string_view text);

/// Blanks /* ... */ and // comments; lines stay.
std::string without_comments(std::string text);

/// Calls f(number, text) for each line, without spaces at its ends.
template <class F>
void for_each_line(std::string_view text, const F& f) {
    std::size_t line = 0;
    for (std::string_view one : split(text, '\n')) {
        ++line;
        while (!one.empty() && (one.back() == '\r' || one.back() == ' ')) one.remove_suffix(1);
        while (!one.empty() && one.front() == ' ') one.remove_prefix(1);
        f(line, one);
    }
}

}  // namespace errbound::validation
