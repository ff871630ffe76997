// Fuzzes a reader of meshes and its peer: they agree, or a listed difference explains why not. The
// source file of each fuzzer includes this.
#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include "tests/ccd/io/peers/peer.hpp"

namespace ccd::peers {
inline constexpr std::array<std::string_view, 24> numbers{
    "0",   "1",     "-1",      "2",     "3",        "-0",     "+1",         "1.",
    ".5",  "1e5",   "-2.5E-3", "1e308", "4.9e-324", "1e999",  "0.1",        "00003",
    "255", "65536", "nan",     "inf",   "1.5x",     "0x1p-2", "4294967296", "0.30000000000000004"};

/// Exchanges, deletes, doubles or respells a few lines, words or numbers of a text.
class token_mutator {
  public:
    token_mutator(std::string text, unsigned seed, const std::vector<std::string>& words)
        : text_(std::move(text)), random_(seed), words_(words) {}

    std::string mutated() {
        for (std::size_t changes = 1 + below(2); changes > 0; --changes) {
            if (below(3) == 0)
                change(pieces("\r\n"));
            else if (below(16) == 0)
                text_.insert(below(text_.size() + 1), 1, "\r\n\t #\\/\x01"[below(9)]);
            else
                change(pieces(" \t\r\n"));
        }
        return std::move(text_);
    }

  private:
    struct piece {
        std::size_t begin, size;
    };

    std::size_t below(std::size_t end) { return static_cast<std::size_t>(random_() % end); }

    std::vector<piece> pieces(std::string_view ends) const {
        std::vector<piece> found;
        for (std::size_t begin = text_.find_first_not_of(ends); begin != std::string::npos;) {
            const std::size_t end = std::min(text_.find_first_of(ends, begin), text_.size());
            found.push_back({begin, end - begin});
            begin = text_.find_first_not_of(ends, end);
        }
        return found;
    }

    std::string part(piece p) const { return text_.substr(p.begin, p.size); }

    void change(const std::vector<piece>& all) {
        if (all.empty()) return;
        const piece at = all[below(all.size())], other = all[below(all.size())];
        switch (below(6)) {
            case 0:
                text_.erase(at.begin, at.size + below(2));
                return;
            case 1: {
                const std::size_t end = at.begin + at.size;
                const std::string separator = end < text_.size() ? text_.substr(end, 1) : "\n";
                text_.insert(at.begin, part(at) + separator);
                return;
            }
            case 2: {
                if (other.begin == at.begin) return;
                const auto [first, second] =
                    at.begin < other.begin ? std::pair(at, other) : std::pair(other, at);
                const std::string early = part(first), late = part(second);
                text_.replace(second.begin, second.size, early);
                text_.replace(first.begin, first.size, late);
                return;
            }
            case 3:
                text_.replace(at.begin, at.size, words_[below(words_.size())]);
                return;
            case 4:
                text_.replace(at.begin, at.size, numbers[below(numbers.size())]);
                return;
            default:
                text_.replace(at.begin, at.size, spelled_otherwise(part(at)));
        }
    }

    /// Another decimal spelling of a number, of the same value or of the value plus 1.
    std::string spelled_otherwise(const std::string& word) {
        double value = 0;
        const char* const end = word.data() + word.size();
        if (std::from_chars(word.data(), end, value).ptr != end) return word;
        constexpr std::array formats{"%.17g", "%.3f", "%+.17e", "%.30f", "%.0f", "%.6G"};
        std::array<char, 400> digits;
        const int size = std::snprintf(digits.data(), digits.size(), formats[below(formats.size())],
                                       value + static_cast<double>(below(2)));
        return {digits.data(), std::min(static_cast<std::size_t>(size), digits.size() - 1)};
    }

    std::string text_;
    std::minstd_rand random_;
    const std::vector<std::string>& words_;
};

/// Changes the text, or another legal text, by lines and words.
inline std::string mutated(std::string text, const peer& of, unsigned seed) {
    std::minstd_rand random(seed);
    if (text.empty() || random() % 4 == 0) {
        std::array<std::uint8_t, 512> bytes;
        std::ranges::generate(bytes, [&] { return static_cast<std::uint8_t>(random() >> 8); });
        text = of.spelled(bytes).text;
    }
    return token_mutator(std::move(text), seed, of.words).mutated();
}

}  // namespace ccd::peers

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    if (!ccd::peers::the_peer().agrees(text)) std::abort();
    return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t max_size, unsigned seed) {
    const std::string text = ccd::peers::mutated({reinterpret_cast<const char*>(data), size},
                                                 ccd::peers::the_peer(), seed);
    return text.copy(reinterpret_cast<char*>(data), max_size);
}
