// Comparison of a reader of meshes with that of another library: both read the same mesh, or both
// refuse, or a listed difference explains the outcome.
#pragma once

#include <algorithm>
#include <ccd/io/mesh_file.hpp>
#include <ccd/mesh.hpp>
#include <cstdlib>
#include <errbound/support/error.hpp>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ccd/io/text.hpp"
#include "tests/ccd/io/fuzz/spellings.hpp"
#include "tests/ccd/io/meshes.hpp"

namespace ccd::peers {

using words = std::vector<std::string>;
using predicate = std::function<bool(std::string_view text)>;

inline words words_of(std::string_view line) {
    words found;
    for (std::string_view word = io::take_word(line); !word.empty(); word = io::take_word(line))
        found.emplace_back(word);
    return found;
}

enum class outcome {
    same,          ///< the same mesh, or both refuse
    we_refuse,     ///< our reader refuses a text that the peer reads
    peer_differs,  ///< the peer refuses a text that we read, or reads another mesh
};

/// An example: the peer's plain text with its first `from` replaced by `to`.
struct edit {
    std::string from, to;
};

/// A reason for the readers to differ on a text: a property of the peer.
struct difference {
    outcome when;
    const char* reason;
    predicate holds;
    edit example;  ///< on which they differ for this reason only
};
inline difference we_refuse(const char* reason, predicate holds, edit example) {
    return {outcome::we_refuse, reason, std::move(holds), std::move(example)};
}
inline difference peer_differs(const char* reason, predicate holds, edit example) {
    return {outcome::peer_differs, reason, std::move(holds), std::move(example)};
}

/// Rewrites parts of a format that the peer cannot read as parts that it reads.
struct rewriting {
    const char* reason;
    std::function<std::string(std::string_view text)> rewritten;
    edit example;  ///< on which they differ unless it is rewritten
};

/// Another library's reader of a format.
struct peer {
    /// The outcome if our reader reads `text` and the peer reads `given`.
    outcome (*compare)(std::string_view text, std::string_view given);
    std::string plain;  ///< a text on which they agree
    std::vector<rewriting> rewritings;
    std::vector<difference> differences;
    peers::words words;  ///< of the format, for mutations
    fuzz::spelling (*spelled)(std::span<const std::uint8_t>);

    std::string text_of(const edit& example) const {
        std::string text = plain;
        return text.replace(text.find(example.from), example.from.size(), example.to);
    }

    /// True if the readers agree on a text, or a difference explains why they do not.
    bool agrees(std::string_view text) const {
        std::string given(text);
        for (const rewriting& r : rewritings) given = r.rewritten(given);
        const outcome found = compare(text, given);
        return found == outcome::same || std::ranges::any_of(differences, [&](const difference& d) {
                   return d.when == found && (d.holds(text) || d.holds(given));
               });
    }
};

/// The peer that the program is linked with: tinyobjloader for OBJ, or CGAL for PLY.
const peer& the_peer();

/// The mesh that our reader returns for a text, or nothing if it refuses the text.
template <class Parse>
std::optional<mesh> read_by(const Parse& parse, std::string_view text) {
    try {
        return parse(text, "peers", io::mesh_options());
    } catch (const errbound::support::file_error&) {
        return std::nullopt;
    }
}

/// The text with each run of characters other than `ends` exchanged.
template <class Exchanged>
std::string exchange(std::string_view text, std::string_view ends, const Exchanged& exchanged) {
    std::string result;
    while (!text.empty()) {
        const std::size_t begin = std::min(text.find_first_not_of(ends), text.size());
        result += text.substr(0, begin);
        text.remove_prefix(begin);
        const std::size_t size = std::min(text.find_first_of(ends), text.size());
        if (size > 0) result += exchanged(std::string(text.substr(0, size)));
        text.remove_prefix(size);
    }
    return result;
}
template <class Exchanged>
std::string exchange_words(std::string_view text, const Exchanged& exchanged) {
    return exchange(text, " \t\r\n", exchanged);
}

/// The text with each hexadecimal number as the shortest decimal of the same double.
inline std::string with_decimals(std::string_view text) {
    return exchange_words(text, [](const std::string& word) {
        const std::size_t sign = word.starts_with('-') || word.starts_with('+') ? 1 : 0;
        if (word.compare(sign, 2, "0x") != 0 && word.compare(sign, 2, "0X") != 0) return word;
        char* end = nullptr;
        const double value = std::strtod(word.c_str(), &end);
        return end == word.c_str() + word.size() ? test_meshes::shortest(value) : word;
    });
}

inline std::string without_byte_order_mark(std::string_view text) {
    return std::string(text.substr(text.starts_with("\xef\xbb\xbf") ? 3 : 0));
}

}  // namespace ccd::peers
