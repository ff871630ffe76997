// Words of a text exchanged in place, for peers that do not know them.
#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>
#include <string>
#include <string_view>

namespace ccd::peers {

/// The text with each of its words, runs of neither blanks nor line ends, exchanged.
template <class Word>
std::string exchange_words(std::string_view text, const Word& word) {
    constexpr std::string_view ends = " \t\r\n";
    std::string result;
    while (!text.empty()) {
        const std::size_t begin = std::min(text.find_first_not_of(ends), text.size());
        result += text.substr(0, begin);
        text.remove_prefix(begin);
        const std::size_t size = std::min(text.find_first_of(ends), text.size());
        if (size > 0) result += word(std::string(text.substr(0, size)));
        text.remove_prefix(size);
    }
    return result;
}

/// A hexadecimal number as the shortest decimal that is read as the same double; other words as
/// they are.
inline std::string in_decimal(const std::string& word) {
    const std::size_t sign = word.starts_with('-') || word.starts_with('+') ? 1 : 0;
    if (word.compare(sign, 2, "0x") != 0 && word.compare(sign, 2, "0X") != 0) return word;
    char* end = nullptr;
    const double value = std::strtod(word.c_str(), &end);
    if (end != word.c_str() + word.size()) return word;
    std::array<char, 32> digits;
    return {digits.data(), std::to_chars(digits.begin(), digits.end(), value).ptr};
}

inline std::string with_decimals(std::string_view text) {
    return exchange_words(text, in_decimal);
}

}  // namespace ccd::peers
