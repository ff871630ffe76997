#include "errbound/program/published/text.hpp"

#include <errbound/validation/ball.hpp>

namespace errbound::validation {

std::vector<std::string_view> words_of(std::string_view text, bool brackets) {
    std::vector<std::string_view> words;
    std::size_t begin = 0;
    bool inside = false;
    for (std::size_t i = 0; i <= text.size(); ++i) {
        const char c = i < text.size() ? text[i] : ' ';
        inside = brackets && (c == '[' || (inside && c != ']' && i < text.size()));
        if (inside || std::string_view(" \t\r\n\f,").find(c) == std::string_view::npos) continue;
        if (i > begin) words.push_back(text.substr(begin, i - begin));
        begin = i + 1;
    }
    return words;
}

std::vector<std::string_view> split(std::string_view text, char at) {
    std::vector<std::string_view> parts;
    for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t end = std::min(text.find(at, begin), text.size());
        parts.push_back(text.substr(begin, end - begin));
        begin = end + 1;
    }
    return parts;
}

std::optional<double> number_in(std::string_view text) {
    const std::vector<std::string_view> words = words_of(text);
    if (words.size() != 1) return std::nullopt;
    const std::string word(words[0]);
    MPFR_DECL_INIT(x, 4096);  // exact for doubles as printf writes them
    char* end = nullptr;
    mpfr_strtofr(x, word.c_str(), &end, 0, MPFR_RNDN);
    if (*end != '\0' || mpfr_nan_p(x)) return std::nullopt;
    return mpfr_get_d(x, MPFR_RNDN);
}

std::string without_comments(std::string text) {
    for (std::size_t i = 0; i + 1 < text.size(); ++i) {
        if (text[i] != '/' || (text[i + 1] != '*' && text[i + 1] != '/')) continue;
        const bool block = text[i + 1] == '*';
        const std::size_t found = block ? text.find("*/", i + 2) : text.find('\n', i);
        const std::size_t end =
            std::min(found == text.npos ? found : found + (block ? 2 : 0), text.size());
        for (; i < end; ++i)
            if (text[i] != '\n') text[i] = ' ';
        --i;
    }
    return text;
}

}  // namespace errbound::validation
